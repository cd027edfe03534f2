// sim/settings_cloth.hpp: the keys of a cloth, its kind, fabric, pins and hands.                  sim/settings.hpp
#pragma once
#include "sim/scene.hpp"
#include "sim/settings.hpp"

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace toile::internal {

inline constexpr Range stiffer_or_not{1e-3, 1e3};

template <class V>
void describe_times_and_place(V& row, double& t_s, Vec3& x_m) {
  row.column("t_s", within_a_run, t_s);
  row.column("x", anywhere, x_m.x());
  row.column("y", anywhere, x_m.y());
  row.column("z", anywhere, x_m.z());
}
inline constexpr auto path_row = [](auto& row, VectorKey& key) { describe_times_and_place(row, key.t_s, key.x); };

struct PlacementSettings {  // of a cloth or a solid
  Vec3 &translation_m, &rotation_deg;
};
template <>
inline constexpr std::string_view shared_name<PlacementSettings> = "placement";
template <class V>
void describe(V& v, PlacementSettings& placement) {
  v.vector({"translation_m", "where its origin goes"}, anywhere, placement.translation_m);
  v.vector({"rotation_deg", "turned first, R = Rz Ry Rx; [-90, 0, 0] lays a grid down, right side up"}, {-1e4, 1e4},
           placement.rotation_deg);
}

template <>
inline constexpr std::string_view shared_name<RigidKey> = "moves";
template <class V>
void describe(V& v, RigidKey& key) {
  constexpr std::string_view as_before = "as in the key before";
  v.number(Setting{"t_s", "when; times ascend"}.needs(), within_a_run, key.t_s);
  v.vector({"shift_m", "how far it has gone", as_before}, anywhere, key.shift_m);
  v.vector({"rotation_deg", "how far it has turned, R = Rz Ry Rx; 720 are two turns", as_before}, any_angle,
           key.rotation_deg);
  v.number({"scale", "how much it has grown", as_before}, {0.01, 100}, key.scale);
}

template <>
inline constexpr std::string_view shared_name<Fabric> = "fabric";
inline const Shorthand fabric_by_name = [](const std::string&) { return std::string_view("base"); };
template <class V>
void describe(V& v, Fabric& fabric) {
  constexpr std::string_view as_base = "the base's";
  v.fabric({"base", "the preset from which the others differ"}, fabric);
  v.number({"density_kg_per_m2", "mass per area", as_base}, {0, 1e3, 1, true}, fabric.density_kg_per_m2);
  v.number({"stretch_u_N_per_m", "stiffness of the warp", as_base}, {0, 1e9, 1, true}, fabric.stretch_u_N_per_m);
  v.number({"stretch_v_N_per_m", "stiffness of the weft", as_base}, {0, 1e9, 1, true}, fabric.stretch_v_N_per_m);
  v.number({"shear_N_per_m", "stiffness against shear", as_base}, {0, 1e9}, fabric.shear_N_per_m);
  v.number({"doubling_strain_u",
            "extension at which the warp pulls twice as hard as a straight line of its stiffness; 0: a straight line; "
            "else at least 1e-5",
            as_base},
           {0, 10}, fabric.doubling_strain_u);
  v.number({"doubling_strain_v", "of the weft", as_base}, {0, 10}, fabric.doubling_strain_v);
  v.number(
      {"compression_ratio",
       "of the stretch stiffness, in threads that are shorter than at rest; less where triangles are so large that "
       "the sheet buckles between their corners; 1: it does not",
       as_base},
      {0, 1, 1, true}, fabric.compression_ratio);
  v.number({"strain_limit", "0.05: no thread gets more than 5 % longer; 0: no limit", as_base}, {0, 1},
           fabric.strain_limit);
  v.number({"bend_u_N_m", "bending rigidity of the warp", as_base}, {0, 1e6}, fabric.bend_u_N_m);
  v.number({"bend_v_N_m", "bending rigidity of the weft", as_base}, {0, 1e6}, fabric.bend_v_N_m);
  v.number(
      {"bend_poisson", "how much cloth bent along one thread wants to bend the other way along the other", as_base},
      {0, 0.5}, fabric.bend_poisson);
  v.number(
      {"bend_uv_N_m", "rigidity against twist; 0: (1 - `bend_poisson`)/2 times the mean of the other two", as_base},
      {0, 1e6}, fabric.bend_uv_N_m);
  v.number({"bend_friction_N", "moment per width that rubbing threads hold; half of KES-F's 2HB", as_base}, {0, 1},
           fabric.bend_friction_N);
  v.number({"bend_friction_curvature_per_m", "at which it is reached", as_base}, {0, 1e4, 1, true},
           fabric.bend_friction_curvature_per_m);
  v.number({"bend_set", "share of the bending rigidity that follows a bend", as_base}, {0, 1}, fabric.bend_set);
  v.number({"bend_set_s", "over this time", as_base}, {0, 1e6, 1, true}, fabric.bend_set_s);
  v.number({"stretch_damping_s", "relaxation time of stretch", as_base}, {0, 1e3}, fabric.stretch_damping_s);
  v.number({"shear_damping_s", "relaxation time of shear", as_base}, {0, 1e3}, fabric.shear_damping_s);
  v.number({"bend_damping_s", "relaxation time of bending", as_base}, {0, 1e3}, fabric.bend_damping_s);
  v.number({"friction", "on another layer; the larger of two counts", as_base}, {0, 100}, fabric.friction);
  v.number({"thickness_m", "distance of two layers that lie on each other", as_base}, {0, 0.1, 1, true},
           fabric.thickness_m);
}

template <class V>
void describe(V& v, ScenePanel& panel) {
  constexpr std::string_view as_pattern = "the pattern's";
  constexpr Range shrunk_or_not{0.2, 5};
  v.object({"fabric", "of this panel", "the pattern's, or the cloth's"}, panel.fabric, fabric_by_name);
  v.object(
      {"interfacing", "another cloth fused to this panel: a collar, a cuff ([fabrics](theory/fabrics.md#interfacing))",
       "the pattern's, or none"},
      panel.interfacing, fabric_by_name);
  v.number({"interfacing_mm", "from the middle of the cloth to the middle of the interfacing", "the pattern's, or 0.3"},
           {0, 10}, panel.interfacing_mm);
  v.number({"rest_stretch_u",
            "of the warp, up the panel; 0.9 is an elastic that wants to be 10 % shorter, and pulls after the sewing",
            as_pattern},
           shrunk_or_not, panel.rest_stretch_u);
  v.number({"rest_stretch_v", "of the weft", as_pattern}, shrunk_or_not, panel.rest_stretch_v);
  v.rows({"rest_stretch_path", "for a cloth that shrinks during the run", "constant"}, Rows{1, true},
         panel.rest_stretch_path, [=](auto& row, RestStretchKey& key) {
           row.column("t_s", within_a_run, key.t_s);
           row.column("b_u", shrunk_or_not, key.b.x());
           row.column("b_v", shrunk_or_not, key.b.y());
         });
  v.rows({"stiffness_path",
          "shares of the fabric's stretch, shear and bend, for a cloth that stiffens or softens during the run",
          "1, 1, 1"},
         Rows{1, true}, panel.stiffness_path, [](auto& row, StiffnessKey& key) {
           row.column("t_s", within_a_run, key.t_s);
           row.column("stretch", stiffer_or_not, key.share.x());
           row.column("shear", stiffer_or_not, key.share.y());
           row.column("bend", stiffer_or_not, key.share.z());
         });
  constexpr Range of_any_pump{-most_pressure_Pa, most_pressure_Pa};
  v.at_most_one({"pressure_Pa", "pressure_path"});
  v.number({"pressure_Pa", "on it, towards its right side: of a garment outwards ([pressure](#pressure))"}, of_any_pump,
           panel.pressure_Pa);
  v.rows({"pressure_path", "in time, Pa, instead of the constant", "constant"}, Rows{1, true}, panel.pressure_path,
         [=](auto& row, PressureKey& key) {
           row.column("t_s", within_a_run, key.t_s);
           row.column("Pa", of_any_pump, key.Pa);
         });
}

template <class V>
void describe(V& v, ScenePin& pin) {
  static constexpr std::array<std::pair<std::string_view, ScenePin::Hold>, 4> holds = {
      {{"fixed", ScenePin::Hold::fixed},
       {"path", ScenePin::Hold::path},
       {"moves", ScenePin::Hold::moves},
       {"body", ScenePin::Hold::body}}};
  v.exactly_one({"near_m", "in_box_m"});
  v.vector({"near_m", "holds the particle nearest to it at the start", "nothing"}, anywhere, pin.near_m);
  v.box({"in_box_m", "holds all between two corners of a box at the start", "nothing"}, anywhere, pin.in_box_m);
  v.name({"hold",
          "\"path\" has `path_m`; \"moves\" have `moves`, and take what they hold along; \"body\" is carried by the "
          "nearest "
          "point of the body or a solid, and turns with it"},
         holds, pin.hold);
  v.rows({"path_m", "where the particle is led, from the first frame on", "nowhere"}, Rows{1, true}, pin.path,
         path_row);
  v.list({"moves", "of all that it holds, [below](#moves)", "nowhere"}, pin.moves.keys(), 1);
  v.vector({"about_m", "centre of `moves`"}, anywhere, pin.moves.centre());
  v.number({"from_s", "when it takes hold"}, within_a_run, pin.from_s);
  v.number({"to_s", "when it lets go", "never"}, within_a_run, pin.to_s);
}

template <class V>
void describe(V& v, SceneDrag& drag) {
  v.vector(Setting{"near_m", "pulls the particle nearest to it"}.needs(), anywhere, drag.near_m);
  v.rows(Setting{"path_m", "of the hand; times count from the first frame"}.needs(), Rows{1, true}, drag.path,
         path_row);
  v.number({"stiffness_N_per_m", "of the spring in between"}, {0, 1e6, 1, true}, drag.stiffness_N_per_m);
  v.number({"damping_N_s_per_m", "of the spring"}, {0, 1e6}, drag.damping_N_s_per_m);
  v.number({"max_force_N", "of the spring, as a step begins"}, {0, 1e6, 1, true}, drag.max_force_N);
  v.number({"from_s", "when it takes hold", "the path's first time"}, within_a_run, drag.from_s);
  v.number({"to_s", "when it lets go", "the path's last time"}, within_a_run, drag.to_s);
}

// The kind: the keys of all kinds exclude each other.
template <class V>
void describe_kind(V& v, SceneCloth& cloth) {
  v.exactly_one(keys_of_kinds<ClothKind>());
  for_each_kind<ClothKind>([&]<class Kind>(const Kind&) {
    std::optional<Kind> chosen;
    if (const Kind* kind = cloth.as<Kind>()) chosen = *kind;
    describe_choice(v, chosen);
    if (chosen) cloth.kind = std::move(*chosen);
  });
  v.number({"resolution_cm", "edge length of a pattern's triangles"}, {0.1, 20, 0.01}, cloth.resolution_m);
  for_each_kind<ClothKind>([&]<class Kind>(Kind not_chosen) {
    if constexpr (requires { describe_beside(v, not_chosen); }) {
      Kind* const chosen = std::get_if<Kind>(&cloth.kind);
      describe_beside(v, chosen != nullptr ? *chosen : not_chosen);
    }
  });
}

// "sheet", "tube", "ribbon": the usual names that do not depend on a file.
inline std::string usual_names() {
  std::string names;
  for_each_kind<ClothKind>([&](const auto& kind) {
    if constexpr (requires { usual_name(kind); })
      if (const std::string name(usual_name(kind)); !name.empty())
        names += (names.empty() ? "\"" : ", \"") + name + '"';
  });
  return names;
}

template <class V>
void describe(V& v, SceneCloth& cloth) {
  static const std::string otherwise = "the pattern's, the file's, or " + usual_names();
  v.text({"name", "of the cloth; where there are several, their panels are named after them", otherwise}, cloth.name);
  describe_kind(v, cloth);
  v.object({"fabric", "a name, or an object with what differs from it", "cotton"}, cloth.fabric, fabric_by_name);
  v.table(
      {"panels", "what some panels have of their own, by their names ([extension](pattern-format.md#the-extension))",
       "the pattern's"},
      cloth.panels, &ScenePanel::name);
  PlacementSettings placement{cloth.translation_m, cloth.rotation_deg};
  v.object({"placement", "where the drawing goes", "as drawn"}, placement);
  v.heights({"label_heights_m",
             "y at which edges with a label are held up, from the end of the sewing until half a second after the weld",
             "the waist for `lower_interface`: where the body is narrowest"},
            {-10, 10}, cloth.label_heights);
  v.list({"drags", "hands that pull", "none"}, cloth.drags);
  v.list({"pins", "what is held; of a pattern from when everything is on, and by where the cloth is then", "none"},
         cloth.pins);
}

}  // namespace toile::internal
