// garment/pattern_check.cpp: the checks on a sewing pattern.
//
// A panel passes three gates, each only entered when the one before found nothing: indices and loop, sizes, outline.
// The outline is sampled and snapped to the 2^-20 m grid of the triangulation, so that orientation tests are exact in
// 64-bit integers: coordinates below 10 m are below 2^24, their products below 2^50.
//
// Easily got wrong: neighbouring pieces of an outline always touch, in their common point.  They are at fault only
// when the second runs back exactly along the first.
#include "garment/pattern_check.hpp"

#include "core/error.hpp"
#include "garment/lint_codes.hpp"
#include "garment/pleats.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

using Part = PatternFault::Part;

bool within(Index i, std::size_t size) { return i >= 0 && at(i) < size; }

std::string number_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4).ptr;
  return {buffer, end};
}

std::string point_text(const Vec2& p) {
  return std::string("(").append(number_text(p.x())).append(", ").append(number_text(p.y())).append(") m");
}

std::string edge_text(const Panel& panel, Index edge) { return "edge " + std::to_string(panel.file_number(edge)); }

std::string side_text(const Pattern& pattern, const StitchSide& side) {
  const Panel& panel = pattern.panels[at(side.panel)];
  return edge_text(panel, side.edge) + " of panel \"" + printable(panel.name) + "\"";
}

bool bounded(double value) { return std::abs(value) <= PatternLimits::max_coordinate_m; }  // false for NaN
bool bounded(const Vec2& p) { return bounded(p.x()) && bounded(p.y()); }

void add_fault(std::vector<PatternFault>& faults, PatternFault fault) {
  if (faults.size() < PatternLimits::max_faults) faults.push_back(std::move(fault));
}

PatternFault with_other(PatternFault fault, Index other, const Vec2& place_m = Vec2::Zero()) {
  fault.other = other;
  fault.place_m = place_m;
  return fault;
}

// ---- gate 1: indices and loop ---------------------------------------------------------------------------------------

class PanelCheck {
 public:
  PanelCheck(const Panel& panel, Index index, std::vector<PatternFault>& faults)
      : panel_(panel), index_(index), faults_(faults) {}

  bool run() {
    check_numbers();
    check_loop();
    if (sound_) check_sizes();
    if (sound_) check_outline();
    return sound_;
  }

 private:
  void fault(std::string_view code, Part part, Index index, std::string expected, std::string got, Index other = -1,
             const Vec2& place_m = Vec2::Zero()) {
    sound_ = false;
    add_fault(faults_,
              with_other({code, part, index_, index, -1, std::move(expected), std::move(got)}, other, place_m));
  }

  void check_numbers() {
    const std::string limit = number_text(PatternLimits::max_coordinate_m);
    for (std::size_t c = 0; c < panel_.corners.size(); ++c) {
      if (bounded(panel_.corners[c])) continue;
      fault(reason::beyond_limits, Part::corner, static_cast<Index>(c),
            "coordinates within " + limit + " m of the origin", point_text(panel_.corners[c]));
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (!bounded(panel_.translation_m[axis])) {
        fault(reason::beyond_limits, Part::panel, -1, "a translation within " + limit + " m of the origin",
              number_text(panel_.translation_m[axis]) + " m");
      }
      if (!std::isfinite(panel_.rotation_deg[axis])) {
        fault(reason::beyond_limits, Part::panel, -1, "a finite rotation", number_text(panel_.rotation_deg[axis]));
      }
    }
    for (std::size_t e = 0; e < panel_.edges.size(); ++e) {
      const PanelEdge& edge = panel_.edges[e];
      const auto k = static_cast<Index>(e);
      const bool bezier = edge.kind == CurveKind::quadratic || edge.kind == CurveKind::cubic;
      const std::string expected = "control points within " + limit + " m of the origin";
      if (bezier && !bounded(edge.control[0])) {
        fault(reason::beyond_limits, Part::edge, k, expected, point_text(edge.control[0]));
      } else if (edge.kind == CurveKind::cubic && !bounded(edge.control[1])) {
        fault(reason::beyond_limits, Part::edge, k, expected, point_text(edge.control[1]));
      } else if (edge.kind == CurveKind::circle &&
                 !(edge.radius_m > 0 && edge.radius_m <= PatternLimits::max_radius_m)) {
        fault(reason::beyond_limits, Part::edge, k,
              "a radius above 0 and at most " + number_text(PatternLimits::max_radius_m) + " m",
              number_text(edge.radius_m) + " m");
      }
    }
  }

