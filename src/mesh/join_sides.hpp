// mesh/join_sides.hpp: vertices that a file had to split are one again.                                        docs/scenes.md#meshes
//
// Formats with one uv or normal per vertex have a vertex once for each side of a seam of the drawing.  Two vertices become one where the surface
// says so, not because they are near: two sides of triangles that lie exactly on each other, run in opposite directions and have no other
// neighbour are the two sides of such a seam.  So two layers of cloth that lie on each other stay two: inside a layer every side has its neighbour,
// hems of layers that face one way run the same way, and of layers that face each other the triangles themselves coincide.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct JoinedSides {
  std::vector<Index> same_as;  // [vertex] the first of those that it is one with; itself where it is alone
  std::size_t joined = 0;      // vertices that are one with an earlier one
  // Sides without neighbour that lie exactly on others and are not joined: which belong together cannot be told.
  std::size_t left = 0;
};

// Where several sides could be joined at a place, those of one part come first: `part` is a number per triangle, or empty.
// Corners must be in range, positions no NaN.
JoinedSides join_sides(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                       std::span<const Index> part);

// The triangles with every corner the first of those that it is one with.
std::vector<Triangle> joined_triangles(std::span<const Triangle> triangles, const JoinedSides& joined);

}  // namespace toile::internal
