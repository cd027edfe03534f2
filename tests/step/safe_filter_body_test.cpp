// The safe filter between cloth and body: what is shot at a sheet does not pass it, and what is through may leave.
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

using test::ClothRun;

// A sheet of coarse triangles and a fine ball that is shot at it, hitting between its vertices.
struct Ball {
  Ball()
      : body(test::sphere(Vec3(0.1, -0.06, -0.09), 0.03, 3)), run(test::equilateral_sheet(0.2, 0.2, 0.05), Fabric{}) {
    const Vec3s start(body.positions().begin(), body.positions().end());
    run.world.body = &body;
    run.world.body_at = [start](double t_s, std::span<Vec3> x) {
      for (std::size_t i = 0; i < start.size(); ++i) x[i] = start[i] + Vec3(0, 6 * t_s, 0);
    };
  }
  // The most particles next to where the sheet is through the ball, in any frame.
  long through(int frames) {
    const Topology topology = build_topology(run.model.mesh.particle_count, run.model.mesh.triangles);
    const ClothTopology cloth(run.state.x.size(), run.model.mesh.triangles, topology);
    TriangleTree tree(run.state.x, run.model.mesh.triangles);
    BodyImpactWorkspace workspace;
    std::vector<char> marked;
    long most = 0;
    for (int f = 0; f < frames; ++f) {
      run.frame(1.0 / 60);
      Vec3s now;
      run.world.body_at(run.time_s, body.next_positions(), now);
      body.set_motion(now, now);
      (void)mark_through_body(cloth, tree, run.state.x, body, workspace, marked);
      most = std::max(most, static_cast<long>(std::count(marked.begin(), marked.end(), 1)));
    }
    return most;
  }
  BodySurface body;
  ClothRun run;
};

TEST(SafeFilterBody, AFastBallDoesNotPassThroughASheet) {
  Ball guarded, open;
  open.run.step.guard_body = open.run.step.rows.cloth_cloth = false;
  open.run.step.rows.body_share = 0;
  EXPECT_EQ(guarded.through(12), 0);
  EXPECT_GT(open.through(12), 0) << "without the filter it would";
}

TEST(SafeFilterBody, ClothGoesIntoABodyThatPinchesNothingOnlyWhereAllMayPierce) {
  // A sheet that is held everywhere, and a ball that is led through it.
  Ball ball;
  for (Index i = 0; i < ball.run.model.particle_count(); ++i) ball.run.pin(i);
  ball.run.start();
  ImplicitEuler& euler = ball.run.stepper->integrator();
  const double h = 1.0 / 60;
  euler.prepare(ball.run.state, 0, h, h);
  ClothState candidate;
  using Pierce = StepLimits::Pierce;
  const auto attempt = [&](Pierce pierce) {
    return euler.attempt(ball.run.state, 0, h, {1e9, true, pierce}, candidate);
  };
  EXPECT_EQ(attempt(Pierce::nothing).status, StepStatus::passed_through);
  EXPECT_EQ(attempt(Pierce::pinched).status, StepStatus::passed_through);
  const StepReport report = attempt(Pierce::all);
  EXPECT_TRUE(report) << report.explain();
  EXPECT_GT(report.filter.body_left, 0);
}

TEST(SafeFilterBody, WhatIsThroughAtTheStartMayLeave) {
  BodySurface body = test::sphere(Vec3(0.1, -0.045, -0.1), 0.05, 3);  // 5 mm of it above the sheet
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  run.world.body = &body;
  run.run(30);
  const Topology topology = build_topology(run.model.mesh.particle_count, run.model.mesh.triangles);
  const ClothTopology cloth(run.state.x.size(), run.model.mesh.triangles, topology);
  BodyImpactWorkspace workspace;
  std::vector<char> marked;
  TriangleTree tree(run.state.x, run.model.mesh.triangles);
  EXPECT_FALSE(mark_through_body(cloth, tree, run.state.x, body, workspace, marked));
}

}  // namespace
}  // namespace toile::internal
