#include "verify/winding.hpp"

#include "core/disjoint_sets.hpp"
#include "verify/hem_loops.hpp"
#include "verify/predicates.hpp"

#include <algorithm>
#include <utility>

namespace toile::internal {
namespace {

// Triangles and positions.
std::pair<std::vector<Triangle>, Vec3s> close_holes(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  std::pair<std::vector<Triangle>, Vec3s> closed{{triangles.begin(), triangles.end()}, {x.begin(), x.end()}};
  const std::vector<Side> boundary = hem_sides(triangles);
  if (boundary.empty()) return closed;

  // One fan per connected piece of the boundary.  The boundary of a fan around any point is the piece itself, reversed.
  DisjointSets pieces(x.size());
  for (const auto& [a, b] : boundary) pieces.join(a, b);
  std::vector<Index> middle(x.size(), -1);
  std::vector<int> members(x.size(), 0);
  for (const auto& [a, b] : boundary) {
    const auto piece = static_cast<std::size_t>(pieces.find(a));
    if (middle[piece] < 0) {
      middle[piece] = static_cast<Index>(closed.second.size());
      closed.second.push_back(Vec3::Zero());
    }
    closed.second[static_cast<std::size_t>(middle[piece])] += x[static_cast<std::size_t>(a)];
    ++members[piece];
    closed.first.push_back({b, a, middle[piece]});
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    if (middle[i] >= 0) closed.second[static_cast<std::size_t>(middle[i])] /= members[i];
  return closed;
}

}  // namespace

ClosedSurface::ClosedSurface(std::span<const Triangle> triangles, std::span<const Vec3> x)
    : ClosedSurface(close_holes(triangles, x)) {}

ClosedSurface::ClosedSurface(std::pair<std::vector<Triangle>, Vec3s> closed)
    : triangles_(std::move(closed.first)), x_(std::move(closed.second)), tree_(triangles_, x_) {
  for (const Vec3& p : x_) bounds_.add(p);
}

// Crossings of the ray from p upwards, with their direction.
int ClosedSurface::winding_number(const Vec3& p) const {
  Vec3 far = p;
  far.y() = std::max(p.y(), bounds_.high.y()) + std::max(1.0, bounds_.high.y() - bounds_.low.y());
  ExactBox ray;
  ray.add(p);
  ray.add(far);
  const auto particles = static_cast<std::int64_t>(x_.size());
  const RankedPoint from{p, particles}, to{far, particles + 1};
  int winding = 0;
  tree_.visit_meeting(ray, [&](Index t) {
    const auto [i, j, k] = triangles_[static_cast<std::size_t>(t)];
    const RankedPoint a{x_[static_cast<std::size_t>(i)], i}, b{x_[static_cast<std::size_t>(j)], j},
        c{x_[static_cast<std::size_t>(k)], k};
    if (segment_crosses_triangle(from, to, a, b, c)) winding += orient3d_perturbed(a, b, c, from);
  });
  return winding;
}

}  // namespace toile::internal
