// verify/hem_loops.hpp: the closed curves along which a cloth ends.
#pragma once
#include "core/types.hpp"

#include <array>
#include <span>
#include <vector>

namespace toile::internal {

using Side = std::array<Index, 2>;

// The sides of triangles that no other one walks the other way, ascending: as chains, sides - reversed.  As many end in a particle as begin there.
std::vector<Side> hem_sides(std::span<const Triangle> triangles);

// Each as particles in the order in which its triangles walk them, from its lowest one; curves that share a particle are told apart by
// following the lower one first.  Corners must be in range, and every edge have at most two triangles, which walk it in opposite directions.
std::vector<std::vector<Index>> hem_loops(std::span<const Triangle> triangles);

}  // namespace toile::internal
