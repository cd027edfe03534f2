// sim/scene_body.cpp: reads the body of a scene.
#include "sim/scene_reading.hpp"

#include "body/motion.hpp"

#include <array>
#include <string>
#include <utility>

namespace toile::scene_reading {
namespace {

// A name of the mannequin's own, or a file; {"file", "fps", "blend_in_s"} says more about the file.
SceneMotion read_motion(const Json& value, bool mannequin, const std::string& file) {
  SceneMotion motion;
  motion.where = value.where();
  motion.pointer = value.pointer();
  const Json* path = &value;
  if (value.is_object()) {
    value.allow_only({"name", "file", "fps", "lead_in_s"});
    read_number(value, "lead_in_s", motion.lead_in_s, 1, 0, 10);
    if (const Json* name = value.find("name")) {
      if (!mannequin) name->fail("a mannequin, or \"file\" for a mesh", "the name of a motion");
      if (value.find("file") != nullptr) name->fail("either \"name\" or \"file\"", "both");
      motion.name = motion_names()[one_of(*name, motion_names())];
      return motion;
    }
    path = &value.at("file");
    read_number(value, "fps", motion.fps, 1, 1, most_fps);
  } else if (mannequin) {
    const std::string& name = value.string();
    const bool from_file = name.ends_with(".pc2") || name.find('/') != std::string::npos;
    if (!from_file) {
      motion.name = motion_names()[one_of(value, motion_names())];
      return motion;
    }
  }
  motion.path = resolve(file, *path);
  return motion;
}

}  // namespace

SceneBody read_body(const Json& value, const std::string& file) {
  SceneBody body;
  if (value.is_null()) return body;
  value.allow_only({"mannequin", "mesh", "cylinder", "unit", "motion", "friction", "offset_mm"});
  int given = 0;
  if (const Json* mannequin = value.find("mannequin")) {
    static constexpr std::array<std::string_view, 4> names = {"woman", "dancer", "man", "default"};
    const std::string_view name = names[one_of(*mannequin, names)];
    body.mannequin = name == "default" ? MannequinKind::woman : mannequin_kind(name);
    body.kind = SceneBody::Kind::mannequin;
    ++given;
  }
  if (const Json* mesh = value.find("mesh")) {
    body.mesh = resolve(file, *mesh);
    body.kind = SceneBody::Kind::mesh;
    ++given;
  }
  if (const Json* cylinder = value.find("cylinder")) {
    cylinder->allow_only({"radius_m", "height_m", "top_m"});
    read_number(*cylinder, "radius_m", body.cylinder.radius_m, 1, 0.01, 10);
    read_number(*cylinder, "height_m", body.cylinder.height_m, 1, 0.01, 10);
    if (const Json* top = cylinder->find("top_m")) body.cylinder.top_m = vector_of(*top);
    body.kind = SceneBody::Kind::cylinder;
    ++given;
  }
  if (given > 1) value.fail("one of \"mannequin\", \"mesh\", \"cylinder\"", std::to_string(given) + " of them");
  if (const Json* unit = value.find("unit")) {
    static constexpr std::array<std::string_view, 3> units = {"m", "dm", "cm"};
    body.unit = std::array{LengthUnit::m, LengthUnit::dm, LengthUnit::cm}[one_of(*unit, units)];
    if (body.kind != SceneBody::Kind::mesh) unit->fail("\"mesh\" beside it", "a unit without a mesh");
  }
  if (const Json* motion = value.find("motion")) {
    if (body.kind != SceneBody::Kind::mannequin && body.kind != SceneBody::Kind::mesh)
      motion->fail("a mannequin or a mesh beside it", "a motion without a body that can move");
    body.motion = read_motion(*motion, body.kind == SceneBody::Kind::mannequin, file);
  }
  read_number(value, "friction", body.friction, 1, 0, 100);
  read_number(value, "offset_mm", body.offset_m, 1e-3, 0.1, 100);
  return body;
}

SceneSolid read_solid(const Json& value, const std::string& file) {
  value.allow_only({"sphere", "box", "revolved", "mesh", "edge_m", "inside_out", "placement", "moves"});
  SceneSolid solid;
  solid.where = value.where();
  solid.pointer = value.pointer();
  int given = 0;
  if (const Json* sphere = value.find("sphere")) {
    sphere->allow_only({"radius_m"});
    solid.shape = SceneSolid::Sphere{number_in(sphere->at("radius_m"), 1e-3, 100)};
    ++given;
  }
  if (const Json* box = value.find("box")) {
    box->allow_only({"size_m"});
    const Json& size = box->at("size_m");
    solid.shape = SceneSolid::Box{vector_of(size)};
    for (const Json& side : size.array()) number_in(side, 1e-3, 100);
    ++given;
  }
  if (const Json* revolved = value.find("revolved")) {
    revolved->allow_only({"profile_m"});
    SceneSolid::Revolved shape;
    for (const Json& point : revolved->at("profile_m").array()) {
      if (!point.is_array() || point.array().size() != 2)
        point.fail("two numbers [distance from the axis, height]", point.describe());
      shape.profile_m.emplace_back(number_in(point.array()[0], 0, 100), number_in(point.array()[1], -100, 100));
    }
    solid.shape = std::move(shape);
    ++given;
  }
  if (const Json* mesh = value.find("mesh")) {
    solid.shape = SceneSolid::Mesh{resolve(file, *mesh)};
    ++given;
  }
  if (given != 1)
    value.fail("one of \"sphere\", \"box\", \"revolved\", \"mesh\"",
               given == 0 ? "none of them" : std::to_string(given) + " of them");
  read_number(value, "edge_m", solid.edge_m, 1, 5e-4, 10);
  solid.inside_out = value.boolean_or("inside_out", false);
  read_placement(value, solid.translation_m, solid.rotation_deg);
  if (const Json* moves = value.find("moves")) solid.moves = read_moves(*moves, solid.translation_m);
  return solid;
}

}  // namespace toile::scene_reading
