// sim/setup.cpp: the cloth of a scene, and what happens to it.
#include "sim/setup.hpp"

#include "core/error.hpp"
#include "io/mesh_file.hpp"
#include "mesh/check.hpp"
#include "sim/check_garment.hpp"
#include "sim/cloth_arrays.hpp"
#include "sim/cloth_of_mesh.hpp"
#include "sim/cloth_shapes.hpp"

#include <algorithm>
#include <string_view>

namespace toile::internal {
namespace {

bool is_set(const Vec3& v) { return !v.isZero(0); }

Index nearest_particle(std::span<const Vec3> x, const Vec3& p) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < x.size(); ++i)
    if ((x[i] - p).squaredNorm() < (x[best] - p).squaredNorm()) best = i;
  return static_cast<Index>(best);
}

// The pattern of the cloth, meshed and moved as `placement` says.
GarmentMesh load_garment(const SceneCloth& cloth, const TextSource& read, Hash& inputs,
                         std::optional<double>& counted_edge_m, std::optional<Pattern>& as_read) {
  const std::string text = read(cloth.pattern);
  inputs.add_text(text);
  const std::string file = printable(cloth.pattern);
  as_read = parse_pattern(text, file);
  const Pattern& pattern = *as_read;
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
    throw_within(file, error);
  }
  if (!cloth.name.empty()) garment.name = cloth.name;
  if (is_set(cloth.translation_m) || is_set(cloth.rotation_deg)) {
    const Mat3 turn = rotation_from_degrees(cloth.rotation_deg);
    for (Vec3& x : garment.x) x = turn * x + cloth.translation_m;
  }
  return garment;
}

// The shape of the cloth, or the refusal of one that has none, at its place in the scene.
GarmentMesh load_shape(const SceneCloth& cloth, const TextSource& read, Hash& inputs,
                       std::vector<std::string>& warnings) {
  if (!cloth.mesh.empty()) {
    const std::string text = read(cloth.mesh), file = printable(cloth.mesh);
    inputs.add_text(text);
    SceneCloth as_arrays = cloth;
    const SurfaceMesh mesh = parse_mesh(text, cloth.mesh, [&](std::string_view beside) { inputs.add_text(beside); });
    as_arrays.arrays = std::make_shared<const SceneClothArrays>(
        arrays_of_mesh(mesh, file, metres_in(cloth.mesh_unit), cloth.rest_shape, warnings));
    return cloth_of_arrays(as_arrays);
  }
  if (cloth.arrays) {
    add_to_hash(*cloth.arrays, inputs);
    return cloth_of_arrays(cloth);
  }
  GarmentMesh shape = shaped_cloth(cloth);
  check_areas("", shape.x, shape.mesh.triangles);
  return shape;
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

bool has_label(const GarmentMesh& garment, const std::string& label) {
  return std::any_of(garment.labels.begin(), garment.labels.end(),
                     [&](const LabelledEdge& edge) { return edge.label == label; });
}

void check_labels(const SceneCloth& cloth, const GarmentMesh& garment) {
  for (const LabelHeight& height : cloth.label_heights)
    if (!has_label(garment, height.label))
      throw InputError(cloth.shape_where, cloth.shape_pointer + "/label_heights_m",
                       "a label that an edge of the pattern carries", '"' + printable(height.label) + '"');
}

std::vector<TimedPin> pins_of(const SceneCloth& cloth, std::span<const Vec3> x) {
  std::vector<TimedPin> pins;
  for (const PinnedParticle& pinned : pinned_particles(cloth, x))
    pins.push_back(timed_pin(cloth.pins[pinned.pin], pinned.particle));
  return pins;
}

}  // namespace

std::vector<PinnedParticle> pinned_particles(const SceneCloth& cloth, std::span<const Vec3> x) {
  std::vector<PinnedParticle> pinned;
  for (std::size_t k = 0; k < cloth.pins.size(); ++k) {
    const ScenePin& given = cloth.pins[k];
    std::vector<Index> held;
    if (!given.in_box_m) {
      held = {nearest_particle(x, given.near_m)};
    } else {
      const auto& [low, high] = *given.in_box_m;
      for (std::size_t i = 0; i < x.size(); ++i)
        if ((x[i].array() >= low.array()).all() && (x[i].array() <= high.array()).all())
          held.push_back(static_cast<Index>(i));
      if (held.empty()) throw InputError(given.where, given.pointer, "a box with particles of the cloth in it", "none");
    }
    double reach_m = 0;
    for (const Index i : held) {
      for (const PinnedParticle& other : pinned)
        if (other.particle == i && cloth.pins[other.pin].from_s < given.to_s &&
            given.from_s < cloth.pins[other.pin].to_s)
          throw InputError(given.where, given.pointer, "pins that hold different particles",
                           "particle " + std::to_string(i) + ", held by pin " + std::to_string(other.pin) + " already");
      reach_m = std::max(reach_m, (x[at(i)] - given.moves.centre()).norm());
    }
    check_speed(given.moves, reach_m, given.where, given.pointer);
    for (const Index i : held) pinned.push_back({k, i});
  }
  return pinned;
}

TimedPin timed_pin(const ScenePin& given, Index particle) {
  TimedPin timed;
  timed.from_s = given.from_s;
  timed.to_s = given.to_s;
  timed.moves = given.moves;
  timed.on_body = given.hold == ScenePin::Hold::body;
  timed.pin.particle = particle;
  if (given.hold == ScenePin::Hold::path)
    timed.pin.path = [path = given.path](double t_s) { return along(path, &ScenePin::Key::x_m, t_s); };
  return timed;
}

