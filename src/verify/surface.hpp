// verify/surface.hpp: the checks of a surface before any measurement.
#pragma once
#include "core/types.hpp"

#include <span>
#include <string_view>

namespace toile::internal {

// Throws InputError(name, "triangle 3" | "vertex 7", ...) when an index is out of range, a triangle has a corner twice,
// or a position is not finite.
void check_surface(std::string_view name, std::span<const Triangle> triangles, std::span<const Vec3> x);

}  // namespace toile::internal
