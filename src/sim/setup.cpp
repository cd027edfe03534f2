#include "sim/setup.hpp"

#include "body/body_motion.hpp"
#include "body/measure.hpp"
#include "core/error.hpp"
#include "garment/triangulate.hpp"
#include "io/file.hpp"
#include "io/obj.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace toile {
namespace {

constexpr std::string_view waist_label = "lower_interface";

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

bool is_set(const Vec3& v) { return !v.isZero(0); }

// R = Rz Ry Rx: the same convention as a panel's, and by the same code, exact at multiples of 90 degrees.
Mat3 rotation(const SceneCloth& cloth) {
  Panel panel;
  panel.rotation_deg = cloth.rotation_deg;
  return panel.rotation();
}

Index nearest_particle(std::span<const Vec3> x, const Vec3& p) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < x.size(); ++i)
    if ((x[i] - p).squaredNorm() < (x[best] - p).squaredNorm()) best = i;
  return static_cast<Index>(best);
}

Vec3 along(const std::vector<ScenePin::Key>& path, double t_s) {
  if (t_s <= path.front().t_s) return path.front().x_m;
  for (std::size_t k = 1; k < path.size(); ++k) {
    if (t_s > path[k].t_s) continue;
    const double s = (t_s - path[k - 1].t_s) / (path[k].t_s - path[k - 1].t_s);
    return (1 - s) * path[k - 1].x_m + s * path[k].x_m;
  }
  return path.back().x_m;
}

void add(Hash& hash, double x) { hash.add_bytes(&x, sizeof x); }
void add(Hash& hash, const Vec3& v) { hash.add_bytes(v.data(), 3 * sizeof(double)); }
void add(Hash& hash, std::string_view text) {
  add(hash, static_cast<double>(text.size()));
  hash.add_bytes(text.data(), text.size());
}
void add(Hash& hash, const std::optional<double>& x) {
  add(hash, x ? 1.0 : 0.0);
  add(hash, x.value_or(0));
}
void add(Hash& hash, const Fabric& f) {
  for (const double x : {f.density_kg_per_m2, f.stretch_u_N_per_m, f.stretch_v_N_per_m, f.shear_N_per_m,
                         f.compression_ratio, f.bend_u_N_m, f.bend_v_N_m, f.stretch_damping_s, f.shear_damping_s,
                         f.bend_damping_s, f.friction, f.thickness_m})
    add(hash, x);
}

BodyMovement movement_of(BodyMotion motion, std::string name, Hash& inputs) {
  motion.add_to(inputs);
  const double duration_s = motion.duration_s();
  return {[motion = std::move(motion)](double t_s, std::span<Vec3> x) { motion.positions(t_s, x); }, std::move(name),
          duration_s};
}

BodyMovement movement_from_file(const SceneBody& body, const CollisionBody& standing, Hash& inputs) {
  SampleOptions samples;
  samples.rate_hz = body.motion->fps;
  samples.unit = body.unit;
  samples.lead_in_s = body.motion->lead_in_s;
  return movement_of(BodyMotion::from_files(body.motion->path, standing, samples),
                     std::filesystem::path(body.motion->path).filename().string(), inputs);
}

// Flat sheet, placed; one panel with the cloth's name.
GarmentMesh make_grid(const SceneCloth& cloth) {
  const SceneGrid& g = *cloth.grid;
  const PlanarMesh sheet = equilateral_sheet(g.width_m, g.height_m, g.edge_m);
  const Vec2 middle(0.5 * g.width_m, 0.5 * g.height_m);
  const Mat3 turn = rotation(cloth);
  GarmentMesh grid;
  grid.name = cloth.name;
  grid.mesh.particle_count = static_cast<Index>(sheet.points.size());
  grid.mesh.triangles = sheet.triangles;
  grid.mesh.panel.assign(sheet.triangles.size(), 0);
  grid.mesh.panel_names = {cloth.name};
  const auto uv = [&](Index i) {
    return Vec2(sheet.points[at(i)].y(), -sheet.points[at(i)].x());
  };  // grain up, as in panels
  for (const Triangle& t : sheet.triangles) grid.mesh.uv.push_back({uv(t[0]), uv(t[1]), uv(t[2])});
  for (const Vec2& p : sheet.points) {
    const Vec2 q = p - middle;
    grid.x.push_back(turn * Vec3(q.x(), q.y(), 0) + cloth.translation_m);
    grid.merged.push_back(static_cast<Index>(grid.merged.size()));
  }
  return grid;
}

