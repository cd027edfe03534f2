// tests/support/crossings.hpp: does cloth pass through itself?  A reference without the library's code.
#pragma once
#include "core/types.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace toile::internal::test {

// Edges of the mesh that pass through one of its triangles, by testing all pairs: the definition.
inline int crossings_of(const Vec3s& x, const std::vector<Triangle>& triangles) {
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  int count = 0;
  for (const Triangle& edges : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index i = edges[k], j = edges[(k + 1) % 3];
      const Vec3 &p = x[at(i)], &q = x[at(j)];
      for (const Triangle& t : triangles) {
        if (std::any_of(t.begin(), t.end(), [&](Index corner) { return corner == i || corner == j; })) continue;
        const Vec3 &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])];
        const Vec3 n = (b - a).cross(c - a), d = q - p;
        if ((n.dot(p - a) > 0) == (n.dot(q - a) > 0)) continue;
        const double u = d.dot((a - p).cross(b - p)), v = d.dot((b - p).cross(c - p)), w = d.dot((c - p).cross(a - p));
        if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) ++count;
      }
    }
  }
  return count;
}

}  // namespace toile::internal::test
