// The claim of the paper's introduction: explicit steps must be tiny, implicit ones need not.                   [BW98 1]
#include "step/explicit_reference.hpp"

#include "support/run_cloth.hpp"

namespace toile::internal {
namespace {

using test::ClothRun;

Fabric undamped() {
  Fabric fabric = test::linear_cotton();
  fabric.stretch_damping_s = fabric.shear_damping_s = fabric.bend_damping_s = 0;
  return fabric;
}

TEST(ExplicitReference, StandsBelowTwoOverTheHighestFrequencyAndBlowsUpAbove) {
  for (const Fabric& fabric : {undamped(), Fabric{}}) {
    ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), fabric);
    run.state.x = test::crumpled(run.state.x, 1e-5, 3);
    ExplicitReference reference(run.model, {0, 10});
    const ExplicitLimit limit = reference.limit(run.state);
    std::printf("omega %.3g 1/s, gamma %.3g 1/s: explicit steps up to %.3g ms\n", limit.omega_per_s, limit.gamma_per_s,
                1e3 * limit.h_s);
    constexpr int steps = 1000;
    EXPECT_TRUE(reference.stands(run.state, 0.9 * limit.h_s, steps, ExplicitScheme::symplectic_euler));
    EXPECT_FALSE(reference.stands(run.state, 1.1 * limit.h_s, steps, ExplicitScheme::symplectic_euler));
    EXPECT_FALSE(reference.stands(run.state, 2.0 * limit.h_s, steps, ExplicitScheme::runge_kutta_4));
    // Ours takes the same cloth through the same fall at 1/30 s.
    run.pin(0);
    run.pin(10);
    run.run(30);
    EXPECT_GT(1.0 / 30, 100 * limit.h_s);
  }
}

TEST(ExplicitReference, ASpringsFrequencyIsFoundExactly) {
  // One triangle with shear off, held at two corners: the third swings along u against k_u area alpha^2 / m.
  ClothMesh mesh;
  mesh.particle_count = 3;
  mesh.triangles = {{0, 1, 2}};
  mesh.uv = {{Vec2(0, 0), Vec2(0.1, 0), Vec2(0, 0.1)}};
  mesh.panel = {0};
  mesh.panel_names = {"one"};
  Fabric fabric;
  fabric.shear_N_per_m = 0;
  const ClothModel model = build_model(mesh, {&fabric, 1});
  const ClothState state{{Vec3(0, 0, 0), Vec3(0.12, 0, 0), Vec3(0, 0, -0.1)}, Vec3s(3, Vec3::Zero())};
  ExplicitReference reference(model, {0, 2});
  const ExplicitLimit limit = reference.limit(state);
  const double omega2 = fabric.stretch_u_N_per_m * 0.005 / (0.1 * 0.1) / model.mass_kg[1];
  EXPECT_NEAR(limit.omega_per_s, std::sqrt(omega2), 1e-9 * limit.omega_per_s);
  EXPECT_NEAR(limit.gamma_per_s, fabric.stretch_damping_s * omega2, 1e-9 * limit.gamma_per_s);
}

TEST(ExplicitReference, RungeKuttaIsOfFourthOrderAndKeepsTheEnergy) {
  ClothRun run(test::equilateral_sheet(0.1, 0.1, 0.05), undamped());
  run.state.x = test::crumpled(run.state.x, 1e-3, 5);
  ExplicitReference reference(run.model, {0});
  const auto after = [&](int steps) {
    ClothState state = run.state;
    for (int k = 0; k < steps; ++k) reference.step(state, 0.01 / steps, ExplicitScheme::runge_kutta_4);
    return state;
  };
  const ClothState exact = after(8000);
  const auto error = [&](int steps) {
    const ClothState state = after(steps);
    double sum = 0;
    for (std::size_t i = 0; i < state.x.size(); ++i) sum += (state.x[i] - exact.x[i]).squaredNorm();
    return std::sqrt(sum);
  };
  EXPECT_NEAR(std::log2(error(500) / error(1000)), 4, 0.3);
  const double before = reference.energy_J(run.state);
  EXPECT_NEAR(reference.energy_J(exact), before, 1e-8 * std::abs(before));
}

}  // namespace
}  // namespace toile::internal