// The pattern of the cloth, meshed and moved as `placement` says.
GarmentMesh load_garment(const SceneCloth& cloth, const TextSource& read, Hash& inputs,
                         std::optional<double>& counted_edge_m) {
  const std::string text = read(cloth.pattern);
  inputs.add_bytes(text.data(), text.size());
  const std::string file = printable(cloth.pattern);
  const Pattern pattern = parse_pattern(text, file);
  GarmentMesh garment;
  try {
    if (cloth.vertices) {
      CountedGarment counted = mesh_garment_to_count(pattern, *cloth.vertices);
      garment = std::move(counted.garment);
      counted_edge_m = counted.resolution_m;
    } else {
      garment = mesh_garment(pattern, cloth.resolution_m);
    }
  } catch (const InputError& error) {
    throw Error(error.code(), file + ": " + error.what());
  }
  if (!cloth.name.empty()) garment.name = cloth.name;
  if (is_set(cloth.translation_m) || is_set(cloth.rotation_deg)) {
    const Mat3 turn = rotation(cloth);
    for (Vec3& x : garment.x) x = turn * x + cloth.translation_m;
  }
  return garment;
}

std::vector<Fabric> fabrics_of(const Scene& scene, const SceneCloth& cloth, const ClothMesh& mesh) {
  std::vector<Fabric> fabrics(mesh.panel_names.size(), cloth.fabric);
  for (std::size_t p = 0; p < mesh.panel_cloth.size(); ++p)
    if (!mesh.panel_cloth[p].fabric.empty()) fabrics[p] = fabric_preset(mesh.panel_cloth[p].fabric, "", "fabric");
  for (const ScenePanel& panel : cloth.panels) {
    const auto place = std::find(mesh.panel_names.begin(), mesh.panel_names.end(), panel.name);
    if (place == mesh.panel_names.end()) {
      const std::vector<std::string_view> names(mesh.panel_names.begin(), mesh.panel_names.end());
      throw InputError(
          panel.where, panel.pointer,
          "a panel of the cloth; nearest is \"" + printable(nearest_name(panel.name, names.data(), names.size())) + '"',
          '"' + printable(panel.name) + '"');
    }
    if (panel.fabric) fabrics[static_cast<std::size_t>(place - mesh.panel_names.begin())] = *panel.fabric;
  }
  for (Fabric& fabric : fabrics) {
    fabric.thickness_m = scene.contact_thickness_m.value_or(fabric.thickness_m);
    fabric.friction = scene.contact_friction.value_or(fabric.friction);
  }
  return fabrics;
}

std::vector<Vec2> rest_stretch_of(const SceneCloth& cloth, const ClothMesh& mesh) {
  std::vector<Vec2> b(mesh.panel_names.size(), Vec2(1, 1));
  for (std::size_t p = 0; p < mesh.panel_cloth.size(); ++p) b[p] = mesh.panel_cloth[p].rest_stretch;
  for (const ScenePanel& panel : cloth.panels)
    for (std::size_t p = 0; p < b.size(); ++p)
      if (mesh.panel_names[p] == panel.name)
        b[p] = Vec2(panel.rest_stretch_u.value_or(b[p].x()), panel.rest_stretch_v.value_or(b[p].y()));
  return b;
}

