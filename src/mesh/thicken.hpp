// mesh/thicken.hpp: an open sheet as a closed slab.                                                               docs/scenes.md#open-sheets
//
// The sheet stays the front; behind each vertex lies another, at `thickness` along its normal, weighted by angles; a rim joins both.  Where the
// sheet is bent away from its front more closely than that, the back passes through itself; the front never changes.
#pragma once
#include "core/types.hpp"

#include <vector>

namespace toile::internal {

// Of an oriented surface of which no edge has three triangles.  A vertex at which fans of triangles meet becomes one for each fan.
void thicken(double thickness, std::vector<Vec3>& positions, std::vector<Triangle>& triangles);

}  // namespace toile::internal
