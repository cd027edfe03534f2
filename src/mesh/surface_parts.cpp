#include "mesh/surface_parts.hpp"

#include "core/disjoint_sets.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace toile::internal {
SurfaceParts surface_parts(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  DisjointSets sets(positions.size());
  for (const Triangle& t : triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<Index> number(positions.size(), -1);  // of the part, at the vertex that represents it
  for (const Triangle& t : triangles) number[at(sets.find(t[0]))] = 0;
  SurfaceParts result;
  for (Index& n : number) {
    if (n < 0) continue;
    n = static_cast<Index>(result.parts.size());
    result.parts.emplace_back();
  }
  std::vector<std::pair<Index, Index>> sides;
  sides.reserve(3 * triangles.size());
  result.of.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    const Index root = sets.find(t[0]);
    result.of.push_back(number[at(root)]);
    const Vec3& origin = positions[at(root)];  // near the part: the volume keeps its digits
    const Vec3 &a = positions[at(t[0])], &b = positions[at(t[1])], &c = positions[at(t[2])];
    result.parts[at(result.of.back())].volume_m3 += (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
    for (std::size_t k = 0; k < 3; ++k) sides.emplace_back(t[k], t[(k + 1) % 3]);
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto [a, b] = sides[i];
    const bool once = i == 0 || sides[i - 1] != sides[i];
    if (!once || !std::binary_search(sides.begin(), sides.end(), std::pair{b, a}))
      result.parts[at(number[at(sets.find(a))])].closed = false;
  }
  return result;
}

}  // namespace toile::internal
