#include "sim/collider_solid.hpp"

#include "mesh/check.hpp"
#include "sim/colliders.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

// Subdivided until no edge is too long: the longest are in the middle of the octahedron's faces.
double ball_triangles(double radius_m, double edge_m) {
  double triangles = 8;
  Vec3 a(1, 0, 0), b(0, 1, 0), c(0, 0, 1);
  while (radius_m * (a - b).norm() > edge_m && triangles < 1e12) {
    const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
    a = ab;
    b = bc;
    c = ca;
    triangles *= 4;
  }
  return triangles;
}

}  // namespace

Collider standing(SolidMesh surface) {
  check_closed("", surface.positions, surface.triangles);
  check_areas("", surface.positions, surface.triangles);
  Collider collider;
  collider.surface = std::move(surface);
  return collider;
}

double revolved_triangles(std::span<const Vec2> profile_m, double edge_m) {
  double along = 0, widest_m = 0;
  for (std::size_t p = 0; p < profile_m.size(); ++p) {
    widest_m = std::max(widest_m, profile_m[p].x());
    if (p > 0) along += std::ceil((profile_m[p] - profile_m[p - 1]).norm() / edge_m);
  }
  return 2 * along * std::max(6.0, 2 * std::numbers::pi * widest_m / edge_m);
}

Collider load(const SceneSphere& sphere, const SceneCollider& whole) {
  return standing(ball(sphere.radius_m, whole.edge_m));
}
Collider load(const SceneBox& box, const SceneCollider&) { return standing(block(box.size_m)); }
Collider load(const SceneRevolved& shape, const SceneCollider& whole) {
  return standing(revolved(shape.profile_m, whole.edge_m));
}
Collider load(const SceneCylinder& cylinder, const SceneCollider&) {
  return standing(rounded_cylinder(cylinder.radius_m, cylinder.height_m, cylinder.top_m));
}

ColliderCost cost(const SceneSphere& sphere, const SceneCollider& whole) {
  return {"(sphere)", ball_triangles(sphere.radius_m, whole.edge_m)};
}
ColliderCost cost(const SceneBox&, const SceneCollider&) { return {"(box)", 12}; }
ColliderCost cost(const SceneRevolved& shape, const SceneCollider& whole) {
  return {"(revolved)", revolved_triangles(shape.profile_m, whole.edge_m)};
}
ColliderCost cost(const SceneCylinder&, const SceneCollider&) { return {"(cylinder)", 640}; }

}  // namespace toile::internal
