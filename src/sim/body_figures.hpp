// sim/body_figures.hpp: what the linter of patterns asks of a body (garment/lint.hpp), measured on its surface.
#pragma once
#include "garment/lint.hpp"

#include <span>

namespace toile {

// Of an upright person; what is not found is 0.
BodyFigures body_figures(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace toile
