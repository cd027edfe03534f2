// Position alteration inside the solve against a jump after it.                                            [BW98 6.2]
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;

const double offset = BodyContactOptions{}.offset_m;

struct Unrest {
  double stretch = 0;  // largest | |w| - 1 | of any triangle at the end of any step
  double jitter = 0;   // rms change of |w| from step to step, over triangles near the body and steps
  double injected_J = 0;
};

// An unstrained, weightless sheet that stands on a slab, its lower edge `deep_m` deeper than the offset.
Unrest push_out(PositionAlteration alteration, double deep_m) {
  BodySurface slab = test::tilted_slab(1, 0.2, 0);
  Sheet sheet = test::equilateral_sheet(0.2, 0.2, 0.02);
  for (Vec3& p : sheet.x) p = Vec3(p.x() - 0.1, offset - deep_m - p.z(), 0);
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  ClothRun run(sheet, test::linear_cotton(), weightless);
  run.world.body = &slab;
  run.step.position_alteration = alteration;
  run.adaptive.step_max_s = 1.0 / 60;
  Unrest unrest;
  std::vector<Vec2> w(run.model.mesh.triangles.size(), Vec2::Ones()), before;
  Elements elements(run.model);
  double sum = 0;
  constexpr int steps = 10;
  for (int k = 0; k < steps; ++k) {
    const FrameReport report = run.frame(1.0 / 60);
    EXPECT_EQ(report.steps, 1);
    before = w;
    elements.evaluate(run.model, run.state);
    elements.stretch(run.state.x, w);
    unrest.injected_J = std::max(unrest.injected_J, elements.energy_J());
    for (std::size_t t = 0; t < w.size(); ++t) {
      unrest.stretch = std::max(unrest.stretch, (w[t] - Vec2::Ones()).cwiseAbs().maxCoeff());
      sum += (w[t] - before[t]).squaredNorm();
    }
  }
  unrest.jitter = std::sqrt(sum / (steps * static_cast<double>(w.size())));
  return unrest;
}

TEST(PositionAlteration, InTheSolveStretchesNeighboursAndJittersLessThanAJumpAfterIt) {
  for (const double deep : {0.3e-3, 0.5e-3, 1e-3}) {
    const Unrest in = push_out(PositionAlteration::in_solve, deep),
                 after = push_out(PositionAlteration::after_solve, deep);
    std::printf(
        "%.1f mm deep: stretch %.2f %% in the solve, %.2f %% after it; jitter %.4f and %.4f %%; %.2g and %.2g mJ\n",
        1e3 * deep, 1e2 * in.stretch, 1e2 * after.stretch, 1e2 * in.jitter, 1e2 * after.jitter, 1e3 * in.injected_J,
        1e3 * after.injected_J);
    EXPECT_LT(5 * in.stretch, after.stretch);
    EXPECT_LT(5 * in.jitter, after.jitter);
    EXPECT_LT(25 * in.injected_J, after.injected_J);
  }
}

TEST(PositionAlteration, BothEndAtTheOffset) {
  for (const PositionAlteration alteration : {PositionAlteration::in_solve, PositionAlteration::after_solve}) {
    BodySurface slab = test::tilted_slab(1, 0.2, 0);
    Sheet sheet = test::equilateral_sheet(0.1, 0.1, 0.02);
    for (Vec3& p : sheet.x) p += Vec3(-0.05, offset - 1e-3, 0.05);
    ClothRun run(sheet, Fabric{});
    run.world.body = &slab;
    run.step.position_alteration = alteration;
    run.run(5);
    for (const Vec3& p : run.state.x) EXPECT_NEAR(p.y(), offset, 0.05 * offset);
    EXPECT_LT(run.fastest(), 1e-3);
  }
}

}  // namespace
}  // namespace toile::internal
