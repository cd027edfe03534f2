#include "bench_probe.hpp"

#include "sim/setup.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace toile::internal {
namespace {

ClothModel of_fabric(const ClothModel& model, const Fabric& fabric) {
  ModelOptions options;
  options.gravity_m_per_s2 = model.gravity_m_per_s2;
  options.damping_jacobian = model.damping_jacobian;
  return build_model(model.mesh, std::array{fabric}, options);
}

}  // namespace

Drape::Drape(const Scene& scene) : scene_(scene) {
  std::vector<LoadedCloth> shapes;
  double edge_m = 0;
  for (std::size_t k = 0; k < scene_.cloth.size(); ++k) {
    shapes.push_back(load_cloth(scene_, k, read_text_file));
    edge_m = std::max(edge_m, shapes.back().edge_m);
  }
  JoinedColliders joined = load_colliders(scene_.body, scene_.solids).joined;
  if (!joined.surface.positions.empty())
    body_.emplace(std::move(joined.surface.positions), std::move(joined.surface.triangles),
                  std::move(joined.vertex_collider));
  outfit_ = outfit_of_shapes(shapes);
  step_ = step_options(scene_, edge_m);
  run_.emplace(run_options(scene_, step_), outfit_, body());
  run_->set_events(events_of(scene_, outfit_, shapes));
}

bool Drape::advance(int frames) {
  for (int k = 0; k < frames; ++k)
    if (!run_->frame().ok) return false;
  return true;
}

StepSystem::StepSystem(Drape& drape, double h_s, const Fabric& fabric)
    : StepSystem(drape, h_s, of_fabric(drape.model(), fabric)) {}

StepSystem::StepSystem(Drape& drape, double h_s, ClothModel model)
    : state_(&drape.state()),
      h_s_(h_s),
      model_(std::move(model)),
      elements_(model_),
      A_(elements_.pattern()),
      system_(A_),
      pcg_(model_.mesh),
      constraints_(model_.particle_count()),
      y_(state_->x.size(), Vec3::Zero()),
      landing_(y_),
      b_(y_),
      reference_(y_) {
  find_contacts(drape);
  assemble();
}

void StepSystem::find_contacts(Drape& drape) {
  StepWorld world;  // without forces: their part of the matrix is not measured
  world.body = drape.body();
  world.pins.assign(drape.pins().begin(), drape.pins().end());
  ImplicitEuler integrator(drape.model(), world, drape.step());
  integrator.prepare(*state_, 0, h_s_, h_s_);
  StepLimits limits;
  limits.stretch = std::numeric_limits<double>::infinity();
  ClothState candidate;
  // The step need not be accepted: the active set is found either way.
  (void)integrator.attempt(*state_, 0, h_s_, limits, candidate);
  for (const Pin& pin : world.pins) constraints_.hold(pin.particle, -state_->v[static_cast<std::size_t>(pin.particle)]);
  integrator.body_constraints().apply(*state_, h_s_, constraints_, y_, landing_, springs_);
  integrator.contact_rows().append_springs(springs_);
}

void StepSystem::assemble() {
  for (Index i = 0; i < A_.rows(); ++i) A_.grounded(i) = model_.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
  elements_.evaluate(model_, *state_);
  elements_.assemble(h_s_, A_);
  elements_.forces(b_);
  Vec3s displacement(b_.size());
  for (std::size_t i = 0; i < b_.size(); ++i) {
    b_[i] += model_.mass_kg[i] * model_.gravity_m_per_s2;
    reference_[i] = (h_s_ * model_.mass_kg[i]) * model_.gravity_m_per_s2;
    displacement[i] = h_s_ * state_->v[i] + y_[i];
    landing_[i] /= h_s_;
  }
  elements_.subtract_stiffness(displacement, landing_, b_);
  for (Vec3& b : b_) b *= h_s_;
  rows_.clear();
  for (const LinearSpring& spring : springs_) {
    rows_.push_back(implicit_row(spring, h_s_, state_->v, y_));
    const ImplicitRow& row = rows_.back();
    for (std::size_t k = 0; k < 4; ++k) {
      if (row.particle[k] >= 0)
        b_[static_cast<std::size_t>(row.particle[k])] += (row.beta * row.weight[k]) * row.direction;
    }
  }
  system_.update(rows_, constraints_);
}

PcgReport StepSystem::solve(const PcgOptions& options, std::span<const Vec3> b) {
  prepare(options);
  return solve_prepared(options, b);
}

PcgReport StepSystem::solve_prepared(const PcgOptions& options, std::span<const Vec3> b) {
  Vec3s dv(b.size(), Vec3::Zero());
  return pcg_.solve(system_, b, reference_, options, dv);
}

}  // namespace toile::internal