std::vector<Pin> pins_of(const SceneCloth& cloth, std::span<const Vec3> x) {
  std::vector<Pin> pins;
  for (const ScenePin& given : cloth.pins) {
    Pin pin;
    pin.particle = nearest_particle(x, given.near_m);
    for (std::size_t k = 0; k < pins.size(); ++k)
      if (pins[k].particle == pin.particle)
        throw InputError(
            given.where, given.pointer, "pins that hold different particles",
            "particle " + std::to_string(pin.particle) + ", held by pin " + std::to_string(k) + " already");
    if (given.on_path) pin.path = [path = given.path](double t_s) { return along(path, t_s); };
    pins.push_back(std::move(pin));
  }
  return pins;
}

}  // namespace

void check_areas(std::string_view file, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  constexpr double smallest = 1e-9;  // of the longer side's square
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3& origin = positions[at(triangles[t][0])];
    const Vec3 a = positions[at(triangles[t][1])] - origin, b = positions[at(triangles[t][2])] - origin;
    const double area = 0.5 * a.cross(b).norm();
    if (area > smallest * std::max(a.squaredNorm(), b.squaredNorm())) continue;
    throw InputError(file, "triangle " + std::to_string(t), "an area above zero", fmt::sprintf("%g", area));
  }
}

LoadedBody load_body(const SceneBody& body, Hash& inputs) {
  LoadedBody loaded;
  switch (body.kind) {
    case SceneBody::Kind::none:
      break;
    case SceneBody::Kind::cylinder:
      loaded.solid = rounded_cylinder(body.cylinder.radius_m, body.cylinder.height_m, body.cylinder.top_m);
      break;
    case SceneBody::Kind::mannequin: {
      const Mannequin mannequin = make_mannequin(body.mannequin);
      CollisionBody made = from_mannequin(mannequin);
      if (body.motion && body.motion->name.empty()) {
        loaded.movement = movement_from_file(body, made, inputs);
      } else if (body.motion) {
        Motion motion = Motion::named(body.motion->name, body.mannequin);
        motion.set_lead_in_s(body.motion->lead_in_s);
        loaded.movement = movement_of(BodyMotion::of_mannequin(mannequin, motion), body.motion->name, inputs);
      }
      loaded.solid = {std::move(made.positions), std::move(made.triangles)};
      break;
    }
    case SceneBody::Kind::mesh: {
      const std::string text = read_file(body.mesh);
      inputs.add_bytes(text.data(), text.size());
      CollisionBody read = make_collision_body(parse_obj(text, printable(body.mesh)), printable(body.mesh), body.unit);
      check_areas(printable(body.mesh), read.positions, read.triangles);
      if (body.motion) loaded.movement = movement_from_file(body, read, inputs);
      loaded.solid = {std::move(read.positions), std::move(read.triangles)};
      break;
    }
  }
  return loaded;
}

LoadedCloth load_cloth(const Scene& scene, const SceneCloth& cloth, const TextSource& read, Hash& inputs) {
  LoadedCloth loaded;
  std::optional<double> counted_edge_m;
  loaded.garment = cloth.grid ? make_grid(cloth) : load_garment(cloth, read, inputs, counted_edge_m);
  loaded.fabrics = fabrics_of(scene, cloth, loaded.garment.mesh);
  loaded.rest_stretch = rest_stretch_of(cloth, loaded.garment.mesh);
  loaded.pins = pins_of(cloth, loaded.garment.x);
  for (const SceneDrag& given : cloth.drags) {
    TimedDrag drag;
    drag.near_m = given.near_m;
    drag.from_s = given.from_s;
    drag.to_s = given.to_s;
    drag.drag.target = [path = given.path](double t_s) { return along(path, t_s); };
    drag.drag.stiffness_N_per_m = given.stiffness_N_per_m;
    drag.drag.damping_N_s_per_m = given.damping_N_s_per_m;
    drag.drag.max_force_N = given.max_force_N;
    loaded.drags.push_back(std::move(drag));
  }
  const std::vector<std::string>& names = loaded.garment.mesh.panel_names;
  for (const ScenePanel& panel : cloth.panels) {
    if (panel.rest_stretch_path.empty()) continue;
    const auto place = std::find(names.begin(), names.end(), panel.name);
    loaded.rest_stretch_paths.push_back({static_cast<Index>(place - names.begin()), panel.rest_stretch_path});
  }
  loaded.edge_m = cloth.grid ? cloth.grid->edge_m : counted_edge_m.value_or(cloth.resolution_m);
  if (scene.cloth.size() > 1)  // two garments may both have a "front"
    for (std::string& panel : loaded.garment.mesh.panel_names) panel.insert(0, loaded.garment.name + '/');
  return loaded;
}

