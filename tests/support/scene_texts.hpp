// tests/support/scene_texts.hpp: scenes that together use every setting, and JSON texts with one value replaced.
#pragma once
#include "io/json.hpp"
#include "io/json_text.hpp"

#include <array>
#include <functional>
#include <string>
#include <string_view>

namespace toile::internal::test {

// No value is its key's default.
inline constexpr std::array<std::string_view, 11> scenes_with_every_setting = {
    R"({
  "name": "sheet",
  "cloth": [{
    "name": "flag",
    "grid": {"width_m": 0.5, "height_m": 0.4, "edge_m": 0.05},
    "fabric": {"base": "silk", "density_kg_per_m2": 0.08, "stretch_u_N_per_m": 1000, "stretch_v_N_per_m": 900,
      "shear_N_per_m": 50, "doubling_strain_u": 0.04, "doubling_strain_v": 0.05, "compression_ratio": 0.2, "strain_limit": 0.05, "bend_u_N_m": 2e-6, "bend_v_N_m": 3e-6, "bend_poisson": 0.2, "bend_uv_N_m": 1e-6, "bend_friction_N": 1e-4, "bend_friction_curvature_per_m": 30, "bend_set": 0.2, "bend_set_s": 90,
      "stretch_damping_s": 1e-3, "shear_damping_s": 2e-3, "bend_damping_s": 3e-3, "friction": 0.3, "thickness_m": 3e-3},
    "placement": {"translation_m": [0.1, 0.2, 0.3], "rotation_deg": [-90, 10, 20]},
    "drags": [{"near_m": [0, 0.1, 0], "path_m": [[0.1, 0, 0.1, 0], [2, 0, 0.5, 0.25]], "stiffness_N_per_m": 40,
      "damping_N_s_per_m": 0.25, "max_force_N": 4, "from_s": 0.5, "to_s": 1.5}],
    "pins": [
      {"near_m": [0.25, 0.2, 0], "hold": "path", "path_m": [[0.5, 0.2, 0.2, 0], [3, 0.4, 0.2, 0.1]], "from_s": 0.25, "to_s": 5},
      {"in_box_m": [[-0.3, -0.3, -0.01], [-0.2, -0.1, 0.01]], "hold": "moves", "about_m": [0.5, 0.25, 0.125],
       "moves": [{"t_s": 1, "shift_m": [0.1, 0.2, 0.3], "rotation_deg": [30, 40, 50], "scale": 0.9}, {"t_s": 2, "scale": 1.1}]}]
  }],
  "body": {"cylinder": {"radius_m": 0.3, "height_m": 0.7, "top_m": [0.1, 0.5, 0.2]}, "friction": 0.25, "offset_mm": 3, "friction_path": [[0.5, 0.25], [3, 0.75]]},
  "solids": [
    {"sphere": {"radius_m": 0.4}, "edge_m": 0.05, "inside_out": true,
     "placement": {"translation_m": [1, 2, 3], "rotation_deg": [4, 5, 6]}, "moves": [{"t_s": 0.5}, {"t_s": 3, "scale": 0.5}]},
    {"box": {"size_m": [0.5, 0.25, 0.75]}, "friction": 0.6, "offset_mm": 4, "friction_path": [[0.25, 0.1], [2, 0.3]]},
    {"revolved": {"profile_m": [[0, 0], [0.5, 0.1], [0, 1]]}},
    {"mesh": "solid.obj", "unit": "dm", "up": "z"},
    {"mannequin": "woman", "motion": {"name": "sway", "lead_in_s": 0.25}},
    {"mesh": "other.obj", "motion": {"file": "other.pc2", "fps": 12}},
    {"mesh": "fox.glb", "motion": {"file": "fox.glb", "clip": "Run"}},
    {"mannequin": "man", "motion": {"file": "walk.bvh", "bones": "bones.json"}},
    {"cylinder": {"radius_m": 0.3, "height_m": 0.7, "top_m": [0.1, 0.5, 0.2]}}],
  "world": {"gravity_m_per_s2": [0.1, -9, 0.2], "wind_m_per_s": [1, 0.5, 2], "air_density_kg_per_m3": 1.1},
  "time": {"fps": 25, "seconds": 2, "drape_seconds": 3, "step_max_ms": 10, "integrator": "bdf2", "until_still": true},
  "solver": {"preconditioner": "diagonal", "tolerance": 0.02, "procedure": "paper_1998", "newton_iterations": 2,
    "relinearisations": 3, "bend_element": "hinge", "paper_scaling": true, "damping_jacobian": "paper"},
  "contact": {"thickness_mm": 2, "friction": 0.2, "friction_between": [["silk", "cotton", 0.5], ["wool", "wool", 0.7]],
    "self_contact": false, "flypaper": false, "strict_start": true},
  "start": "a/run",
  "output": {"dir": "out/x", "preview": true, "picture_frames": [3, 5]}
})",
    R"({
  "cloth": [{"tube": {"radius_m": 0.3, "length_m": 0.8, "edge_m": 0.04}},
            {"ribbon": {"width_m": 0.2, "edge_m": 0.03, "path_m": [[0, 0, 0], [1, 0.1, 0], [1, 1, 0.2]], "closed": true, "across": [0, 0.5, 2]}}],
  "body": {"sphere": {"radius_m": 0.3}, "edge_m": 0.04}
})",
    R"({
  "cloth": [{"grid": {}}],
  "body": {"box": {"size_m": [0.5, 0.25, 0.75]}}
})",
    R"({
  "cloth": [{"grid": {}}],
  "body": {"revolved": {"profile_m": [[0, 0], [0.5, 0.1], [0, 1]]}},
  "solids": [{"capsule": {"radius_m": 0.05, "from_m": [0.2, 0.4, 0], "to_m": [0.5, 0.25, 0.75]}}]
})",
    R"({
  "cloth": [{"grid": {}}],
  "body": {"capsule": {"radius_m": 0.05, "from_m": [0.2, 0.4, 0], "to_m": [0.5, 0.25, 0.75]}}
})",
    R"({
  "cloth": [{"pattern": "p.json", "resolution_cm": 1.5, "fabric": "wool", "label_heights_m": {"waist": 1.1, "hem": 0.5},
    "panels": {"front": {"fabric": {"base": "knit", "friction": 0.6}, "interfacing": {"base": "cotton"}, "interfacing_mm": 0.4, "rest_stretch_u": 0.9, "rest_stretch_v": 1.1,
      "rest_stretch_path": [[0.5, 0.9, 0.8], [1, 0.7, 0.6]], "stiffness_path": [[0.25, 1, 2, 3], [1, 4, 5, 6]],
      "pressure_Pa": 250}, "back": {"pressure_path": [[0.5, 0], [2, -120]]}}}],
  "body": {"mannequin": "man", "motion": {"name": "walk", "lead_in_s": 0.5}}
})",
    R"({
  "cloth": [{"pattern": "p.json", "vertices": 500, "hem_mm": 20, "tape_mm": 8, "allowance_mm": 12, "topstitched": true}],
  "body": {"mesh": "body.obj", "unit": "cm", "up": "y", "measurements": "body.yaml", "motion": {"file": "motion.pc2", "fps": 24, "lead_in_s": 2}}
})",
    R"({
  "cloth": [{"pattern": "p.json"}],
  "body": {"mesh": "body.obj", "rig": "rig.a.json", "weights": "b.json", "targets": [{"file": "tall.target", "share": 0.5}],
    "motion": {"file": "walk.bvh", "bones": "bones.json"}}
})",
    R"({
  "cloth": [{"pattern": "p.json"}],
  "body": {"mesh": "fox.glb", "motion": {"file": "fox.glb", "clip": "Run"}}
})",
    R"({
  "cloth": [{"mesh": "cloth.obj", "mesh_unit": "cm", "rest_shape": "start"}],
  "world": {"gravity_path": [[0.5, 0, -9, 0], [2, 1, -8, 2]], "wind_path": [[0.25, 1, 2, 3], [3, 4, 5, 6]]}
})",
    R"({
  "cloth": [{"pattern": "p.json"}, {"pattern": "q.json", "name": "coat"}],
  "body": null
})"};

