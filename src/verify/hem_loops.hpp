// verify/hem_loops.hpp: the closed curves along which a cloth ends.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile {

// Each as particles in the order in which its triangles walk them, from its lowest one; curves that share a particle are told apart by
// following the lower one first.  Corners must be in range, and every edge have at most two triangles, which walk it in opposite directions.
std::vector<std::vector<Index>> hem_loops(std::span<const Triangle> triangles);

}  // namespace toile
