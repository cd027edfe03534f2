// sim/collider_solid.hpp: plain solids of a scene.                                                     body/solid_shapes.hpp
#pragma once
#include "sim/collider.hpp"
#include "sim/settings.hpp"

#include <string_view>
#include <vector>

namespace toile::internal {

struct SceneCollider;

inline constexpr Range length_of_a_solid{1e-3, 100};

struct SceneSphere {
  static constexpr std::string_view key = "sphere";
  double radius_m = 0;
};
template <class V>
void describe(V& v, SceneSphere& sphere) {
  v.number(Setting{"radius_m", "its radius"}.needs(), length_of_a_solid, sphere.radius_m);
}
template <class V>
void describe_choice(V& v, SceneSphere& sphere, bool) {
  v.object({"sphere", "around the origin", "no"}, sphere);
}

struct SceneBox {
  static constexpr std::string_view key = "box";
  Vec3 size_m{0, 0, 0};
};
template <class V>
void describe(V& v, SceneBox& box) {
  v.vector(Setting{"size_m", "along x, y and z"}.needs(), length_of_a_solid, box.size_m);
}
template <class V>
void describe_choice(V& v, SceneBox& box, bool) {
  v.object({"box", "around the origin", "no"}, box);
}

struct SceneRevolved {
  static constexpr std::string_view key = "revolved";
  std::vector<Vec2> profile_m;
};
template <class V>
void describe(V& v, SceneRevolved& shape) {
  v.rows(Setting{"profile_m", "from the axis to the axis, or a closed curve beside it"}.needs(), Rows{3},
         shape.profile_m, [](auto& row, Vec2& p) {
           row.column("distance from the axis", Range{0, 100}, p.x());
           row.column("height", Range{-100, 100}, p.y());
         });
}
template <class V>
void describe_choice(V& v, SceneRevolved& shape, bool) {
  v.object({"revolved", "an outline that sweeps around the y axis", "no"}, shape);
}

struct SceneCylinder {  // an upright solid whose rims are rounded
  static constexpr std::string_view key = "cylinder";
  double radius_m = 0.2, height_m = 0.5;
  Vec3 top_m{0, 0, 0};  // centre of the top
};
template <class V>
void describe(V& v, SceneCylinder& cylinder) {
  v.number({"radius_m", "its radius"}, {0.01, 10}, cylinder.radius_m);
  v.number({"height_m", "its height"}, {0.01, 10}, cylinder.height_m);
  v.vector({"top_m", "middle of its top"}, anywhere, cylinder.top_m);
}
template <class V>
void describe_choice(V& v, SceneCylinder& cylinder, bool) {
  v.object({"cylinder", "upright, with rounded rims", "no"}, cylinder);
}

// Throw InputError("", "edge_m" or "profile", ...) as body/solid_shapes.hpp says.
Collider load(const SceneSphere& sphere, const SceneCollider& whole);
Collider load(const SceneBox& box, const SceneCollider& whole);
Collider load(const SceneRevolved& shape, const SceneCollider& whole);
Collider load(const SceneCylinder& cylinder, const SceneCollider& whole);
ColliderCost cost(const SceneSphere& sphere, const SceneCollider& whole);
ColliderCost cost(const SceneBox& box, const SceneCollider& whole);
ColliderCost cost(const SceneRevolved& shape, const SceneCollider& whole);
ColliderCost cost(const SceneCylinder& cylinder, const SceneCollider& whole);

// A collider of this surface, which must be closed, without triangles on a line.  Throws InputError("", ...).
Collider standing(SolidMesh surface);
// The approximate cost of the surface that `revolved` makes of an outline.
double revolved_triangles(std::span<const Vec2> profile_m, double edge_m);

}  // namespace toile::internal
