#include "sim/cylinder.hpp"

#include "core/elementary.hpp"

#include <algorithm>
#include <cmath>

namespace toile {

// 10 rings of 32 and two poles: 322 vertices; 64 triangles between neighbouring rings and 32 at each pole: 640.
SolidMesh rounded_cylinder(double radius_m, double height_m, const Vec3& top) {
  constexpr Index around = 32, rings = 10;
  const double rim = 0.15 * std::min(radius_m, 0.5 * height_m), bevel = rim * (1 - std::sqrt(0.5));
  // Distance from the axis and depth below the cap, down to the middle; the lower half mirrors it.
  const std::array<std::array<double, 2>, 5> upper = {{{0.5 * radius_m, 0},
                                                       {radius_m - rim, 0},
                                                       {radius_m - bevel, bevel},
                                                       {radius_m, rim},
                                                       {radius_m, rim + (height_m - 2 * rim) / 3}}};
  SolidMesh solid;
  for (Index ring = 0; ring < rings; ++ring) {
    const auto [r, depth] =
        ring < 5 ? upper[static_cast<std::size_t>(ring)] : upper[static_cast<std::size_t>(rings - 1 - ring)];
    const double y = ring < 5 ? -depth : depth - height_m;
    for (Index i = 0; i < around; ++i) {
      // Rings are staggered by half a piece, so that triangles are nearly isosceles.
      const double angle = 2 * 3.14159265358979323846 * (i + 0.5 * (ring % 2)) / around;
      solid.positions.push_back(top + Vec3(r * ieee_cos(angle), y, r * ieee_sin(angle)));
    }
  }
  const Index north = around * rings, south = north + 1;
  solid.positions.push_back(top);
  solid.positions.push_back(top - Vec3(0, height_m, 0));
  for (Index i = 0; i < around; ++i) {
    const Index next = (i + 1) % around;
    solid.triangles.push_back({north, next, i});
    for (Index ring = 0; ring + 1 < rings; ++ring) {
      const Index a = ring * around + i, b = ring * around + next, c = a + around, d = b + around;
      if (ring % 2 == 0) {
        solid.triangles.push_back({a, b, c});
        solid.triangles.push_back({b, d, c});
      } else {
        solid.triangles.push_back({a, b, d});
        solid.triangles.push_back({a, d, c});
      }
    }
    solid.triangles.push_back({south, (rings - 1) * around + i, (rings - 1) * around + next});
  }
  return solid;
}

}  // namespace toile
