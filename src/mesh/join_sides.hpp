// mesh/join_sides.hpp: joins vertices that a file had to split.                                                docs/scenes.md#meshes
//
// Formats with one uv or normal per vertex duplicate the vertices of a texture seam.  Two vertices are joined by topology, not by distance: two
// half edges that lie exactly on each other, run in opposite directions and have no other neighbour are the two sides of such a seam.  So two
// layers of cloth that lie on each other stay apart: inside a layer every half edge has its neighbour, hems of layers that face one way run the
// same way, and where layers face each other the triangles themselves coincide.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct JoinedSides {
  std::vector<Index> same_as;  // [vertex] the first of the vertices that it is joined with, or itself
  std::size_t joined = 0;      // vertices that are joined to an earlier one
  // Boundary half edges that lie exactly on others and are not joined, as their partner is ambiguous.
  std::size_t left = 0;
};

// Where a half edge has several candidates, those of its own part come first: `part` is a number per triangle, or empty.
// Corners must be in range, positions no NaN.
JoinedSides join_sides(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                       std::span<const Index> part);

// The triangles with every corner replaced by the first of its joined vertices.
std::vector<Triangle> joined_triangles(std::span<const Triangle> triangles, const JoinedSides& joined);

}  // namespace toile::internal
