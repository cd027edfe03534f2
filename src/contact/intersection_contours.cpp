#include "contact/intersection_contours.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <string>

namespace toile::internal {
namespace {

// A segment's pair of triangles (smaller, larger) and one crossing at its end.
struct SegmentEnd {
  std::array<Index, 2> pair;
  Index crossing;
  auto operator<=>(const SegmentEnd&) const = default;
};

std::array<Index, 2> ordered(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

Index shared_particle(const Triangle& a, const Triangle& b) {
  for (const Index i : a)
    if (i == b[0] || i == b[1] || i == b[2]) return i;
  return -1;
}

class Tracer {
 public:
  Tracer(const Topology& topology, std::span<const Triangle> triangles, std::span<const SurfaceCrossing> crossings)
      : topology_(topology), triangles_(triangles), crossings_(crossings), done_(crossings.size(), 0) {
    for (std::size_t c = 0; c < crossings.size(); ++c) {
      const Index edge = find_edge(topology, crossings[c].edge);
      if (edge < 0)
        throw InputError("", "crossing " + std::to_string(c), "an edge of the mesh",
                         std::to_string(crossings[c].edge[0]) + '-' + std::to_string(crossings[c].edge[1]));
      edges_.push_back(edge);
      for (const Index t : topology.edges[at(edge)].triangle)
        if (t >= 0) ends_.push_back({ordered(t, crossings[c].triangle), static_cast<Index>(c)});
    }
    std::sort(ends_.begin(), ends_.end());
  }

  std::vector<IntersectionContour> all() {
    std::vector<IntersectionContour> contours;
    const auto count = static_cast<Index>(crossings_.size());
    for (Index c = 0; c < count; ++c) {
      if (done_[at(c)]) continue;
      const bool first = partner(c, 0) >= 0, second = partner(c, 1) >= 0;
      if (!first || !second) contours.push_back(trace(c, first ? 0 : 1));
    }
    for (Index c = 0; c < count; ++c)
      if (!done_[at(c)]) contours.push_back(trace(c, 0));
    return contours;
  }

 private:
  Index triangle_at(Index crossing, std::size_t k) const {
    return topology_.edges[at(edges_[at(crossing)])].triangle[k];
  }

  // The other end of the segment that leaves this crossing into the edge's triangle k; -1 where there is none.
  Index partner(Index crossing, std::size_t k) const {
    const Index t = triangle_at(crossing, k);
    if (t < 0) return -1;
    const std::array<Index, 2> pair = ordered(t, crossings_[at(crossing)].triangle);
    const auto begin = std::lower_bound(ends_.begin(), ends_.end(), SegmentEnd{pair, 0});
    const auto end = std::lower_bound(begin, ends_.end(), SegmentEnd{{pair[0], pair[1] + 1}, 0});
    if (end - begin != 2) return -1;
    return begin->crossing == crossing ? (begin + 1)->crossing : begin->crossing;
  }

  Index end_particle(Index crossing, std::size_t k) const {
    const Index t = triangle_at(crossing, k);
    return t < 0 ? -1 : shared_particle(triangles_[at(t)], triangles_[at(crossings_[at(crossing)].triangle)]);
  }

  // From `first` into the triangle `k` of its edge, to the end or back to the beginning.
  IntersectionContour trace(Index first, std::size_t k) {
    IntersectionContour contour;
    contour.end_particle[0] = end_particle(first, 1 - k);
    Index c = first;
    std::size_t leave = k;
    int side = 0;  // the side of the edge of crossing c
    for (;;) {
      contour.points.push_back({c, side});
      done_[at(c)] = 1;
      const Index next = partner(c, leave);
      if (next < 0) {
        contour.end_particle[1] = end_particle(c, leave);
        return contour;
      }
      std::array<Index, 2> pair;
      pair[static_cast<std::size_t>(side)] = triangle_at(c, leave);
      pair[static_cast<std::size_t>(1 - side)] = crossings_[at(c)].triangle;
      contour.triangles.push_back(pair);
      // Of the next crossing one triangle is the one passed through; the edge belongs to the other.
      const int next_side = crossings_[at(next)].triangle == pair[1] ? 0 : 1;
      const std::size_t came_from = triangle_at(next, 0) == pair[static_cast<std::size_t>(next_side)] ? 0 : 1;
      if (next == first) {
        contour.closed = true;
        contour.end_particle = {-1, -1};
        contour.sides_joined = next_side != 0;
        return contour;
      }
      if (done_[at(next)]) return contour;  // only if the crossings are inconsistent
      c = next;
      side = next_side;
      leave = 1 - came_from;
    }
  }

  const Topology& topology_;
  std::span<const Triangle> triangles_;
  std::span<const SurfaceCrossing> crossings_;
  std::vector<Index> edges_;      // [crossing]
  std::vector<SegmentEnd> ends_;  // sorted
  std::vector<char> done_;        // [crossing]
};

}  // namespace

Index find_edge(const Topology& topology, std::array<Index, 2> edge) {
  const std::array<Index, 2> wanted = ordered(edge[0], edge[1]);
  const auto found = std::lower_bound(topology.edges.begin(), topology.edges.end(), wanted,
                                      [](const Edge& e, const std::array<Index, 2>& w) {
                                        return std::array{e.a, e.b} < w;
                                      });
  if (found == topology.edges.end() || found->a != wanted[0] || found->b != wanted[1]) return -1;
  return static_cast<Index>(found - topology.edges.begin());
}

std::vector<IntersectionContour> trace_contours(const Topology& topology, std::span<const Triangle> triangles,
                                                std::span<const SurfaceCrossing> crossings) {
  return Tracer(topology, triangles, crossings).all();
}

double contour_length(const IntersectionContour& contour, std::span<const SurfaceCrossing> crossings,
                      std::span<const Vec3> x) {
  const auto position = [&](std::size_t k) -> const Vec3& {
    return crossings[at(contour.points[k].crossing)].position;
  };
  const std::size_t count = contour.points.size();
  double length = 0;
  for (std::size_t k = 0; k + 1 < count; ++k) length += (position(k + 1) - position(k)).norm();
  if (contour.closed) length += (position(0) - position(count - 1)).norm();
  if (contour.end_particle[0] >= 0) length += (position(0) - x[at(contour.end_particle[0])]).norm();
  if (contour.end_particle[1] >= 0) length += (position(count - 1) - x[at(contour.end_particle[1])]).norm();
  return length;
}

SurfaceRegions::SurfaceRegions(const Topology& topology, std::size_t particle_count, std::vector<double> area_m2)
    : topology_(&topology), area_m2_(std::move(area_m2)), cut_(topology.edges.size(), 0), bank_(particle_count, -1) {
  std::vector<std::size_t> degree(particle_count + 1, 0);
  for (const Edge& e : topology.edges) {
    ++degree[at(e.a) + 1];
    ++degree[at(e.b) + 1];
  }
  for (std::size_t i = 1; i < degree.size(); ++i) degree[i] += degree[i - 1];
  offsets_ = degree;
  neighbours_.resize(offsets_.back());
  for (std::size_t k = 0; k < topology.edges.size(); ++k) {
    const Edge& e = topology.edges[k];
    neighbours_[degree[at(e.a)]++] = {e.b, static_cast<Index>(k)};
    neighbours_[degree[at(e.b)]++] = {e.a, static_cast<Index>(k)};
  }
}

// A curve that separates gives every particle a bank: the same across an edge that is not cut, or cut an even number of
// times, the other one across an odd number.  It does not separate exactly when such banks contradict each other.
CutRegion SurfaceRegions::cut_off(const IntersectionContour& contour, std::span<const SurfaceCrossing> crossings,
                                  int side) {
  std::vector<Index> cut_edges;
  for (const ContourPoint& point : contour.points)
    if (point.edge_side == side || contour.sides_joined)
      cut_edges.push_back(find_edge(*topology_, crossings[at(point.crossing)].edge));
  CutRegion region;
  region.separates = true;
  if (cut_edges.empty()) return region;
  for (const Index e : cut_edges) cut_[at(e)] ^= 1;

  std::array<double, 2> area{0, 0};
  queue_.clear();
  for (const Index e : cut_edges) {  // all lie in one connected surface, unless the contour is degenerate
    if (!cut_[at(e)] || bank_[at(topology_->edges[at(e)].a)] >= 0) continue;
    if (!queue_.empty()) break;
    bank_[at(topology_->edges[at(e)].a)] = 0;
    queue_.push_back(topology_->edges[at(e)].a);
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      const Index i = queue_[k];
      const std::int8_t bank = bank_[at(i)];
      area[static_cast<std::size_t>(bank)] += area_m2_[at(i)];
      for (const auto& [j, edge] : around(i)) {
        const auto expected = static_cast<std::int8_t>(bank ^ cut_[at(edge)]);
        if (bank_[at(j)] < 0) {
          bank_[at(j)] = expected;
          queue_.push_back(j);
        } else if (bank_[at(j)] != expected) {
          region.separates = false;
        }
      }
    }
  }
  const std::int8_t smaller = area[1] < area[0] ? 1 : 0;
  if (region.separates) {
    for (const Index i : queue_)
      if (bank_[at(i)] == smaller) region.particles.push_back(i);
    std::sort(region.particles.begin(), region.particles.end());
    region.area_m2 = area[static_cast<std::size_t>(smaller)];
    region.rest_m2 = area[static_cast<std::size_t>(1 - smaller)];
  }
  for (const Index i : queue_) bank_[at(i)] = -1;
  for (const Index e : cut_edges) cut_[at(e)] = 0;
  return region;
}

void SurfaceRegions::grow(std::vector<char>& marked, int rings) const {
  std::vector<Index> front, next;
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i]) front.push_back(static_cast<Index>(i));
  for (int ring = 0; ring < rings; ++ring) {
    next.clear();
    for (const Index i : front)
      for (const auto& [j, edge] : around(i)) {
        if (marked[at(j)]) continue;
        marked[at(j)] = 1;
        next.push_back(j);
      }
    front.swap(next);
  }
}

}  // namespace toile::internal
