// verify/gap.cpp: how near the cloth is to the body, and on which side (statistics.hpp).
#include "verify/box_tree.hpp"
#include "verify/nearest_point.hpp"
#include "verify/predicates.hpp"
#include "verify/statistics.hpp"
#include "verify/surface.hpp"

#include "core/parallel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace toile {
namespace {

using Side = std::array<Index, 2>;

// A surface without boundary: that of `triangles`, and a fan around the middle of each hole.
struct ClosedSurface {
  std::vector<Triangle> triangles;
  Vec3s x;
};

ClosedSurface close_holes(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  ClosedSurface closed{{triangles.begin(), triangles.end()}, {x.begin(), x.end()}};
  std::vector<Side> sides, reversed;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      sides.push_back({t[k], t[(k + 1) % 3]});
      reversed.push_back({t[(k + 1) % 3], t[k]});
    }
  std::sort(sides.begin(), sides.end());
  std::sort(reversed.begin(), reversed.end());
  // As chains the boundary is sides - reversed, each pair twice: the half of it that runs along a triangle.
  std::vector<Side> boundary;
  std::set_difference(sides.begin(), sides.end(), reversed.begin(), reversed.end(), std::back_inserter(boundary));
  if (boundary.empty()) return closed;

  // One fan per connected piece of the boundary.  The boundary of a fan around any point is the piece itself, reversed.
  std::vector<Index> root(x.size());
  for (std::size_t i = 0; i < root.size(); ++i) root[i] = static_cast<Index>(i);
  const auto find = [&](Index i) {
    while (root[static_cast<std::size_t>(i)] != i) {
      root[static_cast<std::size_t>(i)] = root[static_cast<std::size_t>(root[static_cast<std::size_t>(i)])];
      i = root[static_cast<std::size_t>(i)];
    }
    return i;
  };
  for (const auto& [a, b] : boundary) {
    const Index root_a = find(a), root_b = find(b);
    root[static_cast<std::size_t>(std::max(root_a, root_b))] = std::min(root_a, root_b);
  }
  std::vector<Index> middle(x.size(), -1);
  std::vector<int> members(x.size(), 0);
  for (const auto& [a, b] : boundary) {
    const auto piece = static_cast<std::size_t>(find(a));
    if (middle[piece] < 0) {
      middle[piece] = static_cast<Index>(closed.x.size());
      closed.x.push_back(Vec3::Zero());
    }
    closed.x[static_cast<std::size_t>(middle[piece])] += x[static_cast<std::size_t>(a)];
    ++members[piece];
    closed.triangles.push_back({b, a, middle[piece]});
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    if (middle[i] >= 0) closed.x[static_cast<std::size_t>(middle[i])] /= members[i];
  return closed;
}

// How often the surface winds around p: crossings of the ray from p upwards, with their direction.
int winding_number(const Vec3& p, const ClosedSurface& surface, const BoxTree& tree) {
  const ExactBox bounds = tree.bounds();
  Vec3 far = p;
  far.y() = std::max(p.y(), bounds.high.y()) + std::max(1.0, bounds.high.y() - bounds.low.y());
  ExactBox ray;
  ray.add(p);
  ray.add(far);
  const auto particles = static_cast<std::int64_t>(surface.x.size());
  const RankedPoint from{p, particles}, to{far, particles + 1};
  int winding = 0;
  tree.visit_meeting(ray, [&](Index t) {
    const auto [i, j, k] = surface.triangles[static_cast<std::size_t>(t)];
    const RankedPoint a{surface.x[static_cast<std::size_t>(i)], i}, b{surface.x[static_cast<std::size_t>(j)], j},
        c{surface.x[static_cast<std::size_t>(k)], k};
    if (segment_crosses_triangle(from, to, a, b, c)) winding += orient3d_perturbed(a, b, c, from);
  });
  return winding;
}

}  // namespace

GapStatistics measure_gap(std::span<const Vec3> x, std::span<const Triangle> body, std::span<const Vec3> body_x) {
  check_surface("cloth", {}, x);
  check_surface("body", body, body_x);
  GapStatistics result;
  if (x.empty() || body.empty()) return result;

  const ClosedSurface closed = close_holes(body, body_x);
  const BoxTree tree(body, body_x), closed_tree(closed.triangles, closed.x);
  const auto at = [&](Index i) -> const Vec3& { return body_x[static_cast<std::size_t>(i)]; };
  std::vector<double> gap_mm(x.size());
  parallel_for(x.size(), 256, [&](std::size_t i) {
    const BoxTree::Nearest nearest = tree.nearest(x[i], {}, [&](Index t) {
      const auto [a, b, c] = body[static_cast<std::size_t>(t)];
      return squared_distance_to_triangle(x[i], at(a), at(b), at(c));
    });
    const bool inside = winding_number(x[i], closed, closed_tree) != 0;
    gap_mm[i] = (inside ? -1000 : 1000) * std::sqrt(nearest.squared_distance);
  });
  const auto nearest = std::min_element(gap_mm.begin(), gap_mm.end());
  result.min_mm = *nearest;
  result.nearest_vertex = static_cast<Index>(nearest - gap_mm.begin());
  std::vector<double> hover_mm;
  for (const double gap : gap_mm) {
    if (gap >= 0 && gap <= hover_reach_mm) hover_mm.push_back(gap);
  }
  result.hovering = static_cast<Index>(hover_mm.size());
  result.hover_p50_mm = nearest_rank(hover_mm, 50);
  result.hover_p90_mm = nearest_rank(hover_mm, 90);
  result.p50_mm = nearest_rank(gap_mm, 50);
  return result;
}

}  // namespace toile
