// What a free cloth must keep, and what the step takes: energy with all dampings at zero, linear and angular momentum.
//
// One linear solve per step moves particles along tangents: a piece that turns by w h stretches by (w h)^2/2.  The energy of that
// stretch comes from nowhere, and its tension brakes the turn in the next step.  Both fade with the step, and are reported as what
// further Newton iterations have to remove.
#include <array>
#include <vector>

#include "support/run_cloth.hpp"
#include "validation/figures.hpp"

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Figures;

// A cloth of its own: figures of the integrator must not move with a preset.
Fabric undamped() {
  Fabric fabric = test::linear_cotton();
  fabric.shear_N_per_m = 200;
  fabric.stretch_damping_s = fabric.shear_damping_s = fabric.bend_damping_s = 0;
  return fabric;
}

ModelOptions weightless() {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  return options;
}

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // the latter about the centre of mass
};

Momenta momenta(const ClothRun& run) {
  Momenta sum;
  Vec3 centre = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < run.state.x.size(); ++i) {
    mass += run.model.mass_kg[i];
    centre += run.model.mass_kg[i] * run.state.x[i];
    sum.linear += run.model.mass_kg[i] * run.state.v[i];
  }
  centre /= mass;
  for (std::size_t i = 0; i < run.state.x.size(); ++i)
    sum.angular += run.model.mass_kg[i] * (run.state.x[i] - centre).cross(run.state.v[i]);
  return sum;
}

double energy(ClothRun& run, Elements& elements) {
  elements.evaluate(run.model, run.state);
  double sum = elements.energy_J();
  for (std::size_t i = 0; i < run.state.x.size(); ++i) {
    sum += 0.5 * run.model.mass_kg[i] * run.state.v[i].squaredNorm();
    sum -= run.model.mass_kg[i] * run.model.gravity_m_per_s2.dot(run.state.x[i]);
  }
  return sum;
}

// All rises of the energy from frame to frame, as a part of what is lost in the end.
double rises(ClothRun& run, int frames, double h_s) {
  Elements elements(run.model);
  double last = energy(run, elements), sum = 0;
  const double first = last;
  for (int f = 0; f < frames; ++f) {
    run.frame(h_s);
    const double now = energy(run, elements);
    sum += std::max(0.0, now - last);
    last = now;
  }
  EXPECT_LT(last, first);
  return sum / (first - last);
}

TEST(Conservation, EnergyNeverRisesWithoutDampingWhereAStepTurnsLittle) {
  // A sheet that falls from two corners has folds of 0.1 mm to begin with.  From an exactly flat one it is the solver's rounding
  // that picks the folds it buckles into, and the rises at h = 1/30 s are then anything from 0.43 to 1.5 of the loss.
  struct Case {
    const char* name;
    bool held;
    double folds_m;
    int newton_iterations;
    std::array<double, 3> bounds;  // for h = 1/30, 1/120, 1/480 s
  };
  const std::vector<Case> cases = {{"crumpled and free", false, 1e-3, 1, {1e-3, 1e-3, 1e-3}},
                                   {"falls from two corners", true, 1e-4, 1, {0.5, 0.1, 1e-3}},
                                   {"falls from two corners, 3 iterations", true, 1e-4, 3, {0.03, 1e-3, 1e-3}}};
  Figures figures("energy");
  for (const Case& of : cases) {
    int bound = 0;
    for (const int per_second : {30, 120, 480}) {
      const double h = 1.0 / per_second;
      ClothRun run(test::equilateral_sheet(of.held ? 0.3 : 0.2, of.held ? 0.3 : 0.2, 0.02), undamped(),
                   of.held ? ModelOptions{} : weightless());
      run.state.x = test::crumpled(run.state.x, of.folds_m, 6);
      if (of.held) run.pin(0), run.pin(15);
      run.step.rows.cloth_cloth = false;
      run.step.newton_iterations = of.newton_iterations;
      run.step.pcg.tolerance = 1e-6;  // the integrator's own: at 1e-3 what is left of the solve decides
      run.adaptive.step_max_s = h;
      const double part = rises(run, 2 * per_second, h);
      figures.add(of.name, "h = 1/" + std::to_string(per_second) + " s", "rises / loss", 0, part);
      EXPECT_LT(part, of.bounds[bound++]);
    }
  }
}

struct Change {
  double angular, linear;  // relative changes of the momenta in a second
};

Change after_a_second_of_turning(const Vec3& omega, double h_s) {
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), undamped(), weightless());
  run.step.rows.cloth_cloth = false;
  run.adaptive.step_max_s = h_s;
  const Vec3 middle(0.1, 0, -0.1), drift(0.3, 0.1, -0.2);
  for (std::size_t i = 0; i < run.state.x.size(); ++i) run.state.v[i] = drift + omega.cross(run.state.x[i] - middle);
  const Momenta before = momenta(run);
  run.run(static_cast<int>(std::lround(1 / h_s)), h_s);
  const Momenta after = momenta(run);
  return {(after.angular - before.angular).norm() / before.angular.norm(),
          (after.linear - before.linear).norm() / before.linear.norm()};
}

TEST(Conservation, AFreeSheetKeepsItsLinearMomentumAndLosesLessOfItsTurnInShorterSteps) {
  Figures figures("momentum");
  for (const double omega : {1.0, 5.0}) {
    double last = 1;
    for (const int per_second : {30, 60, 120, 240}) {
      const Change change = after_a_second_of_turning(Vec3(0, omega, 0), 1.0 / per_second);
      char what[32];
      std::snprintf(what, sizeof what, "turns at %g rad/s", omega);
      const std::string h = "h = 1/" + std::to_string(per_second) + " s";
      figures.add(what, h, "angular momentum lost in 1 s", 0, change.angular);
      figures.add(what, h, "linear momentum changed in 1 s", 0, change.linear);
      EXPECT_LT(change.linear, 1e-11);
      EXPECT_LT(change.angular, last);
      last = change.angular;
    }
  }
}

}  // namespace
}  // namespace toile::internal
