#include "sim/cloth_shapes.hpp"

#include "core/elementary.hpp"
#include "io/json.hpp"

#include <fmt/printf.h>

#include <numbers>

namespace toile::internal {

void settle(const Json& value, SceneTube& tube) {
  if (tube.edge_m > tube.radius_m)
    value.fail("an edge_m of at most its radius_m", fmt::sprintf("%g of %g", tube.edge_m, tube.radius_m));
}

ClothSize size_of(const SceneGrid& grid) { return {grid.width_m * grid.height_m, 2 * (grid.width_m + grid.height_m)}; }
ClothSize size_of(const SceneTube& tube) {
  return {2 * std::numbers::pi * tube.radius_m * tube.length_m, 4 * std::numbers::pi * tube.radius_m};
}

MeshedCloth load(const SceneGrid& grid, const SceneCloth& whole, const TextSource&) {
  const Vec2 middle(0.5 * grid.width_m, 0.5 * grid.height_m);
  return drawn({grid.width_m, grid.height_m, grid.edge_m}, whole, warp_upright, [&](const Vec2& p) {
    const Vec2 q = p - middle;
    return Vec3(q.x(), q.y(), 0);
  });
}

MeshedCloth load(const SceneTube& tube, const SceneCloth& whole, const TextSource&) {
  const double around_m = 2 * std::numbers::pi * tube.radius_m;
  check_length("radius_m", "around it", around_m);
  return drawn({around_m, tube.length_m, tube.edge_m, true}, whole, warp_upright, [&](const Vec2& p) {
    const double angle = p.x() / tube.radius_m;  // from z to x: to the right, seen from outside
    return Vec3(tube.radius_m * ieee_sin(angle), p.y() - 0.5 * tube.length_m, tube.radius_m * ieee_cos(angle));
  });
}

ClothCost cost(const SceneGrid& grid, const SceneCloth& whole, const TextSource&) {
  return cost_of_drawing(SceneGrid::key, size_of(grid), grid.edge_m, whole);
}
ClothCost cost(const SceneTube& tube, const SceneCloth& whole, const TextSource&) {
  return cost_of_drawing(SceneTube::key, size_of(tube), tube.edge_m, whole);
}

}  // namespace toile::internal
