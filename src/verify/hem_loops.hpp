// verify/hem_loops.hpp: the boundary loops of a cloth.
#pragma once
#include "core/types.hpp"

#include <array>
#include <span>
#include <vector>

namespace toile::internal {

using Side = std::array<Index, 2>;

// The half edges without an opposite one, ascending: as chains, sides - reversed.  As many end in a particle as begin there.
std::vector<Side> hem_sides(std::span<const Triangle> triangles);

// Each loop as particles in the order of its half edges, from its lowest one; loops that share a particle are separated by following
// the lower one first.  Corners must be in range, and every edge have at most two triangles, which walk it in opposite directions.
std::vector<std::vector<Index>> hem_loops(std::span<const Triangle> triangles);

}  // namespace toile::internal