  void check_loop() {
    const std::size_t count = panel_.edges.size();
    if (count > PatternLimits::max_panel_edges) {
      fault(reason::beyond_limits, Part::panel, -1,
            "at most " + std::to_string(PatternLimits::max_panel_edges) + " edges", std::to_string(count));
      return;
    }
    const bool curved = std::any_of(panel_.edges.begin(), panel_.edges.end(),
                                    [](const PanelEdge& e) { return e.kind != CurveKind::line; });
    if (count < (curved ? 2U : 3U)) {
      fault(reason::loop_open, Part::panel, -1, "at least 3 edges, or 2 of which one is curved", std::to_string(count));
      return;
    }
    std::vector<Index> leaving(panel_.corners.size(), -1);  // the edge that starts at a corner
    for (std::size_t e = 0; e < count; ++e) {
      const PanelEdge& edge = panel_.edges[e];
      const auto k = static_cast<Index>(e);
      if (!within(edge.start, panel_.corners.size()) || !within(edge.end, panel_.corners.size())) {
        fault(reason::edge_ends, Part::edge, k,
              "corners 0 to " + std::to_string(static_cast<long long>(panel_.corners.size()) - 1),
              std::to_string(edge.start) + " and " + std::to_string(edge.end));
        return;
      }
      if (edge.start == edge.end) {
        fault(reason::edge_ends, Part::edge, k, "two different corners",
              "corner " + std::to_string(edge.start) + " twice");
        return;
      }
      const PanelEdge& next = panel_.edges[(e + 1) % count];
      if (edge.end != next.start) {
        fault(reason::loop_open, Part::edge, k,
              "an edge that ends where the next begins, at corner " + std::to_string(next.start),
              "corner " + std::to_string(edge.end));
        return;
      }
      Index& first = leaving[at(edge.start)];
      if (first >= 0) {
        fault(reason::loop_several, Part::edge, k, "a loop that passes each corner once",
              "corner " + std::to_string(edge.start) + " again, after " + edge_text(panel_, first));
        return;
      }
      first = k;
    }
    for (std::size_t c = 0; c < leaving.size(); ++c) {
      if (leaving[c] < 0) {
        fault(reason::corner_unused, Part::corner, static_cast<Index>(c), "a corner that an edge uses",
              "none that does");
      }
    }
  }

  // ---- gate 2: sizes ------------------------------------------------------------------------------------------------

  void check_sizes() {
    check_repeated_corners();
    for (std::size_t e = 0; e < panel_.edges.size(); ++e) {
      const PanelEdge& edge = panel_.edges[e];
      const double chord = (panel_.corners[at(edge.end)] - panel_.corners[at(edge.start)]).norm();
      // The margin forgives the rounding of a half circle; SVG would silently enlarge any radius.
      if (edge.kind == CurveKind::circle && edge.radius_m < 0.5 * chord * (1 - 1e-6)) {
        fault(reason::curve_impossible, Part::edge, static_cast<Index>(e),
              "a radius of at least half the distance of the corners, " + number_text(0.5 * chord) + " m",
              number_text(edge.radius_m) + " m");
      }
    }
  }

