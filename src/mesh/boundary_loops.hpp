// mesh/boundary_loops.hpp: the rims of holes of a surface, and triangles that cap them.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// Closed curves of vertices, as the triangles beside them walk; none meets itself.  Of an oriented surface without edges of three triangles.
std::vector<std::vector<Index>> boundary_loops(std::span<const Triangle> triangles);

// Ears are cut off the loop, in the plane of its mean normal, those with the shortest cut first; no new vertex.  No cut lies along an edge of the
// triangles.
std::vector<Triangle> cap(std::span<const Index> loop, std::span<const Triangle> triangles,
                          std::span<const Vec3> positions);

}  // namespace toile::internal
