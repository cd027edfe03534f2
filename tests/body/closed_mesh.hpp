// Questions about triangle meshes that several tests of the body ask.
#pragma once
#include "contact/triangle_tree.hpp"
#include "core/types.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal::test {

inline std::size_t edge_count(std::span<const Triangle> triangles) {
  std::set<std::pair<Index, Index>> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  return edges.size();
}

// V - E + F: 2 for a closed surface in one piece without handles.
inline int euler_characteristic(std::size_t vertices, std::span<const Triangle> triangles) {
  return static_cast<int>(vertices) - static_cast<int>(edge_count(triangles)) + static_cast<int>(triangles.size());
}

inline int piece_count(std::size_t vertices, std::span<const Triangle> triangles) {
  std::vector<Index> parent(vertices);
  for (std::size_t i = 0; i < vertices; ++i) parent[i] = static_cast<Index>(i);
  const auto root = [&](Index i) {
    while (parent[at(i)] != i) i = parent[at(i)];
    return i;
  };
  for (const Triangle& t : triangles)
    for (std::size_t k = 1; k < 3; ++k) {
      const Index a = root(t[0]), b = root(t[k]);
      parent[at(std::max(a, b))] = std::min(a, b);
    }
  int pieces = 0;
  for (std::size_t i = 0; i < vertices; ++i) pieces += parent[i] == static_cast<Index>(i);
  return pieces;
}

inline double smallest_angle_degrees(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  double largest_cosine = -1;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 u = x[at(t[(k + 1) % 3])] - x[at(t[k])], v = x[at(t[(k + 2) % 3])] - x[at(t[k])];
      largest_cosine = std::max(largest_cosine, u.dot(v) / (u.norm() * v.norm()));
    }
  return std::acos(std::min(largest_cosine, 1.0)) * 180 / M_PI;
}

// Whether the segment p-q passes through the triangle a, b, c.
inline bool passes_through(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 d = q - p, e1 = b - a, e2 = c - a, h = d.cross(e2);
  const double det = e1.dot(h);
  if (det == 0) return false;
  const Vec3 s = p - a;
  const double u = s.dot(h) / det;
  if (u < 0 || u > 1) return false;
  const Vec3 r = s.cross(e1);
  const double v = d.dot(r) / det;
  if (v < 0 || u + v > 1) return false;
  const double t = e2.dot(r) / det;
  return t >= 0 && t <= 1;
}

// Edges of the mesh that pass through a triangle with which they share no vertex.
inline int self_intersection_count(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  const TriangleTree tree(x, triangles);
  std::vector<std::pair<Index, Index>> pairs;
  tree.self_pairs(pairs);
  int count = 0;
  const auto crosses = [&](const Triangle& s, const Triangle& t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index p = s[k], q = s[(k + 1) % 3];
      if (std::find(t.begin(), t.end(), p) != t.end() || std::find(t.begin(), t.end(), q) != t.end()) continue;
      if (passes_through(x[at(p)], x[at(q)], x[at(t[0])], x[at(t[1])], x[at(t[2])])) return true;
    }
    return false;
  };
  for (const auto& [a, b] : pairs)
    count += crosses(triangles[at(a)], triangles[at(b)]) || crosses(triangles[at(b)], triangles[at(a)]);
  return count;
}

// A mesh with a tree, to ask whether a straight line meets it.
class Obstacle {
 public:
  Obstacle(std::span<const Vec3> x, std::span<const Triangle> triangles)
      : x_(x), triangles_(triangles), tree_(x, triangles) {}

  bool meets(const Vec3& p, const Vec3& q) const {
    std::vector<Index> near;
    tree_.overlapping({p.cwiseMin(q), p.cwiseMax(q)}, near);
    return std::any_of(near.begin(), near.end(), [&](Index i) {
      const Triangle& t = triangles_[at(i)];
      return passes_through(p, q, x_[at(t[0])], x_[at(t[1])], x_[at(t[2])]);
    });
  }

 private:
  std::span<const Vec3> x_;
  std::span<const Triangle> triangles_;
  TriangleTree tree_;
};

}  // namespace toile::internal::test