  void check_repeated_corners() {
    // Sorted by x, a pair closer than the limit is at most a few places apart; the index makes the order total.
    std::vector<Index> order(panel_.corners.size());
    for (std::size_t c = 0; c < order.size(); ++c) order[c] = static_cast<Index>(c);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      const double xa = panel_.corners[at(a)].x(), xb = panel_.corners[at(b)].x();
      return xa != xb ? xa < xb : a < b;
    });
    std::optional<std::pair<Index, Index>> found;  // (later, earlier), the smallest
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        const Vec2 apart = panel_.corners[at(order[j])] - panel_.corners[at(order[i])];
        if (apart.x() >= PatternLimits::min_edge_m) break;
        if (apart.norm() >= PatternLimits::min_edge_m) continue;
        const std::pair<Index, Index> pair{std::max(order[i], order[j]), std::min(order[i], order[j])};
        if (!found || pair < *found) found = pair;
      }
    }
    if (!found) return;
    std::string got = "the place of corner " + std::to_string(found->second) + " again";
    for (std::size_t e = 0; e < panel_.edges.size(); ++e) {
      const PanelEdge& edge = panel_.edges[e];
      if (std::minmax(edge.start, edge.end) != std::minmax(found->first, found->second)) continue;
      got += ": " + edge_text(panel_, static_cast<Index>(e)) + " has no length";
      break;
    }
    fault(reason::corner_twice, Part::corner, found->first,
          "corners at least " + number_text(PatternLimits::min_edge_m) + " m apart", got, found->second);
  }

  // ---- gate 3: outline ----------------------------------------------------------------------------------------------

  struct OutlinePoint {
    std::int64_t x = 0, y = 0;
    Index edge = -1;  // of the piece that begins here
  };

  void check_outline() {
    std::vector<Vec2> points;
    std::vector<Index> edge_of;
    for (std::size_t e = 0; e < panel_.edges.size(); ++e) {
      const PanelEdge& edge = panel_.edges[e];
      int pieces = 1;
      if (edge.kind !=
          CurveKind::line) {  // one piece per mm, at most 64: short curves need no more, long ones are smooth
        pieces = static_cast<int>(std::clamp(std::ceil(1000 * edge_length_m(panel_, edge)), 4.0, 64.0));
      }
      const std::vector<Vec2> samples = sample_edge(panel_, edge, pieces);
      points.insert(points.end(), samples.begin(), samples.end() - 1);
      edge_of.insert(edge_of.end(), samples.size() - 1, static_cast<Index>(e));
    }
    Vec2 low = points.front(), high = points.front();
    for (const Vec2& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Vec2 size = high - low;
    if (size.maxCoeff() > PatternLimits::max_panel_m || size.maxCoeff() < PatternLimits::min_panel_m) {
      fault(reason::unit_doubtful, Part::panel, -1,
            "a panel between " + number_text(1000 * PatternLimits::min_panel_m) + " mm and " +
                number_text(PatternLimits::max_panel_m) + " m large",
            number_text(size.x()) + " m x " + number_text(size.y()) + " m: is units_in_meter right?");
      return;
    }
    constexpr double grid = 1 << 20;
    std::vector<OutlinePoint> outline;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec2 p = (points[k] - low) * grid;
      const OutlinePoint snapped{std::llround(p.x()), std::llround(p.y()), edge_of[k]};
      if (!outline.empty() && outline.back().x == snapped.x && outline.back().y == snapped.y) {
        outline.back().edge = snapped.edge;
      } else {
        outline.push_back(snapped);
      }
    }
    while (outline.size() > 1 && outline.back().x == outline.front().x && outline.back().y == outline.front().y) {
      outline.pop_back();
    }
    if (outline.size() < 3) {
      fault(reason::outline_crosses, Part::panel, -1, "an outline that encloses an area", "none");
      return;
    }
    const auto crossing = find_crossing(outline, size.x() >= size.y());
    if (!crossing) return;
    const auto [first, second] = *crossing;
    const Index a = outline[first].edge, b = outline[second].edge;
    const Vec2 near = (low + meeting(outline, first, second) / grid).unaryExpr([](double v) {
      return std::round(1e6 * v) / 1e6;  // the grid's
    });
    fault(reason::outline_crosses, Part::edge, a, "an outline that does not cross or touch itself",
          (a == b ? edge_text(panel_, a) + " crosses itself"
                  : edge_text(panel_, a) + " crosses or touches " + edge_text(panel_, b)) +
              " near " + point_text(near),
          b, near);
  }

  static int orientation(const OutlinePoint& a, const OutlinePoint& b, const OutlinePoint& c) {
    const std::int64_t twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return (twice_area > 0) - (twice_area < 0);
  }

  // Two pieces of the ring, by their first points, that intersect; the first pair in the order of their edges.
  static std::optional<std::pair<std::size_t, std::size_t>> find_crossing(const std::vector<OutlinePoint>& ring,
                                                                          bool along_x) {
    const std::size_t n = ring.size();
    struct Span {
      std::int64_t low, high;  // along the longer side of the panel, where fewer pieces overlap
      std::int64_t across_low, across_high;
      std::size_t piece;
    };
    std::vector<Span> spans(n);
    for (std::size_t k = 0; k < n; ++k) {
      const OutlinePoint &a = ring[k], &b = ring[(k + 1) % n];
      const auto [low_x, high_x] = std::minmax(a.x, b.x);
      const auto [low_y, high_y] = std::minmax(a.y, b.y);
      spans[k] = along_x ? Span{low_x, high_x, low_y, high_y, k} : Span{low_y, high_y, low_x, high_x, k};
    }
    std::sort(spans.begin(), spans.end(),
              [](const Span& a, const Span& b) { return a.low != b.low ? a.low < b.low : a.piece < b.piece; });
    std::optional<std::pair<std::size_t, std::size_t>> found;
    const auto rank = [&](const std::pair<std::size_t, std::size_t>& p) {
      return std::array<std::size_t, 4>{at(ring[p.first].edge), at(ring[p.second].edge), p.first, p.second};
    };
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n && spans[j].low <= spans[i].high; ++j) {
        if (spans[j].across_low > spans[i].across_high || spans[i].across_low > spans[j].across_high) continue;
        const auto [first, second] = std::minmax(spans[i].piece, spans[j].piece);
        if (!pieces_meet(ring, first, second)) continue;
        std::pair<std::size_t, std::size_t> pair{first, second};
        if (!found || rank(pair) < rank(*found)) found = pair;
      }
    }
    return found;
  }

  // Whether two pieces whose boxes meet intersect elsewhere than in a shared end.
  static bool pieces_meet(const std::vector<OutlinePoint>& ring, std::size_t first, std::size_t second) {
    const std::size_t n = ring.size();
    const OutlinePoint &a = ring[first], &b = ring[first + 1 == n ? 0 : first + 1];
    const OutlinePoint &c = ring[second], &d = ring[second + 1 == n ? 0 : second + 1];
    const bool follows = second == first + 1, closes = first == 0 && second == n - 1;
    if (follows || closes) {
      const OutlinePoint& before = follows ? a : c;
      const OutlinePoint& shared = follows ? b : d;
      const OutlinePoint& after = follows ? d : b;
      const std::int64_t along =
          (shared.x - before.x) * (after.x - shared.x) + (shared.y - before.y) * (after.y - shared.y);
      return orientation(before, shared, after) == 0 && along < 0;
    }
    // Two pieces meet exactly when neither lies strictly on one side of the other's line, given that their boxes meet.
    return orientation(a, b, c) * orientation(a, b, d) <= 0 && orientation(c, d, a) * orientation(c, d, b) <= 0;
  }

  // Where the lines of two pieces meet; of parallel ones, where the later begins.
  static Vec2 meeting(const std::vector<OutlinePoint>& ring, std::size_t first, std::size_t second) {
    const auto point = [&](std::size_t k) {
      const OutlinePoint& p = ring[k % ring.size()];
      return Vec2{static_cast<double>(p.x), static_cast<double>(p.y)};
    };
    const Vec2 a = point(first), b = point(first + 1), c = point(second), d = point(second + 1);
    const auto cross = [](const Vec2& u, const Vec2& v) { return u.x() * v.y() - u.y() * v.x(); };
    const double across = cross(b - a, d - c);
    return across == 0 ? c : a + cross(c - a, d - c) / across * (b - a);
  }

  const Panel& panel_;
  Index index_;
  std::vector<PatternFault>& faults_;
  bool sound_ = true;
};

