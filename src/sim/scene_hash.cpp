// sim/scene_hash.cpp: every number of a scene that changes the result.
#include "sim/setup.hpp"

#include <string_view>
#include <variant>

namespace toile {
namespace {

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
                         f.compression_ratio, f.strain_limit, f.bend_u_N_m, f.bend_v_N_m, f.stretch_damping_s,
                         f.shear_damping_s, f.bend_damping_s, f.friction, f.thickness_m})
    add(hash, x);
}

void add(Hash& hash, const RigidPath& moves) {
  add(hash, static_cast<double>(moves.keys().size()));
  add(hash, moves.centre());
  for (const RigidKey& key : moves.keys()) {
    add(hash, key.t_s);
    add(hash, key.shift_m);
    add(hash, key.rotation_deg);
    add(hash, key.scale);
  }
}
void add(Hash& hash, const SceneRibbon& ribbon) {
  for (const double x : {ribbon.width_m, ribbon.edge_m, ribbon.closed ? 1.0 : 0.0}) add(hash, x);
  for (const Vec3& p : ribbon.path_m) add(hash, p);
  add(hash, ribbon.across);
}
void add(Hash& hash, const SceneSolid& solid) {
  struct Add {
    Hash& hash;
    void operator()(const SceneSolid::Sphere& sphere) const { add(hash, sphere.radius_m); }
    void operator()(const SceneSolid::Box& box) const { add(hash, box.size_m); }
    void operator()(const SceneSolid::Revolved& revolved) const {
      for (const Vec2& p : revolved.profile_m)
        for (const double x : {p.x(), p.y()}) add(hash, x);
    }
    void operator()(const SceneSolid::Mesh&) const {}  // its bytes count
  };
  add(hash, static_cast<double>(solid.shape.index()));
  std::visit(Add{hash}, solid.shape);
  add(hash, solid.edge_m);
  add(hash, solid.inside_out ? 1.0 : 0.0);
  add(hash, solid.translation_m);
  add(hash, solid.rotation_deg);
  add(hash, solid.moves);
}

}  // namespace

void add_to_hash(const Scene& scene, Hash& hash) {
  for (const SceneCloth& cloth : scene.cloth) {
    if (cloth.grid)
      for (const double x : {cloth.grid->width_m, cloth.grid->height_m, cloth.grid->edge_m}) add(hash, x);
    if (cloth.tube)
      for (const double x : {cloth.tube->radius_m, cloth.tube->length_m, cloth.tube->edge_m}) add(hash, x);
    if (cloth.ribbon) add(hash, *cloth.ribbon);
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
      if (pin.in_box_m)
        for (const Vec3& corner : *pin.in_box_m) add(hash, corner);
      add(hash, pin.moves);
      add(hash, pin.from_s);
      add(hash, pin.to_s);
      for (const ScenePin::Key& key : pin.path) {
        add(hash, key.t_s);
        add(hash, key.x_m);
      }
    }
  }
  for (const SceneSolid& solid : scene.solids) add(hash, solid);
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
  if (!scene.flypaper) add(hash, 2.0);
}

}  // namespace toile
