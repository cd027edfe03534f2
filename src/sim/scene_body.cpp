// sim/scene_body.cpp: what the keys of a body and of solids ask of each other.
#include "body/motion.hpp"
#include "sim/scene_settle.hpp"

#include <algorithm>

namespace toile::internal {

void settle(const Json& value, SceneMotion& motion) {
  motion.where = value.where();
  motion.pointer = value.pointer();
  if (motion.path.empty() && value.is_object())
    if (const Json* fps = value.find("fps")) fps->fail("\"file\" beside it", "frames per second without a file");
}

void settle(const Json& value, SceneBody& body) {
  const bool mannequin = body.kind == SceneBody::Kind::mannequin, mesh = body.kind == SceneBody::Kind::mesh;
  if (const Json* unit = value.find("unit"); unit != nullptr && !mesh)
    unit->fail("\"mesh\" beside it", "a unit without a mesh");
  if (const Json* measured = value.find("measurements"); measured != nullptr && !mesh)
    measured->fail("\"mesh\" beside it", "measurements without a mesh");
  const Json* motion = value.find("motion");
  if (motion == nullptr) return;
  if (!mannequin && !mesh) motion->fail("a mannequin or a mesh beside it", "a motion without a body that can move");
  if (!mesh || body.motion->name.empty()) return;
  const auto names = motion_names_without_skeleton();
  if (std::find(names.begin(), names.end(), body.motion->name) != names.end()) return;
  (motion->is_object() ? motion->at("name") : *motion)
      .fail(std::string(what_moves_a_mesh), '"' + body.motion->name + '"');
}

void settle(const Json& value, SceneSolid& solid) {
  solid.where = value.where();
  solid.pointer = value.pointer();
  solid.moves.centre() = solid.translation_m;
  if (const Json* moves = value.find("moves")) check_ascending(*moves, solid.moves.keys());
}

}  // namespace toile::internal
