// sim/settings_body.hpp: the keys of the body, its motion, and of solids beside it.                sim/settings.hpp
#pragma once
#include "body/body_motion.hpp"
#include "body/motion.hpp"
#include "sim/body_figure.hpp"
#include "sim/settings_cloth.hpp"

#include <algorithm>
#include <vector>

namespace toile::internal {

// A string is a motion's name, unless it looks like a file; for a mesh, any other string is a file.
inline Shorthand motion_by_name(bool mannequin) {
  return [mannequin](const std::string& text) -> std::string_view {
    const auto names = motion_names();
    const bool from_file = is_point_cache(text) || moves_a_skeleton(text) || text.find('/') != std::string::npos ||
                           (!mannequin && std::find(names.begin(), names.end(), text) == names.end());
    return from_file ? "file" : "name";
  };
}

template <class V>
void describe(V& v, SceneMotion& motion) {
  v.exactly_one({"name", "file"});
  v.text_among({"name",
                "of a mannequin any of them, of a mesh one that needs no skeleton: stand, sway, twist "
                "([motions.md](motions.md))",
                "a file"},
               motion_names(), motion.name);
  v.path({"file",
          "a .pc2 or .mdd file, a folder of numbered mesh files; of a body with a skeleton a glTF file, the body's own "
          "or one with "
          "nodes of the same names, or a BVH file; of a mannequin a BVH file too "
          "([motions.md](motions.md#bodies-with-a-skeleton))",
          "a name"},
         motion.path);
  v.text({"clip", "of a glTF file: the name of an animation, or its number from 0", "the only one"}, motion.clip);
  v.path({"bones", "of a BVH file: which joints are which part of a person ([motions.md](motions.md#bvh))",
          "what their names say"},
         motion.bones);
  v.number({"fps", "of the file, or so many poses a second of an animation; BVH has its own"}, {1, most_fps},
           motion.fps);
  v.number({"lead_in_s", "from the pose in which the body stands into the motion"}, {0, 10}, motion.lead_in_s);
}

// The shape: the keys of all kinds exclude each other.
template <class V>
void describe_shape(V& v, SceneCollider& collider) {
  const std::vector<std::string_view> keys = keys_of_kinds<ColliderShape>();
  if (collider.worn)
    v.at_most_one(keys);
  else
    v.exactly_one(keys);
  for_each_kind<ColliderShape>([&]<class Kind>(const Kind&) {
    v.alternative(
        Kind::key, collider.as<Kind>() != nullptr, [&] { collider.shape = Kind{}; },
        [&](auto& of) { describe_choice(of, std::get<Kind>(collider.shape), collider.worn); });
  });
  for_each_kind<ColliderShape>([&]<class Kind>(Kind not_chosen) {
    if constexpr (requires { describe_beside(v, not_chosen, true); }) {
      Kind* const chosen = std::get_if<Kind>(&collider.shape);
      describe_beside(v, chosen != nullptr ? *chosen : not_chosen, collider.worn);
    }
  });
}

template <class V>
void describe(V& v, SceneCollider& collider) {
  describe_shape(v, collider);
  v.object({"motion",
            collider.worn ? "a name, a file, or an object. The cloth drapes on the first pose, then the body moves"
                          : "of a mannequin or a mesh, as a body's",
            "none"},
           collider.motion, motion_by_name(collider.as<SceneMannequin>() != nullptr));
  v.number({"edge_m", "edge length of curved shapes"}, {5e-4, 10}, collider.edge_m);
  if (!collider.worn) {
    v.flag({"inside_out", "a room"}, collider.inside_out);
    PlacementSettings placement{collider.translation_m, collider.rotation_deg};
    v.object({"placement", "where it stands", "around the origin"}, placement);
    v.list({"moves", "how it moves, about its `translation_m`: [below](#moves)", "it stands still"},
           collider.moves.keys(), 1);
  }
  v.number(
      {"friction",
       collider.worn ? "of the cloth on the body, and on solids that have none of their own" : "of the cloth on it",
       collider.worn ? "the fabric's" : "the body's"},
      {0, 100}, collider.contact.friction);
  v.rows({"friction_path", "in time, instead of the constant", "constant"}, Rows{1, true}, collider.friction_path,
         [](auto& row, FrictionKey& key) {
           row.column("t_s", within_a_run, key.t_s);
           row.column("friction", Range{0, 100}, key.friction);
         });
  v.number(
      {"offset_mm", "how far above it cloth rests; edges cut corners of it, so longer ones need more",
       collider.worn
           ? "between 1.5 and 2.5: of a mannequin or a mesh 1.5 for edges up to 2 cm, of a shape 0.2 of the edge length"
           : "the body's, where the scene gives one; else of a mannequin as of a body, of all others 0.2 of the edge "
             "length"},
      {0.1, 100, 1e-3}, collider.contact.offset_m);
}

}  // namespace toile::internal
