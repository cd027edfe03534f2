// sim/setup.cpp: the cloth of a scene, and its changes over time.
#include "sim/setup.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <string_view>

namespace toile::internal {
namespace {

Index nearest_particle(std::span<const Vec3> x, const Vec3& p) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < x.size(); ++i)
    if ((x[i] - p).squaredNorm() < (x[best] - p).squaredNorm()) best = i;
  return static_cast<Index>(best);
}

std::string path_of_cloth(std::size_t k) { return "/cloth/" + std::to_string(k); }

std::vector<Fabric> fabrics_of(const Scene& scene, std::size_t k, const ClothMesh& mesh) {
  const SceneCloth& cloth = scene.cloth[k];
  std::vector<Fabric> fabrics(mesh.panel_names.size(), cloth.fabric);
  std::vector<std::optional<Fabric>> interfacing(fabrics.size());
  std::vector<double> apart_m(fabrics.size(), fused_apart_m);
  for (std::size_t p = 0; p < mesh.panel_cloth.size(); ++p) {
    const PanelCloth& own = mesh.panel_cloth[p];
    if (!own.fabric.empty()) fabrics[p] = fabric_preset(own.fabric, "", "fabric");
    if (!own.interfacing.fabric.empty()) interfacing[p] = fabric_preset(own.interfacing.fabric, "", "interfacing");
    apart_m[p] = own.interfacing.apart_m.value_or(fused_apart_m);
  }
  for (const ScenePanel& panel : cloth.panels) {
    const auto place = std::find(mesh.panel_names.begin(), mesh.panel_names.end(), panel.name);
    if (place == mesh.panel_names.end()) {
      const std::vector<std::string_view> names(mesh.panel_names.begin(), mesh.panel_names.end());
      throw InputError(
          "cloth: panels", "",
          "a panel of the cloth; nearest is \"" + printable(nearest_name(panel.name, names.data(), names.size())) + '"',
          '"' + printable(panel.name) + '"')
          .of(path_of_cloth(k) + "/panels" + pointer_step(panel.name));
    }
    const auto p = static_cast<std::size_t>(place - mesh.panel_names.begin());
    if (panel.fabric) fabrics[p] = *panel.fabric;
    if (panel.interfacing) interfacing[p] = panel.interfacing;
    if (panel.interfacing_mm) apart_m[p] = 1e-3 * *panel.interfacing_mm;
    if (panel.interfacing_mm && !interfacing[p])
      throw InputError("cloth: panels", "/interfacing_mm", "an interfacing whose distance it is",
                       "none, neither here nor in the pattern")
          .of(path_of_cloth(k) + "/panels" + pointer_step(panel.name));
  }
  for (std::size_t p = 0; p < fabrics.size(); ++p)
    if (interfacing[p]) fabrics[p] = fused(fabrics[p], *interfacing[p], apart_m[p]);
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

void check_labels(const SceneCloth& cloth, const GarmentMesh& garment, std::string_view path = {}) {
  for (const LabelHeight& height : cloth.label_heights)
    if (!has_label(garment, height.label))
      throw InputError(cloth.is_sewn() ? printable(cloth.path()) : std::string(), "/label_heights_m",
                       "a label that an edge of the pattern carries", '"' + printable(height.label) + '"')
          .of(path);
}

std::vector<TimedPin> pins_of(const Scene& scene, std::size_t k, std::span<const Vec3> x) {
  std::vector<TimedPin> pins;
  for (const PinnedParticle& pinned : pinned_particles(scene, k, x))
    pins.push_back(timed_pin(scene.cloth[k].pins[pinned.pin], pinned.particle));
  return pins;
}

}  // namespace

