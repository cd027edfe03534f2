// sim/scene_body.cpp: checks the keys of a body and of solids against each other.
#include "body/motion.hpp"
#include "io/bvh.hpp"
#include "io/mesh_file.hpp"
#include "sim/scene_settle.hpp"

#include <algorithm>

namespace toile::internal {

void settle(const Json& value, SceneMotion& motion) {
  if (motion.path.empty() && value.is_object())
    if (const Json* fps = value.find("fps")) fps->fail("\"file\" beside it", "frames per second without a file");
  const Json* const clip = value.is_object() ? value.find("clip") : nullptr;
  if (clip != nullptr && !has_animated_ending(motion.path))
    clip->fail("a glTF \"file\" beside it", "an animation without a file of them");
  const Json* const bones = value.is_object() ? value.find("bones") : nullptr;
  if (bones != nullptr && !has_bvh_ending(motion.path)) bones->fail("a BVH \"file\" beside it", "bones without one");
}

void settle(const Json& value, SceneCollider& collider) {
  collider.moves.centre() = collider.translation_m;
  if (const Json* moves = value.find("moves")) check_ascending(*moves, collider.moves.keys());
  const bool mesh = collider.as<SceneMesh>() != nullptr;
  if (const Json* weights = value.find("weights"); weights != nullptr && value.find("rig") == nullptr)
    weights->fail("\"rig\" beside it", "skin weights without a rig");
  for (const char* key : {"unit", "measurements", "rig", "targets"})
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
