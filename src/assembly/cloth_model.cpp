#include "assembly/cloth_model.hpp"

#include "assembly/finished_edges.hpp"
#include "assembly/line_moments.hpp"
#include "assembly/plate_moments.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

// uv of the hinge's edge, seen from one of its triangles: x1 - x0.
Vec2 edge_in_pattern(const ClothMesh& mesh, Index triangle, Index x0, Index x1) {
  const auto t = static_cast<std::size_t>(triangle);
  Vec2 ends[2] = {Vec2::Zero(), Vec2::Zero()};
  for (std::size_t c = 0; c < 3; ++c) {
    if (mesh.triangles[t][c] == x0) ends[0] = mesh.uv[t][c];
    if (mesh.triangles[t][c] == x1) ends[1] = mesh.uv[t][c];
  }
  return ends[1] - ends[0];
}

BendRest hinge_rest(const ClothModel& model, std::span<const Fabric> fabrics, const Hinge& hinge, bool plates,
                    bool paper_scaling) {
  double rigidity = 0, tau = 0, length = 0, area[2];
  for (int side = 0; side < 2; ++side) {
    const auto t = static_cast<std::size_t>(hinge.triangle[static_cast<std::size_t>(side)]);
    const Fabric& fabric = fabric_of(model.mesh, fabrics, t);
    const Vec2 along = edge_in_pattern(model.mesh, hinge.triangle[static_cast<std::size_t>(side)], hinge.particle[0],
                                       hinge.particle[1]);
    // The paper weighs by the edge's own direction; the fibres that bend run across it (docs/deviations.md#bend-direction).
    rigidity += 0.5 * (paper_scaling ? paper_bend_stiffness(along, fabric.bend_u_N_m, fabric.bend_v_N_m)
                                     : hinge_rigidity({-along.y(), along.x()}, fabric.bend_u_N_m, fabric.bend_v_N_m));
    tau += 0.5 * fabric.bend_damping_s;
    length += 0.5 * along.norm();
    area[side] = material_frame(model.mesh.uv[t]).area_m2;
  }
  BendRest rest;
  if (!plates) rest.kappa_N_m = paper_scaling ? rigidity : rigidity * bend_weight(length, area[0], area[1]);
  rest.tau_s = tau;
  if (!paper_scaling) rest.least_normal2 = least_normal2(area[0], area[1]);
  return rest;
}

// A number per fabric name, in the order of first use; and the friction of each pair.
void set_pair_friction(ClothModel& model, std::span<const Fabric> fabrics, const std::vector<PairFriction>& pairs) {
  std::vector<std::string_view> names;
  const auto number = [&](std::string_view name) {
    const auto place = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (place == names.size()) names.push_back(name);
    return static_cast<Index>(place);
  };
  model.fabric.assign(static_cast<std::size_t>(model.mesh.particle_count), -1);
  for (std::size_t t = 0; t < model.mesh.triangles.size(); ++t) {
    const Fabric& fabric = fabric_of(model.mesh, fabrics, t);
    for (const Index corner : model.mesh.triangles[t]) {
      Index& of = model.fabric[static_cast<std::size_t>(corner)];
      if (of < 0) of = number(fabric.name);
    }
  }
  if (pairs.empty()) return;
  model.pair_friction.assign(names.size(), std::vector<double>(names.size(), -1));
  for (const PairFriction& pair : pairs) {
    const auto place = [&](std::string_view name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    const std::size_t first = place(pair.first), second = place(pair.second);
    if (first == names.size() || second == names.size()) continue;  // not in this cloth
    model.pair_friction[first][second] = model.pair_friction[second][first] = pair.friction;
  }
}

void check_rest_stretch(const Vec2& b) {
  if (b.allFinite() && b.minCoeff() > 0) return;
  throw InputError("cloth", "rest stretch", "two numbers above zero",
                   std::to_string(b.x()) + ", " + std::to_string(b.y()));
}

}  // namespace

const Fabric& fabric_of(const ClothMesh& mesh, std::span<const Fabric> fabric_of_panel, std::size_t triangle) {
  return fabric_of_panel[fabric_of_panel.size() == 1 ? 0 : at(mesh.panel[triangle])];
}

void set_plate_bounds(ClothModel& model) {
  if (!model.plate_compliance.empty()) {
    const std::vector<double> bounds = plate_bounds_N_m(model.topology, model.plate_compliance);
    for (std::size_t h = 0; h < bounds.size(); ++h) model.bend[h].plate_N_m = bounds[h];
  } else {
    for (BendRest& rest : model.bend) rest.plate_N_m = 0;
  }
  add_line_bounds(model);
}