// ---- stitches -------------------------------------------------------------------------------------------------------

void check_stitches(const Pattern& pattern, const std::vector<char>& sound, std::vector<PatternFault>& faults) {
  std::map<std::pair<Index, Index>, Index> sewn;  // (panel, edge) -> stitch
  std::map<std::pair<Index, Index>, std::vector<std::size_t>> stitches_of;
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s)
    for (const StitchSide& side : {pattern.stitches[s].a, pattern.stitches[s].b})
      stitches_of[{side.panel, side.edge}].push_back(s);
  const auto in_pleat = [&](const StitchSide& side) {
    const std::vector<std::size_t>& stitches = stitches_of[{side.panel, side.edge}];
    const auto there = [&](const StitchSide& one) {
      return within(one.panel, pattern.panels.size()) && within(one.edge, pattern.panels[at(one.panel)].edges.size()) &&
             sound[at(one.panel)];
    };
    return std::all_of(stitches.begin(), stitches.end(),
                       [&](std::size_t k) { return there(pattern.stitches[k].a) && there(pattern.stitches[k].b); }) &&
           pleat_of(pattern, stitches);
  };
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const Stitch& stitch = pattern.stitches[s];
    const auto fault = [&](std::string_view code, int side, std::string expected, std::string got, Index other = -1) {
      add_fault(faults,
                with_other({code, Part::stitch, -1, static_cast<Index>(s), side, std::move(expected), std::move(got)},
                           other));
    };
    bool valid = true;
    for (int side = 0; side < 2; ++side) {
      const StitchSide& at_side = side == 0 ? stitch.a : stitch.b;
      if (within(at_side.panel, pattern.panels.size()) &&
          within(at_side.edge, pattern.panels[at(at_side.panel)].edges.size())) {
        continue;
      }
      fault(reason::seam_missing, side, "a panel and an edge of the pattern",
            "panel " + std::to_string(at_side.panel) + ", edge " + std::to_string(at_side.edge));
      valid = false;
    }
    if (!valid) continue;
    if (stitch.a.panel == stitch.b.panel && stitch.a.edge == stitch.b.edge) {
      fault(reason::seam_to_itself, -1, "two different edges", side_text(pattern, stitch.a) + " with itself");
      continue;
    }
    for (int side = 0; side < 2; ++side) {
      const StitchSide& at_side = side == 0 ? stitch.a : stitch.b;
      const auto [entry, inserted] = sewn.try_emplace({at_side.panel, at_side.edge}, static_cast<Index>(s));
      if (inserted || in_pleat(at_side)) continue;
      fault(reason::seam_twice, side, "an edge that no other stitch sews, or the three layers of a pleat",
            side_text(pattern, at_side) + ", sewn by stitch " + std::to_string(entry->second) + " already",
            entry->second);
      valid = false;
    }
    if (!valid || !sound[at(stitch.a.panel)] || !sound[at(stitch.b.panel)]) continue;

    const Panel &panel_a = pattern.panels[at(stitch.a.panel)], &panel_b = pattern.panels[at(stitch.b.panel)];
    const PanelEdge &edge_a = panel_a.edges[at(stitch.a.edge)], &edge_b = panel_b.edges[at(stitch.b.edge)];
    if (stitch.right_wrong && is_dart(pattern, stitch)) {
      fault(reason::seam_twisted, -1, "a dart that pairs its tip with itself",
            "\"right_wrong\", which pairs the tip with an end of its mouth");
    }
    const double length_a = edge_length_m(panel_a, edge_a), length_b = edge_length_m(panel_b, edge_b);
    if (std::max(length_a, length_b) > PatternLimits::max_seam_ratio * std::min(length_a, length_b)) {
      fault(reason::seam_unequal, -1,
            "edges whose lengths differ by at most a factor of " + number_text(PatternLimits::max_seam_ratio),
            number_text(length_a) + " m (" + side_text(pattern, stitch.a) + ") and " + number_text(length_b) + " m (" +
                side_text(pattern, stitch.b) + ")");
    }
  }
}

}  // namespace

