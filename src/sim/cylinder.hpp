// sim/cylinder.hpp: an upright solid cylinder with rounded rims, of 322 vertices and 640 triangles: the solid of the
// paper's first two figures, by its counts.                                                                [BW98 8]
#pragma once
#include "core/types.hpp"

#include <vector>

namespace toile {

struct SolidMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;  // counter-clockwise from outside
};

// `top` is the middle of the upper cap; lengths in metres, > 0.
SolidMesh rounded_cylinder(double radius_m, double height_m, const Vec3& top);

}  // namespace toile