Outfit outfit_of_grids(std::span<const LoadedCloth> grids) {
  Outfit outfit;
  for (const LoadedCloth& grid : grids) put_behind(outfit, grid.garment, grid.fabrics, grid.rest_stretch);
  return outfit;
}

std::vector<Pin> pins_of(std::span<const LoadedCloth> cloth) {
  std::vector<Pin> pins;
  Index first = 0;
  for (const LoadedCloth& one : cloth) {
    for (Pin pin : one.pins) {
      pin.particle += first;
      pins.push_back(std::move(pin));
    }
    first += one.garment.mesh.particle_count;
  }
  return pins;
}

Events events_of(const Outfit& outfit, std::span<const LoadedCloth> cloth) {
  Events events;
  Index first = 0;
  for (std::size_t k = 0; k < cloth.size(); ++k) {
    const OutfitPart& part = outfit.parts[k];
    const auto x = std::span(outfit.state.x).subspan(at(first), at(part.particles));
    for (TimedDrag drag : cloth[k].drags) {
      drag.drag.particle[0] = first + nearest_particle(x, drag.near_m);
      events.drags.push_back(std::move(drag));
    }
    for (TimedRestStretch path : cloth[k].rest_stretch_paths) {
      path.panel += part.first_panel;
      events.rest_stretch.push_back(std::move(path));
    }
    first += part.particles;
  }
  return events;
}

std::vector<LabelHeight> label_heights_of(const SceneCloth& cloth, const GarmentMesh& garment,
                                          std::span<const Vec3> body_x, std::span<const Triangle> body_triangles,
                                          std::vector<std::string>& warnings) {
  std::vector<LabelHeight> heights = cloth.label_heights;
  for (const LabelHeight& height : heights) {
    if (std::none_of(garment.labels.begin(), garment.labels.end(),
                     [&](const LabelledEdge& edge) { return edge.label == height.label; }))
      throw InputError(cloth.pattern, "label_heights_m", "a label that an edge of the pattern carries",
                       '"' + printable(height.label) + '"');
  }
  std::vector<std::string> free;
  for (const LabelledEdge& edge : garment.labels) {
    const auto named = [&](const LabelHeight& height) { return height.label == edge.label; };
    if (std::any_of(heights.begin(), heights.end(), named)) continue;
    const double waist = edge.label == waist_label && !body_x.empty() ? waist_height_m(body_x, body_triangles) : 0;
    if (waist > 0) {
      heights.push_back({edge.label, waist});
    } else if (std::find(free.begin(), free.end(), edge.label) == free.end()) {
      free.push_back(edge.label);
    }
  }
  for (const std::string& label : free)
    warnings.push_back("edges labelled \"" + printable(label) + "\" are not held: their height is not known");
  return heights;
}

double default_offset_m(double edge_m) { return std::clamp(0.2 * edge_m, 1.5e-3, 2.5e-3); }

StepOptions step_options(const Scene& scene, const Fabric& fabric, double edge_m) {
  StepOptions step;
  if (scene.preconditioner) step.pcg.preconditioner = *scene.preconditioner;
  step.pcg.tolerance = scene.tolerance;
  step.pcg.procedure = scene.procedure;
  step.integrator = scene.integrator;
  step.newton_iterations = scene.newton_iterations;
  step.relinearisations = scene.relinearisations;
  step.rows.cloth_cloth = scene.self_contact;
  step.body.offset_m = scene.body.offset_m.value_or(default_offset_m(edge_m));
  step.body.friction = scene.body.friction.value_or(fabric.friction);
  return step;
}

