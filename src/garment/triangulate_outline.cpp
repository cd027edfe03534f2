// garment/triangulate_outline.cpp: the checks of an outline, and the lattice; see triangulate_outline.hpp.
#include "garment/triangulate_outline.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

namespace toile::internal {

namespace {

constexpr double reach_m = 16.0;  // the farthest a point may be from the centre, per axis: 2^24 grid steps

std::string point_name(Index i) { return "point " + std::to_string(i); }

// True when the closed segments ab and cd have a point in common.
bool segments_meet(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
      std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
    return false;
  const auto sign = [](std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
  return sign(orient2d(a, b, c)) * sign(orient2d(a, b, d)) <= 0 &&
         sign(orient2d(c, d, a)) * sign(orient2d(c, d, b)) <= 0;
}

// Edge i runs from point i to point i + 1.
void check_edges(std::span<const GridPoint> points) {
  const Index n = static_cast<Index>(points.size());
  const auto p = [&](Index i) -> const GridPoint& { return points[at(i == n ? 0 : i)]; };
  struct Extent {
    std::int32_t low, high;
    Index edge;
  };
  std::vector<Extent> extents;
  extents.reserve(points.size());
  for (Index i = 0; i < n; ++i) extents.push_back({std::min(p(i).x, p(i + 1).x), std::max(p(i).x, p(i + 1).x), i});
  std::sort(extents.begin(), extents.end(),
            [](const Extent& a, const Extent& b) { return a.low != b.low ? a.low < b.low : a.edge < b.edge; });
  // Among all pairs that meet the one with the lowest numbers is named, so that the message does not depend on the
  // sweep.
  Index first = n, second = n;
  const auto report = [&](Index i, Index j) {
    if (i > j) std::swap(i, j);
    if (i < first || (i == first && j < second)) first = i, second = j;
  };
  for (std::size_t s = 0; s < extents.size(); ++s)
    for (std::size_t t = s + 1; t < extents.size() && extents[t].low <= extents[s].high; ++t) {
      const Index i = extents[s].edge, j = extents[t].edge;
      const bool j_follows = j == (i + 1 == n ? 0 : i + 1), i_follows = i == (j + 1 == n ? 0 : j + 1);
      if (j_follows || i_follows) {
        // Neighbours share a point; they overlap when the outline turns back on itself.
        const Index middle = j_follows ? j : i, before = j_follows ? i : j;
        const GridPoint &a = p(before), &b = p(middle), &c = p(middle + 1);
        const std::int64_t dot = (std::int64_t{a.x} - b.x) * (std::int64_t{c.x} - b.x) +
                                 (std::int64_t{a.y} - b.y) * (std::int64_t{c.y} - b.y);
        if (orient2d(a, b, c) == 0 && dot > 0) report(i, j);
      } else if (segments_meet(p(i), p(i + 1), p(j), p(j + 1))) {
        report(i, j);
      }
    }
  if (first < n)
    throw InputError("", point_name(first), "an outline that does not cross, touch or turn back on itself",
                     "the edge from here meets the edge from point " + std::to_string(second));
}

void check_repeats(std::span<const GridPoint> points) {
  std::vector<Index> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) order[i] = static_cast<Index>(i);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const GridPoint &p = points[at(a)], &q = points[at(b)];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : a < b;
  });
  Index repeat = -1, original = -1;
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    if (points[at(order[i])] == points[at(order[i + 1])] && (repeat < 0 || order[i + 1] < repeat))
      original = order[i], repeat = order[i + 1];
  if (repeat >= 0)
    throw InputError("", point_name(repeat), "points at least 2 micrometres apart",
                     "the same place as point " + std::to_string(original));
}

}  // namespace

std::string shortest_text(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

GridOutline snap_outline(std::span<const Vec2> outline) {
  if (outline.size() < 3)
    throw InputError("", "outline", "3 or more points", std::to_string(outline.size()) + " points");
  Vec2 low = outline[0], high = outline[0];
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (!std::isfinite(outline[i].x()) || !std::isfinite(outline[i].y()))
      throw InputError("", point_name(static_cast<Index>(i)), "finite coordinates", "not a number or infinite");
    low = low.cwiseMin(outline[i]);
    high = high.cwiseMax(outline[i]);
  }
  GridOutline result;
  // The centre is halved before it is added: finite coordinates near the largest double must not overflow.
  const Vec2 centre = 0.5 * low + 0.5 * high;
  for (std::size_t i = 0; i < outline.size(); ++i)
    if ((outline[i] - centre).cwiseAbs().maxCoeff() > reach_m || outline[i].cwiseAbs().maxCoeff() > 1e6)
      throw InputError("", point_name(static_cast<Index>(i)),
                       "an outline at most 32 m wide and within 1000 km of the origin",
                       "(" + shortest_text(outline[i].x()) + ", " + shortest_text(outline[i].y()) + ")");
  // The origin is itself on the grid, so that equal shapes a whole number of grid steps apart get equal meshes.
  result.origin_m = Vec2(std::round(centre.x() / grid_step_m), std::round(centre.y() / grid_step_m)) * grid_step_m;
  result.points.reserve(outline.size());
  for (const Vec2& point : outline) {
    const Vec2 steps = (point - result.origin_m) / grid_step_m;
    result.points.push_back(
        {static_cast<std::int32_t>(std::lround(steps.x())), static_cast<std::int32_t>(std::lround(steps.y()))});
  }
  // Zero area first: a polygon without any inside also overlaps itself, and this is the better name for it.
  std::int64_t twice_area = 0;
  bool collinear = true;
  double length = 0;
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    const GridPoint &a = result.points[i], &b = result.points[i + 1 == result.points.size() ? 0 : i + 1];
    twice_area += orient2d({}, a, b);
    collinear = collinear && orient2d(result.points[0], a, b) == 0;
    length += std::sqrt(static_cast<double>(squared_length(a, b)));
  }
  check_repeats(result.points);
  if (!collinear) check_edges(result.points);
  // A simple polygon thinner than the grid is a line that the snapping has bent.
  if (collinear || std::abs(static_cast<double>(twice_area)) <= length)
    throw InputError("", "outline", "an area that is not zero", "points on one line");
  return result;
}

