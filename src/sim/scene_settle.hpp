// sim/scene_settle.hpp: checks the keys of an object against each other, and sets defaults that depend on other keys.
//
// `value` is the JSON that the object was read from; throws InputError with its place.
#pragma once
#include "io/json.hpp"
#include "sim/scene.hpp"

namespace toile::internal {

template <class T>
void settle(const Json&, T&) {}  // no key depends on another

void settle(const Json& value, ScenePin& pin);
void settle(const Json& value, SceneDrag& drag);
void settle(const Json& value, SceneCloth& cloth);
void settle(const Json& value, SceneMotion& motion);
void settle(const Json& value, SceneCollider& collider);
void settle(const Json& value, Scene& scene);

// Throws at the time of the first key of `moves` that does not come after the one before.
void check_ascending(const Json& moves, const std::vector<RigidKey>& keys);

}  // namespace toile::internal
