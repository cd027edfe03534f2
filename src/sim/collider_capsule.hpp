// sim/collider_capsule.hpp: a rod with round ends: a limb, a pole, a rail.
#pragma once
#include "sim/collider.hpp"
#include "sim/collider_solid.hpp"
#include "sim/settings.hpp"

#include <string_view>

namespace toile::internal {

struct SceneCapsule {
  static constexpr std::string_view key = "capsule";
  double radius_m = 0;
  Vec3 from_m{0, 0, 0}, to_m{0, 0, 0};  // the centres of its round ends
};
template <class V>
void describe(V& v, SceneCapsule& capsule) {
  v.number(Setting{"radius_m", "its radius"}.needs(), length_of_a_solid, capsule.radius_m);
  v.vector(Setting{"from_m", "middle of one round end"}.needs(), anywhere, capsule.from_m);
  v.vector(Setting{"to_m", "middle of the other"}.needs(), anywhere, capsule.to_m);
}
template <class V>
void describe_choice(V& v, SceneCapsule& capsule, bool) {
  v.object({"capsule", "a rod with round ends", "no"}, capsule);
}

// Throws InputError("", "to_m", ...) for coincident ends: that is a sphere.
Collider load(const SceneCapsule& capsule, const SceneCollider& whole);
ColliderCost cost(const SceneCapsule& capsule, const SceneCollider& whole);

}  // namespace toile::internal