// `json` as text, with the value at `pointer` replaced by `other`; if that is empty, the value is left out.
inline void write_with(const Json& json, std::string_view pointer, std::string_view other, const std::string& here,
                       JsonText& text) {
  if (here == pointer) return text.raw(other);
  switch (json.type()) {
    case Json::Type::null:
      return text.null();
    case Json::Type::boolean:
      return text.value(json.boolean());
    case Json::Type::number:
      return text.value(json.number());
    case Json::Type::string:
      return text.value(json.string());
    case Json::Type::array: {
      text.begin_array();
      for (std::size_t k = 0; k < json.array().size(); ++k) {
        const std::string there = here + '/' + std::to_string(k);
        if (there != pointer || !other.empty()) write_with(json.array()[k], pointer, other, there, text);
      }
      return text.end_array();
    }
    case Json::Type::object:
      text.begin_object();
      for (const auto& [key, value] : json.object()) {
        const std::string there = here + '/' + key;
        if (there == pointer && other.empty()) continue;
        text.key(key);
        write_with(value, pointer, other, there, text);
      }
      return text.end_object();
  }
}
inline std::string with(const Json& json, std::string_view pointer, std::string_view other) {
  JsonText text(1);
  write_with(json, pointer, other, "", text);
  return text.str();
}

}  // namespace toile::internal::test