void add_to_hash(const Scene& scene, Hash& hash) {
  for (const SceneCloth& cloth : scene.cloth) {
    if (cloth.grid)
      for (const double x : {cloth.grid->width_m, cloth.grid->height_m, cloth.grid->edge_m}) add(hash, x);
    add(hash, cloth.resolution_m);
    add(hash, static_cast<double>(cloth.vertices.value_or(0)));
    add(hash, cloth.fabric);
    for (const ScenePanel& panel : cloth.panels) {
      add(hash, std::string_view(panel.name));
      add(hash, panel.fabric.value_or(cloth.fabric));
      add(hash, panel.rest_stretch_u);
      add(hash, panel.rest_stretch_v);
    }
    for (const ScenePanel& panel : cloth.panels)
      for (const RestStretchKey& key : panel.rest_stretch_path)
        for (const double x : {key.t_s, key.b.x(), key.b.y()}) add(hash, x);
    for (const SceneDrag& drag : cloth.drags) {
      add(hash, drag.near_m);
      for (const double x : {drag.stiffness_N_per_m, drag.damping_N_s_per_m, drag.max_force_N, drag.from_s, drag.to_s})
        add(hash, x);
      for (const ScenePin::Key& key : drag.path) {
        add(hash, key.t_s);
        add(hash, key.x_m);
      }
    }
    add(hash, cloth.translation_m);
    add(hash, cloth.rotation_deg);
    for (const LabelHeight& height : cloth.label_heights) {
      add(hash, std::string_view(height.label));
      add(hash, height.height_m);
    }
    for (const ScenePin& pin : cloth.pins) {
      add(hash, pin.near_m);
      for (const ScenePin::Key& key : pin.path) {
        add(hash, key.t_s);
        add(hash, key.x_m);
      }
    }
  }
  const SceneBody& body = scene.body;
  add(hash, static_cast<double>(body.kind));
  add(hash, static_cast<double>(body.unit));
  add(hash, static_cast<double>(body.mannequin));
  add(hash, body.motion ? 1.0 : 0.0);
  if (body.motion) {
    add(hash, std::string_view(body.motion->name));
    add(hash, body.motion->fps);
    add(hash, body.motion->lead_in_s);
  }
  if (body.kind == SceneBody::Kind::cylinder) {
    add(hash, body.cylinder.radius_m);
    add(hash, body.cylinder.height_m);
    add(hash, body.cylinder.top_m);
  }
  add(hash, body.friction);
  add(hash, body.offset_m);
  add(hash, scene.gravity_m_per_s2);
  add(hash, scene.air.wind_m_per_s);
  add(hash, scene.air.density_kg_per_m3);
  add(hash, scene.fps);
  add(hash, scene.seconds);
  add(hash, scene.drape_seconds);
  add(hash, scene.step_max_s);
  add(hash, scene.until_still ? 1.0 : 0.0);
  add(hash, scene.preconditioner ? 1.0 + static_cast<double>(*scene.preconditioner) : 0.0);
  add(hash, scene.tolerance);
  add(hash, static_cast<double>(scene.procedure));
  add(hash, static_cast<double>(scene.integrator));
  add(hash, static_cast<double>(scene.newton_iterations));
  add(hash, static_cast<double>(scene.relinearisations));
  add(hash, scene.paper_scaling ? 1.0 : 0.0);
  add(hash, static_cast<double>(scene.damping_jacobian));
  add(hash, scene.contact_thickness_m);
  add(hash, scene.contact_friction);
  for (const PairFriction& pair : scene.friction_between) {
    add(hash, std::string_view(pair.first));
    add(hash, std::string_view(pair.second));
    add(hash, pair.friction);
  }
  add(hash, scene.self_contact ? 1.0 : 0.0);
}

}  // namespace toile
