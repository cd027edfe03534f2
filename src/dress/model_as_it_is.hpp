// dress/model_as_it_is.hpp: a cloth without a pattern, whose rest shape is its present shape.
//
// Every triangle is flattened by itself: no uv is needed, and rest lengths are exactly those of x.  So are rest angles.
//
// Easily got wrong: the threads of neighbours do not line up, so the fabric must be the same along both.
#pragma once
#include "assembly/cloth_model.hpp"

#include <span>

namespace toile::internal {

// Without gravity.  Every triangle must have an area.
ClothModel model_as_it_is(std::span<const Triangle> triangles, std::span<const Vec3> x, const Fabric& fabric);

}  // namespace toile::internal
