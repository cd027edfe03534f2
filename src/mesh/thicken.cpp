#include "mesh/thicken.hpp"

#include "core/disjoint_sets.hpp"
#include "mesh/corner_normal.hpp"
#include "mesh/half_edges.hpp"

#include <cmath>
#include <cstddef>

namespace toile::internal {
namespace {

Index corner(Index triangle, std::size_t k) { return 3 * triangle + static_cast<Index>(k); }

// Numbers the corners anew, by fan: triangles at one vertex that hang together by edges.
void part_fans(std::span<const HalfEdge> sides, std::vector<Vec3>& positions, std::vector<Triangle>& triangles) {
  DisjointSets fans(3 * triangles.size());
  for (std::size_t s = 0; s + 1 < sides.size(); ++s) {
    const HalfEdge &one = sides[s], &two = sides[s + 1];
    if (one.a != two.a || one.b != two.b) continue;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        if (const Index v = triangles[at(one.triangle)][k];
            (v == one.a || v == one.b) && v == triangles[at(two.triangle)][l])
          fans.join(corner(one.triangle, k), corner(two.triangle, l));
  }
  const std::vector<Index> fan = fans.representatives();
  std::vector<Index> first(positions.size(), -1), number(3 * triangles.size(), -1);  // the first fan keeps the vertex
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t of = at(fan[at(corner(static_cast<Index>(t), k))]);
      const Index v = triangles[t][k];
      if (number[of] < 0) {
        number[of] = first[at(v)] < 0 ? v : static_cast<Index>(positions.size());
        if (first[at(v)] >= 0) positions.push_back(Vec3(positions[at(v)]));
        first[at(v)] = v;
      }
    }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) triangles[t][k] = number[at(fan[at(corner(static_cast<Index>(t), k))])];
}

std::vector<Vec3> normals(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  std::vector<Vec3> normal(x.size(), Vec3::Zero());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = x[at(t[k])];
      normal[at(t[k])] += corner_normal(x[at(t[(k + 1) % 3])] - p, x[at(t[(k + 2) % 3])] - p);
    }
  for (Vec3& n : normal)
    if (const double length = std::sqrt(n.squaredNorm()); length > 0) n /= length;
  return normal;
}

}  // namespace

void thicken(double thickness, std::vector<Vec3>& positions, std::vector<Triangle>& triangles) {
  const std::vector<HalfEdge> sides = sorted_half_edges(triangles);
  part_fans(sides, positions, triangles);
  const std::vector<Vec3> normal = normals(positions, triangles);
  const auto count = static_cast<Index>(positions.size());
  for (Index i = 0; i < count; ++i) positions.push_back(Vec3(positions[at(i)] - thickness * normal[at(i)]));
  std::vector<Triangle> rim;
  for (std::size_t first = 0; first < sides.size(); first = edge_end(sides, first)) {
    if (edge_end(sides, first) - first > 1) continue;
    const Triangle& t = triangles[at(sides[first].triangle)];
    const auto k = static_cast<std::size_t>(sides[first].side);
    const Index a = t[k], b = t[(k + 1) % 3];
    rim.insert(rim.end(), {Triangle{b, a, a + count}, Triangle{b, a + count, b + count}});
  }
  const std::size_t front = triangles.size();
  for (std::size_t t = 0; t < front; ++t) {
    const auto [a, b, c] = triangles[t];
    triangles.push_back({a + count, c + count, b + count});
  }
  triangles.insert(triangles.end(), rim.begin(), rim.end());
}

}  // namespace toile::internal
