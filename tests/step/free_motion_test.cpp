// Motion without contact: what gravity, momentum and rigid motion demand of a solver that stops early.
#include "support/run_cloth.hpp"

namespace toile::internal {
namespace {

using test::ClothRun;

double fall_error(Preconditioner preconditioner, double crumple_m, PcgProcedure procedure = PcgProcedure::prefiltered) {
  ClothRun run(test::equilateral_sheet(0.5, 0.5, 0.02), Fabric{});
  run.step.pcg.preconditioner = preconditioner;
  run.step.pcg.tolerance = 1e-2;
  run.step.pcg.procedure = procedure;
  run.state.x = test::crumpled(run.state.x, crumple_m, 3);
  run.run(30);
  double mass = 0;
  Vec3 momentum = Vec3::Zero();
  for (std::size_t i = 0; i < run.state.v.size(); ++i) {
    mass += run.model.mass_kg[i];
    momentum += run.model.mass_kg[i] * run.state.v[i];
  }
  return (momentum / mass - Vec3(0, -9.81 * run.time_s, 0)).norm() / (9.81 * run.time_s);
}

TEST(FreeMotion, FreeFallIsNotBrakedByTheSolversTolerance) {
  for (const Preconditioner preconditioner : {Preconditioner::diagonal, Preconditioner::block_jacobi,
                                              Preconditioner::block_ssor, Preconditioner::block_ssor_coarse}) {
    EXPECT_LT(fall_error(preconditioner, 0), 1e-12) << to_string(preconditioner);
  }
}

TEST(FreeMotion, ThePrintedListingBrakesAFallBecauseItStartsAtZero) {
  const double error = fall_error(Preconditioner::diagonal, 0, PcgProcedure::paper_1998);
  std::printf("error of the fall with the listing of 1998: %.2g\n", error);
  EXPECT_GT(error, 1e-6);
  EXPECT_LT(error, 1e-3);
}

TEST(FreeMotion, TheCoarseSpaceLetsACrumpledSheetFallFreelyTooWhereOthersBrakeIt) {
  EXPECT_LT(fall_error(Preconditioner::block_ssor_coarse, 1e-4), 1e-6);
  EXPECT_GT(fall_error(Preconditioner::block_ssor, 1e-4), 1e-6);
}

TEST(FreeMotion, TwoPiecesOfOnePanelDoNotDriftApart) {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  test::Sheet sheets = test::stack(0.2, 0.02, 0.1, 2);
  std::fill(sheets.mesh.panel.begin(), sheets.mesh.panel.end(), 0);
  ClothRun run(sheets, Fabric{}, options);
  run.step.rows.cloth_cloth = false;
  run.step.pcg.tolerance = 1e-2;
  const std::size_t half = run.state.x.size() / 2;
  const Vec3s crumpled =
      test::crumpled(run.state.x, 5e-3, 3);  // the upper one; the lower one has nothing to do with it
  std::copy(crumpled.begin() + static_cast<std::ptrdiff_t>(half), crumpled.end(),
            run.state.x.begin() + static_cast<std::ptrdiff_t>(half));
  run.run(10);
  // Both in one aggregate: 0.37 m/s, in opposite directions.
  for (const bool upper : {false, true}) {
    Vec3 momentum = Vec3::Zero();
    double mass = 0;
    for (std::size_t i = upper ? half : 0; i < (upper ? 2 * half : half); ++i) {
      momentum += run.model.mass_kg[i] * run.state.v[i];
      mass += run.model.mass_kg[i];
    }
    EXPECT_LT((momentum / mass).norm(), 1e-5) << (upper ? "upper" : "lower");
  }
}

TEST(FreeMotion, ARigidTranslationKeepsItsVelocityExactly) {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  ClothRun run(test::equilateral_sheet(0.3, 0.3, 0.03), Fabric{}, options);
  run.state.v.assign(run.state.v.size(), Vec3(1.5, -0.25, 0.125));
  run.run(10);
  for (const Vec3& v : run.state.v) EXPECT_LT((v - Vec3(1.5, -0.25, 0.125)).norm(), 1e-12);
}

TEST(FreeMotion, LinearMomentumOfACrumpledFlyingSheetIsKept) {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  for (unsigned crumple = 4; crumple < 10; ++crumple) {
    ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), test::linear_cotton(), options);
    run.step.rows.cloth_cloth = false;
    run.state.x = test::crumpled(run.state.x, 0.003, crumple);
    test::Random random(crumple + 1);
    for (Vec3& v : run.state.v) v = Vec3(1, 0, 0) + random.vector(0.2);
    const auto momentum = [&] {
      Vec3 p = Vec3::Zero();
      for (std::size_t i = 0; i < run.state.v.size(); ++i) p += run.model.mass_kg[i] * run.state.v[i];
      return p;
    };
    const Vec3 before = momentum();
    run.run(60);
    EXPECT_LT((momentum() - before).norm(), 1e-11 * before.norm()) << "crumple " << crumple;
  }
}

TEST(FreeMotion, EnergyNeverRisesWithoutInput) {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  Fabric fabric;
  fabric.stretch_damping_s = fabric.shear_damping_s = fabric.bend_damping_s = 0;
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), fabric, options);
  run.step.rows.cloth_cloth = false;
  run.state.x = test::crumpled(run.state.x, 0.001, 6);
  Elements elements(run.model);
  const auto energy = [&] {
    elements.evaluate(run.model, run.state);
    double kinetic = 0;
    for (std::size_t i = 0; i < run.state.v.size(); ++i)
      kinetic += 0.5 * run.model.mass_kg[i] * run.state.v[i].squaredNorm();
    return kinetic + elements.energy_J();
  };
  double last = energy();
  const double first = last;
  for (int f = 0; f < 30; ++f) {
    run.frame();
    const double now = energy();
    EXPECT_LT(now, last + 1e-3 * first) << "frame " << f;
    last = now;
  }
  EXPECT_LT(last, 0.5 * first);
}

TEST(FreeMotion, DragBrakesARigidMotionAsBackwardEulerDoes) {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  options.drag_per_s = 2;
  ClothRun run(test::equilateral_sheet(0.1, 0.1, 0.02), Fabric{}, options);
  for (Vec3& v : run.state.v) v = Vec3(0.3, -0.2, 0.1);
  const FrameReport report = run.frame();
  const double slower = 1 / (1 + 2 * report.last.h_s);  // M (1 + h d) dv = -h d M v, in each of the frame's steps
  for (const Vec3& v : run.state.v) {
    EXPECT_LT((v - std::pow(slower, report.steps) * Vec3(0.3, -0.2, 0.1)).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace toile::internal