LoadedCloth load_cloth(const Scene& scene, const SceneCloth& cloth, const TextSource& read, Hash& inputs) {
  LoadedCloth loaded;
  std::optional<double> counted_edge_m;
  const std::string where = cloth.is_sewn()             ? printable(cloth.pattern)
                            : !cloth.mesh.empty()       ? printable(cloth.mesh)
                            : cloth.shape_where.empty() ? printable(cloth.name)
                                                        : cloth.shape_where + ": " + cloth.shape_pointer;
  try {
    loaded.garment = cloth.is_sewn() ? load_garment(cloth, read, inputs, counted_edge_m, loaded.pattern)
                                     : load_shape(cloth, read, inputs, loaded.warnings);
  } catch (const InputError& error) {
    throw_within(where, error);
  }
  check_garment(where, loaded.garment);
  check_labels(cloth, loaded.garment);
  loaded.fabrics = fabrics_of(scene, cloth, loaded.garment.mesh);
  loaded.rest_stretch = rest_stretch_of(cloth, loaded.garment.mesh);
  if (!cloth.is_sewn()) loaded.pins = pins_of(cloth, loaded.garment.x);
  for (const SceneDrag& given : cloth.drags) {
    TimedDrag drag;
    drag.near_m = given.near_m;
    drag.from_s = given.from_s;
    drag.to_s = given.to_s;
    drag.drag.target = [path = given.path](double t_s) { return along(path, &ScenePin::Key::x_m, t_s); };
    drag.drag.stiffness_N_per_m = given.stiffness_N_per_m;
    drag.drag.damping_N_s_per_m = given.damping_N_s_per_m;
    drag.drag.max_force_N = given.max_force_N;
    loaded.drags.push_back(std::move(drag));
  }
  const std::vector<std::string>& names = loaded.garment.mesh.panel_names;
  for (const ScenePanel& panel : cloth.panels) {
    const auto number = static_cast<Index>(std::find(names.begin(), names.end(), panel.name) - names.begin());
    loaded.panels.push_back({number, panel});
  }
  loaded.edge_m =
      cloth.arrays ? mesh_quality(loaded.garment.mesh).mean_edge_m : counted_edge_m.value_or(cloth.edge_m());
  if (scene.cloth.size() > 1)  // two garments may both have a "front"
    for (std::string& panel : loaded.garment.mesh.panel_names) panel.insert(0, loaded.garment.name + '/');
  return loaded;
}

Outfit outfit_of_shapes(std::span<const LoadedCloth> cloth) {
  Outfit outfit;
  for (const LoadedCloth& one : cloth) put_behind(outfit, one.garment, one.fabrics, one.rest_stretch);
  return outfit;
}

Events events_of(const Outfit& outfit, std::span<const LoadedCloth> cloth) {
  Events events;
  Index first = 0;
  for (std::size_t k = 0; k < cloth.size(); ++k) {
    const OutfitPart& part = outfit.parts[k];
    const auto x = std::span(outfit.state.x).subspan(at(first), at(part.particles));
    for (TimedPin timed : cloth[k].pins) {
      timed.pin.particle += first;
      events.pins.push_back(std::move(timed));
    }
    for (TimedDrag drag : cloth[k].drags) {
      drag.drag.particle[0] = first + nearest_particle(x, drag.near_m);
      events.drags.push_back(std::move(drag));
    }
    for (OwnOfPanel panel : cloth[k].panels) {
      panel.panel += part.first_panel;
      events.panels.push_back(std::move(panel));
    }
    first += part.particles;
  }
  return events;
}

std::vector<LabelHeight> label_heights_of(const SceneCloth& cloth, const GarmentMesh& garment, bool on_shoulders,
                                          const BodyFigures& body, std::vector<std::string>& warnings) {
  check_labels(cloth, garment);
  std::vector<LabelHeight> heights = cloth.label_heights;
  std::vector<std::string> free;
  for (const LabelledEdge& edge : garment.labels) {
    const auto named = [&](const LabelHeight& height) { return height.label == edge.label; };
    if (std::any_of(heights.begin(), heights.end(), named)) continue;
    if (on_shoulders && edge.label == edge_label::waist) continue;
    if (edge.label == edge_label::waist && body.waist_m > 0) {
      heights.push_back({edge.label, body.waist_m});
    } else if (!is_of_bodice(edge.label) && std::find(free.begin(), free.end(), edge.label) == free.end()) {
      free.push_back(edge.label);
    }
  }
  for (const std::string& label : free)
    warnings.push_back("edges labelled \"" + printable(label) + "\" are not held: their height is not known");
  return heights;
}

double default_offset_m(double edge_m) { return std::clamp(0.2 * edge_m, 1.5e-3, 2.5e-3); }

StepOptions step_options(const Scene& scene, double edge_m) {
  StepOptions step;
  if (scene.preconditioner) step.pcg.preconditioner = *scene.preconditioner;
  step.pcg.tolerance = scene.solver_tolerance();
  step.pcg.procedure = scene.procedure;
  step.integrator = scene.integrator;
  step.newton_iterations = scene.newton_iterations;
  step.relinearisations = scene.relinearisations;
  step.rows.cloth_cloth = scene.self_contact;
  step.flypaper = scene.flypaper;
  step.body.offset_m = scene.body.contact.offset_m.value_or(default_offset_m(edge_m));
  step.body.friction = scene.body.contact.friction;
  if (scene.body.exists()) step.body.colliders.emplace_back();
  for (const SceneCollider& solid : scene.solids) step.body.colliders.push_back(solid.contact);
  return step;
}

}  // namespace toile::internal