std::vector<PatternFault> find_faults(const Pattern& pattern) {
  std::vector<PatternFault> faults;
  std::size_t edges = 0;
  for (const Panel& panel : pattern.panels) edges += panel.edges.size();
  if (pattern.panels.empty())
    faults.push_back({reason::beyond_limits, Part::pattern, -1, -1, -1, "at least one panel", "none"});
  if (edges > PatternLimits::max_edges) {
    faults.push_back({reason::beyond_limits, Part::pattern, -1, -1, -1,
                      "at most " + std::to_string(PatternLimits::max_edges) + " edges", std::to_string(edges)});
    return faults;
  }
  std::vector<char> sound(pattern.panels.size());
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    sound[p] = PanelCheck(pattern.panels[p], static_cast<Index>(p), faults).run();
  }
  check_stitches(pattern, sound, faults);
  return faults;
}

bool is_dart(const Pattern& pattern, const Stitch& stitch) {
  if (stitch.a.panel != stitch.b.panel) return false;
  const Panel& panel = pattern.panels[at(stitch.a.panel)];
  const PanelEdge &a = panel.edges[at(stitch.a.edge)], &b = panel.edges[at(stitch.b.edge)];
  return a.end == b.start || b.end == a.start;
}

std::string place_of(const Pattern& pattern, const PatternFault& fault) {
  std::string place;
  if (fault.part == Part::stitch) return "stitch " + std::to_string(fault.index);
  if (within(fault.panel, pattern.panels.size())) {
    const Panel& panel = pattern.panels[at(fault.panel)];
    place = "panel \"" + printable(panel.name) + "\"";
    if (fault.part == Part::corner) place += ", corner " + std::to_string(fault.index);
    if (fault.part == Part::edge) place += ", " + edge_text(panel, fault.index);
  }
  return place;
}

void check_pattern(const Pattern& pattern) {
  const std::vector<PatternFault> faults = find_faults(pattern);
  if (!faults.empty()) {
    throw InputError(printable(pattern.name), place_of(pattern, faults.front()), faults.front().expected,
                     faults.front().got);
  }
}

}  // namespace toile::internal
