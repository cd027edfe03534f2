// sim/scene_cloth.cpp: reads one cloth of a scene: its shape, fabric, pins and hands.
#include "sim/scene_reading.hpp"

#include <fmt/printf.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace toile::scene_reading {
namespace {

Fabric read_fabric(const Json& value) {
  if (value.is_string()) return fabric_preset(value.string(), value.where(), value.pointer());
  if (!value.is_object())
    value.fail("the name of a fabric, or an object with \"base\" and what differs from it", value.describe());
  value.allow_only({"base", "density_kg_per_m2", "stretch_u_N_per_m", "stretch_v_N_per_m", "shear_N_per_m",
                    "compression_ratio", "strain_limit", "bend_u_N_m", "bend_v_N_m", "stretch_damping_s",
                    "shear_damping_s", "bend_damping_s", "friction", "thickness_m"});
  Fabric fabric;
  if (const Json* base = value.find("base")) fabric = fabric_preset(base->string(), base->where(), base->pointer());
  struct Member {
    std::string_view key;
    double Fabric::*member;
    double most;
  };
  static constexpr std::array<Member, 13> members = {{{"compression_ratio", &Fabric::compression_ratio, 1},
                                                      {"strain_limit", &Fabric::strain_limit, 1},
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

// [[t_s, x, y, z], ...], ascending.
std::vector<ScenePin::Key> read_path(const Json& path) {
  std::vector<ScenePin::Key> keys;
  for (const Json& key : path.array()) {
    if (!key.is_array() || key.array().size() != 4) key.fail("four numbers [t_s, x, y, z]", key.describe());
    ScenePin::Key at{number_in(key.array()[0], 0, most_seconds), {}};
    for (std::size_t k = 0; k < 3; ++k) at.x_m[static_cast<Eigen::Index>(k)] = number_in(key.array()[k + 1], -1e4, 1e4);
    if (!keys.empty() && !(at.t_s > keys.back().t_s)) key.fail("times that ascend", "a time not after the one before");
    if (const double m_per_s = keys.empty() ? 0 : (at.x_m - keys.back().x_m).norm() / (at.t_s - keys.back().t_s);
        m_per_s > most_led_m_per_s)
      key.fail(fmt::sprintf("at most %g m/s from the key before", most_led_m_per_s), fmt::sprintf("%.4g m/s", m_per_s));
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
  value.allow_only({"near_m", "in_box_m", "hold", "path_m", "moves", "about_m", "from_s", "to_s"});
  ScenePin pin;
  pin.where = value.where();
  pin.pointer = value.pointer();
  if (const Json* box = value.find("in_box_m")) {
    if (const Json* near = value.find("near_m")) near->fail("either \"near_m\" or \"in_box_m\"", "both");
    if (!box->is_array() || box->array().size() != 2) box->fail("two corners [[x, y, z], [x, y, z]]", box->describe());
    const Vec3 a = vector_of(box->array()[0]), b = vector_of(box->array()[1]);
    pin.in_box_m = {a.cwiseMin(b), a.cwiseMax(b)};
  } else {
    pin.near_m = vector_of(value.at("near_m"));
  }
  read_number(value, "from_s", pin.from_s, 1, 0, most_seconds);
  read_number(value, "to_s", pin.to_s, 1, 0, most_seconds);
  if (!(pin.to_s > pin.from_s)) value.fail("a pin that lets go after it takes hold", "to_s not after from_s");
  static constexpr std::array<std::string_view, 3> holds = {"fixed", "path", "moves"};
  std::size_t hold = 0;
  if (const Json* how = value.find("hold")) hold = one_of(*how, holds);
  const Json *path = value.find("path_m"), *moves = value.find("moves"), *about = value.find("about_m");
  pin.on_path = hold == 1;
  if (path != nullptr && hold != 1) path->fail("\"hold\": \"path\" beside it", "a path without it");
  if (moves != nullptr && hold != 2) moves->fail("\"hold\": \"moves\" beside it", "moves without it");
  if (about != nullptr && hold != 2) about->fail("\"hold\": \"moves\" beside it", "a centre without it");
  if (hold == 1) {
    if (path == nullptr) value.fail("\"path_m\": [[t_s, x, y, z], ...]", "hold \"path\" without a path");
    if (pin.in_box_m) path->fail("\"moves\" for all in a box", "one place for all of them");
    pin.path = read_path(*path);
  }
  if (hold == 2) {
    if (moves == nullptr) value.fail("\"moves\": [{\"t_s\": ...}, ...]", "hold \"moves\" without moves");
    pin.moves = read_moves(*moves, about != nullptr ? vector_of(*about) : Vec3(0, 0, 0));
  }
  return pin;
}

SceneGrid read_grid(const Json& value) {
  value.allow_only({"width_m", "height_m", "edge_m"});
  SceneGrid grid;
  read_number(value, "width_m", grid.width_m, 1, 1e-3, 10);
  read_number(value, "height_m", grid.height_m, 1, 1e-3, 10);
  read_number(value, "edge_m", grid.edge_m, 1, 5e-4, 1);
  return grid;
}

SceneTube read_tube(const Json& value) {
  value.allow_only({"radius_m", "length_m", "edge_m"});
  SceneTube tube;
  read_number(value, "radius_m", tube.radius_m, 1, 1e-3, 10);
  read_number(value, "length_m", tube.length_m, 1, 1e-3, 10);
  read_number(value, "edge_m", tube.edge_m, 1, 5e-4, 1);
  if (tube.edge_m > tube.radius_m) value.fail("an edge_m of at most its radius_m", value.at("edge_m").describe());
  return tube;
}

double length_of(const std::vector<Vec3>& path, bool closed) {
  double length = closed ? (path.front() - path.back()).norm() : 0;
  for (std::size_t k = 1; k < path.size(); ++k) length += (path[k] - path[k - 1]).norm();
  return length;
}

constexpr double least_step_m = 2e-6;  // as of the points of an outline (garment/triangulate.hpp)

double last_step_m(const std::vector<Vec3>& path) { return (path.back() - path[path.size() - 2]).norm(); }

SceneRibbon read_ribbon(const Json& value) {
  value.allow_only({"width_m", "edge_m", "path_m", "closed", "across"});
  SceneRibbon ribbon;
  read_number(value, "width_m", ribbon.width_m, 1, 1e-3, 10);
  read_number(value, "edge_m", ribbon.edge_m, 1, 5e-4, 1);
  ribbon.closed = value.boolean_or("closed", false);
  const Json& path = value.at("path_m");
  for (const Json& point : path.array()) {
    ribbon.path_m.push_back(vector_of(point));
    if (ribbon.path_m.size() > 1 && !(last_step_m(ribbon.path_m) >= least_step_m))
      point.fail("another place than the point before, at least 2 micrometres from it",
                 fmt::sprintf("%.3g m", last_step_m(ribbon.path_m)));
  }
  const std::size_t least = ribbon.closed ? 3 : 2;
  if (ribbon.path_m.size() < least)
    path.fail("at least " + std::to_string(least) + " points [x, y, z]", std::to_string(ribbon.path_m.size()));
  if (ribbon.closed && ribbon.path_m.front() == ribbon.path_m.back())
    path.fail("the first point only once: a closed ribbon goes back to it", "the first point again at the end");
  if (ribbon.closed && length_of(ribbon.path_m, true) < 6 * ribbon.edge_m)
    value.fail("an edge_m of at most a sixth of the way round", path.describe());
  if (const Json* across = value.find("across")) {
    ribbon.across = vector_of(*across);
    if (ribbon.across.isZero(0)) across->fail("a direction", "zero");
  }
  return ribbon;
}

// Throws for more triangles of this edge length than anyone means.
void check_count(const Json& shape, double area_m2, double edge_m) {
  const double triangles = 4 * area_m2 / (edge_m * edge_m * std::sqrt(3.0));
  if (triangles > 2e6) shape.fail("at most 2 million triangles", std::to_string(triangles) + " from this edge_m");
}

// The one of "pattern", "grid", "tube" and "ribbon" that is given.
void read_shape(const Json& value, const std::string& file, SceneCloth& cloth) {
  const Json *pattern = value.find("pattern"), *grid = value.find("grid"), *tube = value.find("tube"),
             *ribbon = value.find("ribbon");
  int given = 0;
  for (const Json* shape : {pattern, grid, tube, ribbon})
    if (shape != nullptr) ++given;
  if (given != 1)
    value.fail("one of \"pattern\", \"grid\", \"tube\", \"ribbon\"",
               given == 0 ? "none of them" : std::to_string(given) + " of them");
  if (pattern != nullptr) {
    cloth.pattern = resolve(file, *pattern);
    return;
  }
  if (grid != nullptr) {
    cloth.grid = read_grid(*grid);
    check_count(*grid, cloth.grid->width_m * cloth.grid->height_m, cloth.grid->edge_m);
  } else if (tube != nullptr) {
    cloth.tube = read_tube(*tube);
    check_count(*tube, 2 * std::numbers::pi * cloth.tube->radius_m * cloth.tube->length_m, cloth.tube->edge_m);
  } else {
    cloth.ribbon = read_ribbon(*ribbon);
    check_count(*ribbon, length_of(cloth.ribbon->path_m, cloth.ribbon->closed) * cloth.ribbon->width_m,
                cloth.ribbon->edge_m);
  }
  if (cloth.name.empty()) cloth.name = grid != nullptr ? "sheet" : tube != nullptr ? "tube" : "ribbon";
}

}  // namespace

SceneCloth read_cloth(const Json& value, const std::string& file) {
  value.allow_only({"name", "pattern", "grid", "tube", "ribbon", "resolution_cm", "vertices", "fabric", "panels",
                    "placement", "pins", "drags", "label_heights_m"});
  SceneCloth cloth;
  cloth.where = value.where();
  cloth.pointer = value.pointer();
  cloth.name = value.string_or("name", "");
  read_shape(value, file, cloth);
  read_number(value, "resolution_cm", cloth.resolution_m, 0.01, 0.1, 20);
  if (const Json* vertices = value.find("vertices")) {
    if (!cloth.is_sewn()) vertices->fail("a pattern beside it: other shapes have an edge_m", "a number of vertices");
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
  read_placement(value, cloth.translation_m, cloth.rotation_deg);
  if (const Json* heights = value.find("label_heights_m")) {
    for (const auto& [label, height] : heights->object())
      cloth.label_heights.push_back({label, number_in(height, -10, 10)});
  }
  if (const Json* drags = value.find("drags"))
    for (const Json& drag : drags->array()) cloth.drags.push_back(read_drag(drag));
  if (const Json* pins = value.find("pins")) {
    for (const Json& pin : pins->array()) cloth.pins.push_back(read_pin(pin));
    if (cloth.is_sewn() && !cloth.pins.empty())
      pins->fail("no pins on a garment that is sewn: not available yet", pins->describe());
  }
  return cloth;
}

}  // namespace toile::scene_reading
