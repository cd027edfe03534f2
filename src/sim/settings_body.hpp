// sim/settings_body.hpp: the keys of the body, its motion, and of solids beside it.                sim/settings.hpp
#pragma once
#include "body/motion.hpp"
#include "sim/settings_cloth.hpp"

#include <algorithm>

namespace toile::internal {

// A string is a motion by name, unless it looks like a file; of a mesh, unless it is no motion's name.
inline Shorthand motion_by_name(bool mannequin) {
  return [mannequin](const std::string& text) -> std::string_view {
    const auto names = motion_names();
    const bool from_file = text.ends_with(".pc2") || text.find('/') != std::string::npos ||
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
  v.path({"file", "a .pc2 file, or a folder of OBJ or PLY files", "a name"}, motion.path);
  v.number({"fps", "of the file"}, {1, most_fps}, motion.fps);
  v.number({"lead_in_s", "from the pose in which the body stands into the motion"}, {0, 10}, motion.lead_in_s);
}

template <class V>
void describe(V& v, SceneCylinder& cylinder) {
  v.number({"radius_m", "its radius"}, {0.01, 10}, cylinder.radius_m);
  v.number({"height_m", "its height"}, {0.01, 10}, cylinder.height_m);
  v.vector({"top_m", "middle of its top"}, anywhere, cylinder.top_m);
}

inline constexpr std::array<std::pair<std::string_view, MannequinKind>, 4> mannequins = {
    {{"woman", MannequinKind::woman},
     {"dancer", MannequinKind::dancer},
     {"man", MannequinKind::man},
     {"default", MannequinKind::woman}}};
template <class V>
void describe(V& v, SceneBody& body) {
  using Kind = SceneBody::Kind;
  static constexpr std::array<std::pair<std::string_view, LengthUnit>, 3> units = {
      {{"m", LengthUnit::m}, {"dm", LengthUnit::dm}, {"cm", LengthUnit::cm}}};
  const auto chosen = [&](Kind kind) { return body.kind == kind; };
  v.at_most_one({"mannequin", "mesh", "cylinder"});
  v.alternative(
      "mannequin", chosen(Kind::mannequin), [&] { body.kind = Kind::mannequin; },
      [&](auto& of) {
        of.name({"mannequin", "one that is built in ([mannequin.md](mannequin.md))", "no"}, mannequins, body.mannequin);
      });
  v.alternative(
      "mesh", chosen(Kind::mesh), [&] { body.kind = Kind::mesh; },
      [&](auto& of) {
        of.path({"mesh", "a closed [mesh file](#mesh-files)", "no"}, body.mesh);
      });
  v.alternative(
      "cylinder", chosen(Kind::cylinder), [&] { body.kind = Kind::cylinder; },
      [&](auto& of) {
        of.object({"cylinder", "upright, with rounded rims", "no"}, body.cylinder);
      });
  v.name({"unit", "of the mesh", "metres, or an error that asks"}, units, body.unit);
  v.path({"measurements", "of the mesh, a YAML file: [howto/measurements.md](howto/measurements.md)",
          "the file of the mesh's name that ends in .yaml, if there is one"},
         body.measurements);
  v.object({"motion", "a name, a file, or an object. The cloth drapes on the first pose, then the body moves", "none"},
           body.motion, motion_by_name(chosen(Kind::mannequin)));
  v.number({"friction", "of the cloth on the body and on solids", "the fabric's"}, {0, 100}, body.friction);
  v.number({"offset_mm", "how far above the body cloth rests; edges cut corners of the body, so longer ones need more",
            "0.2 of the edge length, between 1.5 and 2.5"},
           {0.1, 100, 1e-3}, body.offset_m);
}

inline constexpr Range length_of_a_solid{1e-3, 100};

template <class V>
void describe(V& v, SceneSolid::Sphere& sphere) {
  v.number(Setting{"radius_m", "its radius"}.needs(), length_of_a_solid, sphere.radius_m);
}
template <class V>
void describe(V& v, SceneSolid::Box& box) {
  v.vector(Setting{"size_m", "along x, y and z"}.needs(), length_of_a_solid, box.size_m);
}
template <class V>
void describe(V& v, SceneSolid::Revolved& shape) {
  v.rows(Setting{"profile_m", "from the axis to the axis, or a closed curve beside it"}.needs(), Rows{3},
         shape.profile_m, [](auto& row, Vec2& p) {
           row.column("distance from the axis", Range{0, 100}, p.x());
           row.column("height", Range{-100, 100}, p.y());
         });
}

template <class V>
void describe(V& v, SceneSolid& solid) {
  // The key of the alternative that is `Shape`, described by `of_shape`.
  const auto alternative = [&]<class Shape>(std::type_identity<Shape>, std::string_view key, const auto& of_shape) {
    v.alternative(
        key, std::holds_alternative<Shape>(solid.shape), [&] { solid.shape = Shape{}; },
        [&](auto& of) { of_shape(of, std::get<Shape>(solid.shape)); });
  };
  v.exactly_one({"sphere", "box", "revolved", "mesh"});
  alternative(std::type_identity<SceneSolid::Sphere>{}, "sphere", [](auto& of, auto& shape) {
    of.object({"sphere", "around the origin", "no"}, shape);
  });
  alternative(std::type_identity<SceneSolid::Box>{}, "box", [](auto& of, auto& shape) {
    of.object({"box", "around the origin", "no"}, shape);
  });
  alternative(std::type_identity<SceneSolid::Revolved>{}, "revolved", [](auto& of, auto& shape) {
    of.object({"revolved", "an outline that sweeps around the y axis", "no"}, shape);
  });
  alternative(std::type_identity<SceneSolid::Mesh>{}, "mesh", [](auto& of, auto& shape) {
    of.path({"mesh", "a closed [mesh file](#mesh-files) in metres, with all its parts", "no"}, shape.path);
  });
  v.number({"edge_m", "edge length of curved shapes"}, {5e-4, 10}, solid.edge_m);
  v.flag({"inside_out", "a room"}, solid.inside_out);
  Placement placement{solid.translation_m, solid.rotation_deg};
  v.object({"placement", "where it stands", "around the origin"}, placement);
  v.list({"moves", "how it moves, about its `translation_m`: [below](#moves)", "it stands still"}, solid.moves.keys(),
         1);
}

}  // namespace toile::internal