ClothModel build_model(ClothMesh mesh, std::span<const Fabric> fabrics, const ModelOptions& options) {
  ClothModel model;
  model.gravity_m_per_s2 = options.gravity_m_per_s2;
  model.damping_jacobian = options.damping_jacobian;
  model.drag_per_s = options.drag_per_s;
  model.topology = build_topology(mesh.particle_count, mesh.triangles);
  model.mesh = std::move(mesh);

  const auto particles = static_cast<std::size_t>(model.mesh.particle_count);
  const std::size_t triangles = model.mesh.triangles.size();
  model.mass_kg.assign(particles, 0);
  model.thickness_m.assign(particles, 0);
  model.friction.assign(particles, 0);
  model.membrane.resize(triangles);
  const bool threads_buckle = options.threads_buckle && !options.paper_scaling;  // the paper's cloth does not
  for (const Fabric& fabric : fabrics)
    model.stiffness.push_back(
        {.k_u = fabric.stretch_u_N_per_m,
         .k_v = fabric.stretch_v_N_per_m,
         .k_shear = fabric.shear_N_per_m,
         .tau_stretch = fabric.stretch_damping_s,
         .tau_shear = fabric.shear_damping_s,
         .compression = fabric.compression_ratio,
         .strain_limit = fabric.strain_limit,
         .doubling_u = fabric.doubling_strain_u,
         .doubling_v = fabric.doubling_strain_v,
         .bend = threads_buckle && fabric.compression_ratio < 1 ? 0.5 * (fabric.bend_u_N_m + fabric.bend_v_N_m) : 0});
  for (std::size_t t = 0; t < triangles; ++t) {
    const Fabric& fabric = fabric_of(model.mesh, fabrics, t);
    const MaterialFrame frame = material_frame(model.mesh.uv[t]);
    model.membrane[t].alpha = frame.alpha;
    model.membrane[t].beta = frame.beta;
    model.membrane[t].scale2 = options.paper_scaling ? frame.area_m2 * frame.area_m2 : frame.area_m2;
    for (const Index corner : model.mesh.triangles[t]) {
      const auto p = static_cast<std::size_t>(corner);
      model.mass_kg[p] += fabric.density_kg_per_m2 * frame.area_m2 / 3;
      model.thickness_m[p] = std::max(model.thickness_m[p], fabric.thickness_m);
      model.friction[p] = std::max(model.friction[p], fabric.friction);
    }
  }
  const bool plates = options.bend_element == BendElement::plate && !options.paper_scaling;
  if (plates) {
    std::vector<Mat3> rigidity;
    for (const Fabric& fabric : fabrics) rigidity.push_back(bending_rigidity(fabric));
    for (std::size_t t = 0; t < triangles; ++t)
      model.plate_compliance.push_back(
          plate_compliance(model.mesh.uv[t], rigidity[rigidity.size() == 1 ? 0 : at(model.mesh.panel[t])]));
  }
  if (plates && std::any_of(fabrics.begin(), fabrics.end(), [](const Fabric& f) { return bend_hysteresis(f).any(); }))
    for (const Fabric& fabric : fabrics) model.hysteresis.push_back(bend_hysteresis(fabric));
  if (!options.paper_scaling) finish_edges(model, fabrics, plates);
  model.bend.reserve(model.topology.hinges.size());
  for (const Hinge& hinge : model.topology.hinges) {
    model.bend.push_back(hinge_rest(model, fabrics, hinge, plates, options.paper_scaling));
  }
  set_plate_bounds(model);
  set_folds(model, 1);
  set_gathers(model, 1);
  set_pair_friction(model, fabrics, options.pair_friction);
  return model;
}

double ClothModel::friction_between(Index i, Index j, double usual) const {
  if (pair_friction.empty()) return usual;
  const auto of = [&](Index particle) { return static_cast<std::size_t>(fabric[static_cast<std::size_t>(particle)]); };
  const double own = pair_friction[of(i)][of(j)];
  return own < 0 ? usual : own;
}

void set_folds(ClothModel& model, double share) {
  const std::vector<Hinge>& hinges = model.topology.hinges;  // sorted by edge
  const auto edge_of = [](const Hinge& h) {
    return std::pair(std::min(h.particle[0], h.particle[1]), std::max(h.particle[0], h.particle[1]));
  };
  for (const FoldedEdge& fold : model.mesh.folds) {
    const std::pair edge(std::min(fold.a, fold.b), std::max(fold.a, fold.b));
    const auto hinge = std::lower_bound(hinges.begin(), hinges.end(), edge,
                                        [&](const Hinge& h, const auto& wanted) { return edge_of(h) < wanted; });
    if (hinge != hinges.end() && edge_of(*hinge) == edge)
      model.bend[static_cast<std::size_t>(hinge - hinges.begin())].theta_0 = share * fold.angle_rad;
  }
}

