#include "mesh/inner_walls.hpp"

#include "core/disjoint_sets.hpp"
#include "mesh/half_edges.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace toile::internal {
namespace {

// An odd number, along no edge of a model that stands upright.
const std::array<Vec3, 5> ray_directions = {Vec3(0.803, 0.211, 0.557), Vec3(-0.691, 0.317, 0.650),
                                            Vec3(0.127, -0.913, 0.388), Vec3(-0.297, -0.151, -0.943),
                                            Vec3(0.419, 0.671, -0.612)};

bool crosses(const Vec3& from, const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, p = direction.cross(ac);
  const double det = ab.dot(p);
  if (det == 0) return false;
  const Vec3 s = from - a, q = s.cross(ab);
  const double u = s.dot(p) / det, v = direction.dot(q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && ac.dot(q) / det > 0;
}

// `counts` says of each triangle whether it is there.
template <class F>
bool inside(const Vec3& point, std::span<const Triangle> triangles, std::span<const Vec3> x, const F& counts) {
  std::size_t odd = 0;
  for (const Vec3& direction : ray_directions) {
    std::size_t crossed = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (counts(t) &&
          crosses(point, direction, x[at(triangles[t][0])], x[at(triangles[t][1])], x[at(triangles[t][2])]))
        ++crossed;
    odd += crossed % 2;
  }
  return 2 * odd > ray_directions.size();
}

// [triangle] the smallest triangle of its patch; `on_crowded` [that triangle]: the patch lies on an edge of three or more.
std::vector<Index> patches(std::span<const Triangle> triangles, std::vector<char>& on_crowded) {
  const std::vector<HalfEdge> sides = sorted_half_edges(triangles);
  DisjointSets sets(triangles.size());
  std::vector<Index> crowded;
  for (std::size_t first = 0; first < sides.size();) {
    const std::size_t end = edge_end(sides, first);
    if (end - first == 2) sets.join(sides[first].triangle, sides[first + 1].triangle);
    for (std::size_t s = first; s < end && end - first > 2; ++s) crowded.push_back(sides[s].triangle);
    first = end;
  }
  on_crowded.assign(triangles.size(), 0);
  for (const Index t : crowded) on_crowded[at(sets.find(t))] = 1;
  return sets.representatives();
}

}  // namespace

bool is_inside(const Vec3& point, std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  return inside(point, triangles, positions, [](std::size_t) { return true; });
}

std::vector<char> inner_walls(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  std::vector<char> wall(triangles.size(), 0), on_crowded;
  const std::vector<Index> patch = patches(triangles, on_crowded);
  std::vector<std::vector<Index>> members(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (on_crowded[at(patch[t])] != 0) members[at(patch[t])].push_back(static_cast<Index>(t));
  const auto area = [&](Index t) {
    const auto [a, b, c] = triangles[at(t)];
    return (positions[at(b)] - positions[at(a)]).cross(positions[at(c)] - positions[at(a)]).norm();
  };
  constexpr std::size_t probes = 5;  // the largest triangles of a patch
  // Of a surface that is crowded everywhere no wall is looked for: it would take more than some ten seconds.
  constexpr double most_tests = 2e9;
  const auto patches_there = std::count_if(members.begin(), members.end(), [](const auto& of) { return !of.empty(); });
  if (static_cast<double>(patches_there) * probes * ray_directions.size() * static_cast<double>(triangles.size()) >
      most_tests)
    return wall;
  for (std::vector<Index>& of : members) {
    if (of.empty()) continue;
    std::stable_sort(of.begin(), of.end(), [&](Index s, Index t) { return area(s) > area(t); });
    const std::size_t count = std::min(probes, of.size());
    std::size_t within = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const auto [a, b, c] = triangles[at(of[n])];
      const Vec3 middle = (positions[at(a)] + positions[at(b)] + positions[at(c)]) / 3;
      const Index own = patch[at(of[n])];
      within += inside(middle, triangles, positions, [&](std::size_t t) { return patch[t] != own; }) ? 1 : 0;
    }
    if (2 * within > count)
      for (const Index t : of) wall[at(t)] = 1;
  }
  return wall;
}

}  // namespace toile::internal
