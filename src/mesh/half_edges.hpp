// mesh/half_edges.hpp: the sides of all triangles, sorted so that the sides of one edge stand together.
//
// Private to this module.  A sort instead of a hash map: the order is the same on every machine, and the sorted
// array is convenient for its users.
#pragma once
#include "core/types.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace toile::internal {

struct HalfEdge {
  Index a, b;  // the smaller and the larger particle
  Index triangle;
  std::int8_t side;  // 0, 1, 2: from corner `side` to the next one
  bool forward;      // the triangle walks from a to b
};

// Throws InputError(where, "triangle 12", ...) for the first corner that is not in 0..particle_count-1 or is used
// twice.
void check_corners(std::string_view where, Index particle_count, std::span<const Triangle> triangles);

// Sorted by (a, b, triangle).  The corners must have passed check_corners.
std::vector<HalfEdge> sorted_half_edges(std::span<const Triangle> triangles);

// One past the last half edge of the edge that begins at `first`.
std::size_t edge_end(std::span<const HalfEdge> half_edges, std::size_t first);

// Throws InputError(where, "edge 3-7", ...) for the first edge with three or more triangles, or with two that walk it
// in the same direction.
void check_edges(std::string_view where, std::span<const HalfEdge> half_edges);

}  // namespace toile::internal