void set_finishes(ClothModel& model, double share) {
  if (model.threads.empty() || model.finished == share) return;
  model.finished = share;
  ++model.rest_version;
}

void set_stiffening(ClothModel& model, double share) {
  if (model.stiffened == share) return;
  model.stiffened = share;
  const auto is_curved = [](const MembraneStiffness& k) { return k.doubling_u > 0 || k.doubling_v > 0; };
  if (std::any_of(model.stiffness.begin(), model.stiffness.end(), is_curved)) ++model.rest_version;
}

std::array<Vec2, 3> ClothModel::rest_uv(std::size_t triangle) const {
  std::array<Vec2, 3> uv = mesh.uv[triangle];
  if (mesh.gathered_uv.empty()) return uv;
  for (std::size_t k = 0; k < 3; ++k) uv[k] += gathered * (mesh.gathered_uv[triangle][k] - uv[k]);
  return uv;
}

void set_gathers(ClothModel& model, double share) {
  const ClothMesh& mesh = model.mesh;
  if (mesh.gathered_uv.empty()) return;
  model.gathered = share;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.gathered_uv[t] == mesh.uv[t]) continue;
    const MaterialFrame frame = material_frame(model.rest_uv(t));
    model.membrane[t].alpha = frame.alpha;
    model.membrane[t].beta = frame.beta;
  }
  ++model.rest_version;
}

void set_rest_stretch(ClothModel& model, Index triangle, const Vec2& b) {
  if (triangle < 0 || static_cast<std::size_t>(triangle) >= model.membrane.size())
    throw InputError("cloth", "rest stretch", "a triangle below " + std::to_string(model.membrane.size()),
                     std::to_string(triangle));
  check_rest_stretch(b);
  MembraneRest& rest = model.membrane[static_cast<std::size_t>(triangle)];
  rest.b_u = b.x();
  rest.b_v = b.y();
  ++model.rest_version;
}

void set_panel_rest_stretch(ClothModel& model, Index panel, const Vec2& b) {
  if (panel < 0 || static_cast<std::size_t>(panel) >= model.mesh.panel_names.size())
    throw InputError("cloth", "rest stretch", "a panel below " + std::to_string(model.mesh.panel_names.size()),
                     std::to_string(panel));
  check_rest_stretch(b);
  for (std::size_t t = 0; t < model.membrane.size(); ++t) {
    if (model.mesh.panel[t] == panel) {
      model.membrane[t].b_u = b.x();
      model.membrane[t].b_v = b.y();
    }
  }
  ++model.rest_version;
}

namespace {

void keep_as_built(ClothModel& model) {
  if (!model.stiffness_share.empty()) return;
  const std::size_t panels = model.mesh.panel_names.size();
  model.stiffness_share.resize(panels);
  if (model.stiffness.size() == 1) model.stiffness.resize(panels, model.stiffness.front());
  model.built_stiffness = model.stiffness;
  for (const BendRest& bend : model.bend) model.built_kappa_N_m.push_back(bend.kappa_N_m);
  model.built_compliance = model.plate_compliance;
}

}  // namespace

void set_panel_stiffness(ClothModel& model, Index panel, const StiffnessShare& share) {
  if (panel < 0 || at(panel) >= model.mesh.panel_names.size())
    throw InputError("cloth", "stiffness", "a panel below " + std::to_string(model.mesh.panel_names.size()),
                     std::to_string(panel));
  for (const double part : {share.stretch, share.shear, share.bend})
    if (!(part > 0 && std::isfinite(part)))
      throw InputError("cloth", "stiffness", "shares above zero", std::to_string(part));
  keep_as_built(model);
  model.stiffness_share[at(panel)] = share;
  const MembraneStiffness& built = model.built_stiffness[at(panel)];
  MembraneStiffness& now = model.stiffness[at(panel)];
  now.k_u = share.stretch * built.k_u;
  now.k_v = share.stretch * built.k_v;
  now.k_shear = share.shear * built.k_shear;
  now.bend = share.bend * built.bend;
  const auto bend_of = [&](Index triangle) { return model.stiffness_share[at(model.mesh.panel[at(triangle)])].bend; };
  for (std::size_t h = 0; h < model.bend.size(); ++h) {
    const auto& [a, b] = model.topology.hinges[h].triangle;
    model.bend[h].kappa_N_m = 0.5 * (bend_of(a) + bend_of(b)) * model.built_kappa_N_m[h];
  }
  for (std::size_t t = 0; t < model.plate_compliance.size(); ++t)
    model.plate_compliance[t] = model.built_compliance[t] / bend_of(static_cast<Index>(t));
  set_plate_bounds(model);
  ++model.rest_version;
}

}  // namespace toile::internal
