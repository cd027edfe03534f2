// sim/scene.cpp: reads a scene.  One function per object of the file, in the order of docs/scenes.md.
#include "sim/scene.hpp"

#include "body/motion.hpp"
#include "io/file.hpp"

#include <fmt/printf.h>

#include <array>
#include <cmath>
#include <filesystem>

namespace toile {
namespace {

constexpr double most_seconds = 3600, most_fps = 1000;

// A number in low <= x <= high (or low < x when `open`), in words that name the range.
double number_in(const Json& value, double low, double high, bool open = false) {
  const double x = value.number();
  if (x > high || x < low || (open && x == low))
    value.fail(fmt::sprintf("a number %s %g and at most %g", open ? "above" : "of at least", low, high),
               value.describe());
  return x;
}

template <class T>
void read_number(const Json& object, std::string_view key, T& to, double scale, double low, double high,
                 bool open = false) {
  if (const Json* value = object.find(key)) to = scale * number_in(*value, low, high, open);
}

Vec3 vector_of(const Json& value, double most = 1e4) {
  if (!value.is_array() || value.array().size() != 3) value.fail("three numbers [x, y, z]", value.describe());
  Vec3 v;
  for (std::size_t k = 0; k < 3; ++k) v[static_cast<Eigen::Index>(k)] = number_in(value.array()[k], -most, most);
  return v;
}

// The place of `name` among `names`; an error that names the nearest otherwise.
std::size_t one_of(const Json& value, std::span<const std::string_view> names) {
  const std::string& name = value.string();
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return i;
    list += (i == 0 ? "\"" : ", \"") + std::string(names[i]) + '"';
  }
  value.fail("one of " + list + "; nearest is \"" + std::string(nearest_name(name, names.data(), names.size())) + '"',
             value.describe());
}

std::string resolve(const std::string& scene_file, const Json& value) {
  const std::string& path = value.string();
  if (path.empty() || path.find('\0') != std::string::npos) value.fail("a path", value.describe());
  const std::filesystem::path given(path);
  if (given.is_absolute()) return given.lexically_normal().string();
  return (std::filesystem::path(scene_file).parent_path() / given).lexically_normal().string();
}

Fabric read_fabric(const Json& value) {
  if (value.is_string()) return fabric_preset(value.string(), value.where(), value.pointer());
  if (!value.is_object())
    value.fail("the name of a fabric, or an object with \"base\" and what differs from it", value.describe());
  value.allow_only({"base", "density_kg_per_m2", "stretch_u_N_per_m", "stretch_v_N_per_m", "shear_N_per_m",
                    "compression_ratio", "bend_u_N_m", "bend_v_N_m", "stretch_damping_s", "shear_damping_s",
                    "bend_damping_s", "friction", "thickness_m"});
  Fabric fabric;
  if (const Json* base = value.find("base")) fabric = fabric_preset(base->string(), base->where(), base->pointer());
  struct Member {
    std::string_view key;
    double Fabric::*member;
    double most;
  };
  static constexpr std::array<Member, 12> members = {{{"compression_ratio", &Fabric::compression_ratio, 1},
                                                      {"density_kg_per_m2", &Fabric::density_kg_per_m2, 1e3},
                                                      {"stretch_u_N_per_m", &Fabric::stretch_u_N_per_m, 1e9},
                                                      {"stretch_v_N_per_m", &Fabric::stretch_v_N_per_m, 1e9},
                                                      {"shear_N_per_m", &Fabric::shear_N_per_m, 1e9},
                                                      {"bend_u_N_m", &Fabric::bend_u_N_m, 1e6},
                                                      {"bend_v_N_m", &Fabric::bend_v_N_m, 1e6},
                                                      {"stretch_damping_s", &Fabric::stretch_damping_s, 1e3},
                                                      {"shear_damping_s", &Fabric::shear_damping_s, 1e3},
                                                      {"bend_damping_s", &Fabric::bend_damping_s, 1e3},
                                                      {"friction", &Fabric::friction, 100},
                                                      {"thickness_m", &Fabric::thickness_m, 0.1}}};
  for (const Member& m : members) {
    const Json* number = value.find(m.key);
    if (number == nullptr) continue;
    fabric.*m.member = number->number();
    check_fabric(fabric, number->where(), value.pointer());  // one at a time, so that the line is the value's own
    number_in(*number, 0, m.most);
  }
  return fabric;
}

// [fabric, fabric, friction]
PairFriction read_pair_friction(const Json& value) {
  if (!value.is_array() || value.array().size() != 3)
    value.fail("two names of fabrics and a number, [\"silk\", \"cotton\", 0.2]", value.describe());
  const auto name = [&](std::size_t k) {
    const Json& given = value.array()[k];
    return fabric_preset(given.string(), given.where(), given.pointer()).name;
  };
  return {name(0), name(1), number_in(value.array()[2], 0, 100)};
}

// [[t_s, x, y, z], ...], ascending.
std::vector<ScenePin::Key> read_path(const Json& path) {
  std::vector<ScenePin::Key> keys;
  for (const Json& key : path.array()) {
    if (!key.is_array() || key.array().size() != 4) key.fail("four numbers [t_s, x, y, z]", key.describe());
    ScenePin::Key at{number_in(key.array()[0], 0, most_seconds), {}};
    for (std::size_t k = 0; k < 3; ++k) at.x_m[static_cast<Eigen::Index>(k)] = number_in(key.array()[k + 1], -1e4, 1e4);
    if (!keys.empty() && !(at.t_s > keys.back().t_s)) key.fail("times that ascend", "a time not after the one before");
    keys.push_back(at);
  }
  if (keys.empty()) path.fail("at least one [t_s, x, y, z]", "an empty array");
  return keys;
}

SceneDrag read_drag(const Json& value) {
  value.allow_only({"near_m", "path_m", "stiffness_N_per_m", "damping_N_s_per_m", "max_force_N", "from_s", "to_s"});
  SceneDrag drag;
  drag.near_m = vector_of(value.at("near_m"));
  drag.path = read_path(value.at("path_m"));
  drag.from_s = drag.path.front().t_s;
  drag.to_s = drag.path.back().t_s;
  read_number(value, "stiffness_N_per_m", drag.stiffness_N_per_m, 1, 0, 1e6, true);
  read_number(value, "damping_N_s_per_m", drag.damping_N_s_per_m, 1, 0, 1e6);
  read_number(value, "max_force_N", drag.max_force_N, 1, 0, 1e6, true);
  read_number(value, "from_s", drag.from_s, 1, 0, most_seconds);
  read_number(value, "to_s", drag.to_s, 1, 0, most_seconds);
  if (!(drag.to_s > drag.from_s)) value.fail("a drag that ends after it begins", "to_s not after from_s");
  return drag;
}

// [[t_s, b_u, b_v], ...], ascending.
std::vector<RestStretchKey> read_rest_stretch_path(const Json& path) {
  std::vector<RestStretchKey> keys;
  for (const Json& key : path.array()) {
    if (!key.is_array() || key.array().size() != 3) key.fail("three numbers [t_s, b_u, b_v]", key.describe());
    const RestStretchKey at{number_in(key.array()[0], 0, most_seconds),
                            Vec2(number_in(key.array()[1], 0.2, 5), number_in(key.array()[2], 0.2, 5))};
    if (!keys.empty() && !(at.t_s > keys.back().t_s)) key.fail("times that ascend", "a time not after the one before");
    keys.push_back(at);
  }
  if (keys.empty()) path.fail("at least one [t_s, b_u, b_v]", "an empty array");
  return keys;
}

ScenePin read_pin(const Json& value) {
  value.allow_only({"near_m", "hold", "path_m"});
  ScenePin pin;
  pin.where = value.where();
  pin.pointer = value.pointer();
  pin.near_m = vector_of(value.at("near_m"));
  static constexpr std::array<std::string_view, 2> holds = {"fixed", "path"};
  if (const Json* hold = value.find("hold")) pin.on_path = one_of(*hold, holds) == 1;
  const Json* path = value.find("path_m");
  if (!pin.on_path) {
    if (path != nullptr) path->fail("\"hold\": \"path\" beside it", "a path for a fixed pin");
    return pin;
  }
  if (path == nullptr) value.fail("\"path_m\": [[t_s, x, y, z], ...]", "hold \"path\" without a path");
  pin.path = read_path(*path);
  return pin;
}

SceneCloth read_cloth(const Json& value, const std::string& file) {
  value.allow_only({"name", "pattern", "grid", "resolution_cm", "vertices", "fabric", "panels", "placement", "pins",
                    "drags", "label_heights_m"});
  SceneCloth cloth;
  cloth.name = value.string_or("name", "");
  const Json *pattern = value.find("pattern"), *grid = value.find("grid");
  if ((pattern == nullptr) == (grid == nullptr))
    value.fail("either \"pattern\" or \"grid\"", pattern == nullptr ? "none of them" : "both");
  if (pattern != nullptr) {
    cloth.pattern = resolve(file, *pattern);
  } else {
    grid->allow_only({"width_m", "height_m", "edge_m"});
    SceneGrid g;
    read_number(*grid, "width_m", g.width_m, 1, 1e-3, 10);
    read_number(*grid, "height_m", g.height_m, 1, 1e-3, 10);
    read_number(*grid, "edge_m", g.edge_m, 1, 5e-4, 1);
    const double triangles = 4 * g.width_m * g.height_m / (g.edge_m * g.edge_m * std::sqrt(3.0));
    if (triangles > 2e6) grid->fail("at most 2 million triangles", std::to_string(triangles) + " from this edge_m");
    cloth.grid = g;
    if (cloth.name.empty()) cloth.name = "sheet";
  }
  read_number(value, "resolution_cm", cloth.resolution_m, 0.01, 0.1, 20);
  if (const Json* vertices = value.find("vertices")) {
    if (pattern == nullptr) vertices->fail("a pattern beside it: a grid has an edge_m", "a number of vertices");
    if (const Json* both = value.find("resolution_cm")) both->fail("either \"resolution_cm\" or \"vertices\"", "both");
    cloth.vertices = static_cast<int>(number_in(*vertices, 20, 2e6));
  }
  if (const Json* fabric = value.find("fabric")) cloth.fabric = read_fabric(*fabric);
  if (const Json* panels = value.find("panels")) {
    for (const auto& [name, panel] : panels->object()) {
      panel.allow_only({"fabric", "rest_stretch_u", "rest_stretch_v", "rest_stretch_path"});
      ScenePanel p;
      p.name = name;
      p.where = panel.where();
      p.pointer = panel.pointer();
      if (const Json* fabric = panel.find("fabric")) p.fabric = read_fabric(*fabric);
      if (const Json* path = panel.find("rest_stretch_path")) p.rest_stretch_path = read_rest_stretch_path(*path);
      read_number(panel, "rest_stretch_u", p.rest_stretch_u, 1, 0.2, 5);
      read_number(panel, "rest_stretch_v", p.rest_stretch_v, 1, 0.2, 5);
      cloth.panels.push_back(std::move(p));
    }
  }
  if (const Json* placement = value.find("placement")) {
    placement->allow_only({"translation_m", "rotation_deg"});
    if (const Json* t = placement->find("translation_m")) cloth.translation_m = vector_of(*t);
    if (const Json* r = placement->find("rotation_deg")) cloth.rotation_deg = vector_of(*r);
  }
  if (const Json* heights = value.find("label_heights_m")) {
    for (const auto& [label, height] : heights->object())
      cloth.label_heights.push_back({label, number_in(height, -10, 10)});
  }
  if (const Json* drags = value.find("drags"))
    for (const Json& drag : drags->array()) cloth.drags.push_back(read_drag(drag));
  if (const Json* pins = value.find("pins")) {
    for (const Json& pin : pins->array()) cloth.pins.push_back(read_pin(pin));
    if (!cloth.pattern.empty() && !cloth.pins.empty())
      pins->fail("no pins on a garment that is sewn: not available yet", pins->describe());
  }
  return cloth;
}

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

void read_world(const Json& value, Scene& scene) {
  value.allow_only({"gravity_m_per_s2", "wind_m_per_s", "air_density_kg_per_m3"});
  if (const Json* gravity = value.find("gravity_m_per_s2")) scene.gravity_m_per_s2 = vector_of(*gravity, 1000);
  if (const Json* wind = value.find("wind_m_per_s")) scene.air.wind_m_per_s = vector_of(*wind, 100);
  read_number(value, "air_density_kg_per_m3", scene.air.density_kg_per_m3, 1, 0, 1e3);
}

void read_time(const Json& value, Scene& scene) {
  value.allow_only({"fps", "seconds", "drape_seconds", "step_max_ms", "integrator", "until_still"});
  read_number(value, "fps", scene.fps, 1, 1, most_fps);
  read_number(value, "seconds", scene.seconds, 1, 0, most_seconds, true);
  scene.seconds_given = value.find("seconds") != nullptr;
  read_number(value, "drape_seconds", scene.drape_seconds, 1, 0, most_seconds);
  read_number(value, "step_max_ms", scene.step_max_s, 1e-3, 0.01, 1000);
  scene.until_still = value.boolean_or("until_still", scene.until_still);
  static constexpr std::array<std::string_view, 2> integrators = {"backward_euler", "bdf2"};
  if (const Json* integrator = value.find("integrator"))
    scene.integrator = one_of(*integrator, integrators) == 0 ? Integrator::backward_euler : Integrator::bdf2;
}

void read_solver(const Json& value, Scene& scene) {
  value.allow_only({"preconditioner", "tolerance", "procedure", "newton_iterations", "relinearisations",
                    "paper_scaling", "damping_jacobian"});
  static constexpr std::array<std::string_view, 2> procedures = {"prefiltered", "paper_1998"};
  if (const Json* procedure = value.find("procedure"))
    scene.procedure = one_of(*procedure, procedures) == 0 ? PcgProcedure::prefiltered : PcgProcedure::paper_1998;
  if (const Json* iterations = value.find("newton_iterations")) {
    const double count = number_in(*iterations, 1, 3);
    if (count != std::floor(count)) iterations->fail("1, 2 or 3", iterations->describe());
    scene.newton_iterations = static_cast<int>(count);
  }
  if (const Json* relinearisations = value.find("relinearisations")) {
    const double count = number_in(*relinearisations, 0, 10);
    if (count != std::floor(count)) relinearisations->fail("a whole number from 0 to 10", relinearisations->describe());
    scene.relinearisations = static_cast<int>(count);
  }
  if (const Json* name = value.find("preconditioner")) {
    static constexpr std::array all = {Preconditioner::diagonal, Preconditioner::block_jacobi,
                                       Preconditioner::block_ssor, Preconditioner::block_ssor_coarse};
    const std::array<std::string_view, 5> names = {"auto", to_string(all[0]), to_string(all[1]), to_string(all[2]),
                                                   to_string(all[3])};
    if (const std::size_t k = one_of(*name, names); k > 0) scene.preconditioner = all[k - 1];
  }
  read_number(value, "tolerance", scene.tolerance, 1, 1e-12, 0.5);
  scene.paper_scaling = value.boolean_or("paper_scaling", false);
  if (const Json* jacobian = value.find("damping_jacobian")) {
    static constexpr std::array<std::string_view, 2> names = {"gauss_newton", "paper"};
    scene.damping_jacobian = one_of(*jacobian, names) == 0 ? DampingJacobian::gauss_newton : DampingJacobian::paper;
  }
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file) {
  const Json root = Json::parse(text, file);
  root.allow_only({"name", "cloth", "body", "world", "time", "solver", "contact", "start", "output"});
  Scene scene;
  scene.name = root.string_or("name", std::filesystem::path(file).stem().string());
  if (scene.name.empty()) root.at("name").fail("a name", "an empty string");
  const Json& cloth = root.at("cloth");
  for (const Json& one : cloth.array()) scene.cloth.push_back(read_cloth(one, file));
  if (scene.cloth.empty()) cloth.fail("at least one cloth", "an empty array");
  for (std::size_t k = 0; k < scene.cloth.size(); ++k) {
    if (scene.cloth[k].pattern.empty() != scene.cloth.front().pattern.empty())
      cloth.array()[k].fail("patterns only, or grids only, in one scene", "the other kind");
    for (std::size_t j = 0; j < k; ++j)
      if (!scene.cloth[k].name.empty() && scene.cloth[j].name == scene.cloth[k].name)
        cloth.array()[k].fail("a name that no other cloth has", '"' + printable(scene.cloth[k].name) + '"');
  }
  scene.until_still = !scene.cloth.front().pattern.empty();
  if (const Json* body = root.find("body")) scene.body = read_body(*body, file);
  if (const Json* world = root.find("world")) read_world(*world, scene);
  if (const Json* time = root.find("time")) read_time(*time, scene);
  if (const Json* solver = root.find("solver")) read_solver(*solver, scene);
  if (const Json* contact = root.find("contact")) {
    contact->allow_only({"thickness_mm", "friction", "friction_between", "self_contact", "strict_start"});
    read_number(*contact, "thickness_mm", scene.contact_thickness_m, 1e-3, 0.1, 100);
    read_number(*contact, "friction", scene.contact_friction, 1, 0, 100);
    if (const Json* pairs = contact->find("friction_between"))
      for (const Json& pair : pairs->array()) scene.friction_between.push_back(read_pair_friction(pair));
    scene.self_contact = contact->boolean_or("self_contact", true);
    scene.strict_start = contact->boolean_or("strict_start", false);
  }
  if (const Json* start = root.find("start")) scene.start = resolve(file, *start);
  if (const Json* output = root.find("output")) {
    output->allow_only({"dir", "preview", "picture_frames"});
    scene.output_dir = output->string_or("dir", "");
    if (const Json* frames = output->find("picture_frames"))
      for (const Json& frame : frames->array())
        scene.picture_frames.push_back(static_cast<int>(number_in(frame, 0, most_seconds * most_fps)));
    if (const Json* preview = output->find("preview")) scene.preview = preview->boolean();
  }
  return scene;
}

std::string read_text_file(const std::string& path) { return read_file(path, Json::text_limit); }

}  // namespace toile
