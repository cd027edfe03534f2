// mesh/inner_walls.hpp: triangles inside a surface.
//
// Patches are what edges of three triangles and more separate.  A ray from inside a closed surface crosses it an odd number of times, whichever
// way its triangles face: a patch from which most rays do so, through all other patches, is a wall.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// [triangle] 1: a wall.  Of triangles with three different corners.
std::vector<char> inner_walls(std::span<const Triangle> triangles, std::span<const Vec3> positions);

// Most rays from a point cross the triangles an odd number of times.
bool is_inside(const Vec3& point, std::span<const Triangle> triangles, std::span<const Vec3> positions);

}  // namespace toile::internal