std::vector<PinnedParticle> pinned_particles(const Scene& scene, std::size_t k, std::span<const Vec3> x) {
  const SceneCloth& cloth = scene.cloth[k];
  std::vector<PinnedParticle> pinned;
  for (std::size_t p = 0; p < cloth.pins.size(); ++p) {
    const ScenePin& given = cloth.pins[p];
    const std::string path = path_of_cloth(k) + "/pins/" + std::to_string(p);
    const auto refuse = [&](std::string_view expected, std::string_view got) {
      throw InputError("pin " + std::to_string(p), "", expected, got).of(path);
    };
    std::vector<Index> held;
    if (!given.in_box_m) {
      held = {nearest_particle(x, given.near_m)};
    } else {
      const auto& [low, high] = *given.in_box_m;
      for (std::size_t i = 0; i < x.size(); ++i)
        if ((x[i].array() >= low.array()).all() && (x[i].array() <= high.array()).all())
          held.push_back(static_cast<Index>(i));
      if (held.empty()) refuse("a box with particles of the cloth in it", "none");
    }
    double reach_m = 0;
    for (const Index i : held) {
      for (const PinnedParticle& other : pinned)
        if (other.particle == i && cloth.pins[other.pin].from_s < given.to_s &&
            given.from_s < cloth.pins[other.pin].to_s)
          refuse("pins that hold different particles",
                 "particle " + std::to_string(i) + ", held by pin " + std::to_string(other.pin) + " already");
      reach_m = std::max(reach_m, (x[at(i)] - given.moves.centre()).norm());
    }
    check_speed(given.moves, reach_m, path);
    for (const Index i : held) pinned.push_back({p, i});
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
    timed.pin.path = [path = given.path](double t_s) { return along(path, &VectorKey::x, t_s); };
  return timed;
}

LoadedCloth load_cloth(const Scene& scene, std::size_t k, const TextSource& read) {
  const SceneCloth& cloth = scene.cloth[k];
  LoadedCloth loaded{mesh_cloth(cloth, path_of_cloth(k), read), {}, {}, {}, {}, {}};
  check_labels(cloth, loaded.garment, path_of_cloth(k));
  loaded.fabrics = fabrics_of(scene, k, loaded.garment.mesh);
  loaded.rest_stretch = rest_stretch_of(cloth, loaded.garment.mesh);
  if (!cloth.is_sewn()) loaded.pins = pins_of(scene, k, loaded.garment.x);
  for (const SceneDrag& given : cloth.drags) {
    TimedDrag drag;
    drag.near_m = given.near_m;
    drag.from_s = given.from_s;
    drag.to_s = given.to_s;
    drag.drag.target = [path = given.path](double t_s) { return along(path, &VectorKey::x, t_s); };
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
  if (scene.cloth.size() > 1)  // two garments may both have a "front"
    for (std::string& panel : loaded.garment.mesh.panel_names) panel.insert(0, loaded.garment.name + '/');
  return loaded;
}

Outfit outfit_of_shapes(std::span<const LoadedCloth> cloth) {
  Outfit outfit;
  for (const LoadedCloth& one : cloth) put_behind(outfit, one.garment, one.fabrics, one.rest_stretch);
  return outfit;
}

Events events_of(const Scene& scene, const Outfit& outfit, std::span<const LoadedCloth> cloth) {
  Events events;
  events.gravity = scene.gravity_path;
  events.wind = scene.wind_path;
  const auto friction = [&](const SceneCollider& collider, std::optional<Index> number) {
    if (!collider.friction_path.empty()) events.friction.push_back({number, collider.friction_path});
  };
  friction(scene.body, {});
  const Index first_solid = scene.body.exists() ? 1 : 0;
  for (std::size_t k = 0; k < scene.solids.size(); ++k) friction(scene.solids[k], first_solid + static_cast<Index>(k));
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
    for (TimedPanel panel : cloth[k].panels) {
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

double default_offset_m(const SceneCollider& collider, double edge_m) {
  constexpr double limb_m = 0.034;   // radius of a thin forearm
  constexpr double rim_share = 0.2;  // of an edge that lies over a rim
  const bool skin = collider.as<SceneMannequin>() != nullptr || (collider.worn && collider.is_person());
  return std::clamp(skin ? edge_m * edge_m / (8 * limb_m) : rim_share * edge_m, 1.5e-3, 2.5e-3);
}

OutfitRunOptions run_options(const Scene& scene, const StepOptions& step, std::function<bool()> stop) {
  OutfitRunOptions options;
  options.model.gravity_m_per_s2 = scene.gravity_path.empty() ? scene.gravity_m_per_s2 : scene.gravity_path.front().x;
  options.model.bend_element = scene.bend_element;
  options.model.paper_scaling = scene.paper_scaling;
  options.model.damping_jacobian = scene.damping_jacobian;
  options.model.pair_friction = scene.friction_between;
  options.air = scene.air;
  if (!scene.wind_path.empty()) options.air.wind_m_per_s = scene.wind_path.front().x;
  options.step = step;
  options.fps = scene.fps;
  options.step_max_s = scene.step_max_s;
  options.stop = std::move(stop);
  return options;
}

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
  step.body.offset_m = scene.body.contact.offset_m.value_or(default_offset_m(scene.body, edge_m));
  step.body.friction = scene.body.contact.friction;
  if (scene.body.exists()) step.body.colliders.emplace_back();
  for (const SceneCollider& solid : scene.solids) {
    ColliderContact& contact = step.body.colliders.emplace_back(solid.contact);
    if (!contact.offset_m && !scene.body.contact.offset_m) contact.offset_m = default_offset_m(solid, edge_m);
  }
  return step;
}

}  // namespace toile::internal
