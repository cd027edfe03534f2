// sim/colliders.hpp: the colliders of a scene: the body, and solids beside it.
//
// A kind of collider is a struct with the key that chooses it and three functions: `describe_choice` (that key, sim/settings.hpp),
// `load` (its surface) and `cost` (of loading it); `describe_beside` if it has other keys.  Everything else follows from its line in
// ColliderShape.
#pragma once
#include "dress/keyed.hpp"
#include "dress/rigid_path.hpp"
#include "sim/collider_capsule.hpp"
#include "sim/collider_person.hpp"
#include "sim/collider_solid.hpp"
#include "sim/kinds.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace toile::internal {

using ColliderShape = std::variant<std::monostate,  // nothing
                                   SceneMannequin, SceneMesh, SceneArrays, SceneSphere, SceneBox, SceneRevolved,
                                   SceneCylinder, SceneCapsule>;

struct SceneCollider {
  ColliderShape shape;
  bool worn = false;                  // the body that cloth is dressed on
  std::optional<SceneMotion> motion;  // of a mannequin or a mesh
  double edge_m = 0.02;               // of curved shapes
  bool inside_out = false;            // a room
  Vec3 translation_m{0, 0, 0};
  Vec3 rotation_deg{0, 0, 0};
  RigidPath moves;                         // about its translation_m, added to its own motion
  ColliderContact contact;                 // the body's is the default of solids (sim/setup.hpp)
  std::vector<FrictionKey> friction_path;  // replaces its constant; the body's is likewise the default

  bool exists() const { return !std::holds_alternative<std::monostate>(shape); }
  template <class Kind>
  const Kind* as() const {
    return std::get_if<Kind>(&shape);
  }
  bool is_person() const { return as<SceneMannequin>() != nullptr || as<SceneMesh>() != nullptr; }
  bool moves_by_itself() const { return motion.has_value() || !moves.empty(); }
};

// It is or will be elsewhere than its shape was made.
inline bool is_placed(const SceneCollider& c) {
  return c.inside_out || !c.moves.empty() || c.translation_m != Vec3::Zero() || c.rotation_deg != Vec3::Zero();
}

// Placed, with its motion.  Nothing: no surface.  `path` is its own in the scene, "/solids/2".  Throws InputError of it for an invalid shape,
// and for moves faster than most_led_m_per_s.
Collider load_collider(const SceneCollider& collider, std::string_view path = {});
ColliderCost cost_of(const SceneCollider& collider);

// The body, if there is one, and the solids, in this order, as one.
struct LoadedColliders {
  JoinedColliders joined;
  std::size_t worn_vertices = 0, worn_triangles = 0;  // of the body: they come first
  std::optional<BodyMeasurements> measurements;       // likewise
  std::vector<std::string> warnings;
  std::vector<std::uint64_t> input_hashes;  // of each
};
LoadedColliders load_colliders(const SceneCollider& body, std::span<const SceneCollider> solids);

// Throws InputError("", "/moves/2", ...).of(path) for moves of a point within `reach_m` of their centre faster than most_led_m_per_s.
void check_speed(const RigidPath& moves, double reach_m, std::string_view path);

inline std::string path_of_solid(std::size_t k) { return "/solids/" + std::to_string(k); }

}  // namespace toile::internal
