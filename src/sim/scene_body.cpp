// sim/scene_body.cpp: checks the keys of a body and of solids against each other.
#include "body/motion.hpp"
#include "sim/scene_settle.hpp"

#include <algorithm>

namespace toile::internal {

void settle(const Json& value, SceneMotion& motion) {
  if (motion.path.empty() && value.is_object())
    if (const Json* fps = value.find("fps")) fps->fail("\"file\" beside it", "frames per second without a file");
}

void settle(const Json& value, SceneCollider& collider) {
  collider.moves.centre() = collider.translation_m;
  if (const Json* moves = value.find("moves")) check_ascending(*moves, collider.moves.keys());
  const bool mesh = collider.as<SceneMesh>() != nullptr;
  for (const char* key : {"unit", "measurements"})
    if (const Json* of_mesh = value.find(key); of_mesh != nullptr && !mesh)
      of_mesh->fail("\"mesh\" beside it", std::string(key) + " without a mesh");
  const Json* motion = value.find("motion");
  if (motion == nullptr) return;
  if (!collider.is_person()) motion->fail("a mannequin or a mesh beside it", "a motion without a body that can move");
  if (!mesh || collider.motion->name.empty()) return;
  const auto names = motion_names_without_skeleton();
  if (std::find(names.begin(), names.end(), collider.motion->name) != names.end()) return;
  (motion->is_object() ? motion->at("name") : *motion)
      .fail(std::string(motions_for_a_mesh), '"' + collider.motion->name + '"');
}

}  // namespace toile::internal