std::vector<GridPoint> lattice_inside(std::span<const GridPoint> outline, double edge, double margin) {
  std::int32_t x0 = outline[0].x, x1 = x0, y0 = outline[0].y, y1 = y0;
  for (const GridPoint& p : outline) {
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
    y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  }
  const double width = double(x1) - x0, height = double(y1) - y0;
  const double row = 0.5 * std::numbers::sqrt3 * edge;
  const double columns = std::max(1.0, std::round(width / edge)), rows = std::max(1.0, std::round(height / row));
  constexpr double most_points = 1 << 24;
  if (columns * rows > most_points)
    throw InputError("", "edge_m", "an edge length that needs fewer than 16,777,216 points",
                     shortest_text(edge * grid_step_m) + " m on a panel " + shortest_text(width * grid_step_m) +
                         " m wide and " + shortest_text(height * grid_step_m) + " m high");
  const double dx = width / columns, dy = height / rows;

  // Which edges come near a row, by buckets of rows: edge segments within `margin` of it.
  const std::size_t row_count = static_cast<std::size_t>(rows) + 1, n = outline.size();
  const auto p = [&](std::size_t i) -> const GridPoint& { return outline[i == n ? 0 : i]; };
  std::vector<std::vector<std::size_t>> near(row_count);
  for (std::size_t i = 0; i < n; ++i) {
    const double low = std::min(p(i).y, p(i + 1).y) - margin - y0, high = std::max(p(i).y, p(i + 1).y) + margin - y0;
    const std::size_t first = static_cast<std::size_t>(std::max(0.0, std::floor(low / dy)));
    for (std::size_t r = first; r < row_count && static_cast<double>(r) * dy <= high; ++r) near[r].push_back(i);
  }

  std::vector<GridPoint> points;
  std::vector<double> crossings;
  std::vector<char> blocked;
  for (std::size_t r = 0; r < row_count; ++r) {
    const double y = y0 + static_cast<double>(r) * dy, offset = r % 2 == 0 ? 0.0 : 0.5;
    // Even-odd rule along the row.  Rounding cannot matter: a point near an edge is blocked anyway.
    crossings.clear();
    blocked.assign(static_cast<std::size_t>(columns) + 1, 0);
    for (const std::size_t i : near[r]) {
      const GridPoint &a = p(i), &b = p(i + 1);
      if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (y - a.y) * (double(b.x) - a.x) / (double(b.y) - a.y));
      // The part of the row within `margin` of the segment: only the columns over its extent have to be measured.
      const double low = (std::min(a.x, b.x) - margin - x0) / dx - offset,
                   high = (std::max(a.x, b.x) + margin - x0) / dx - offset;
      const double ux = double(b.x) - a.x, uy = double(b.y) - a.y, length2 = ux * ux + uy * uy;
      const auto last = static_cast<std::ptrdiff_t>(std::floor(std::min<double>(columns, high)));
      for (auto c = static_cast<std::ptrdiff_t>(std::max(0.0, std::ceil(low))); c <= last; ++c) {
        const double px = x0 + (static_cast<double>(c) + offset) * dx - a.x, py = y - a.y;
        const double t = std::clamp((px * ux + py * uy) / length2, 0.0, 1.0);
        const double qx = px - t * ux, qy = py - t * uy;
        if (qx * qx + qy * qy < margin * margin) blocked[static_cast<std::size_t>(c)] = 1;
      }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const double first = std::max(0.0, std::ceil((crossings[k] - x0) / dx - offset));
      for (double c = first; c <= columns && x0 + (c + offset) * dx <= crossings[k + 1]; c += 1)
        if (!blocked[static_cast<std::size_t>(c)])
          points.push_back({static_cast<std::int32_t>(std::lround(x0 + (c + offset) * dx)),
                            static_cast<std::int32_t>(std::lround(y))});
    }
  }
  return points;
}

}  // namespace toile::internal
