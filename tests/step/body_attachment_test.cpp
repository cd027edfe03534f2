// A point that a body carries: it keeps its place in the frame of its triangle.
#include "step/body_attachment.hpp"
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace toile::internal {
namespace {

TEST(BodyAttachment, GoesWhereARigidBodyTakesIt) {
  BodySurface ball = test::sphere(Vec3(0.1, 0.2, 0.3), 0.1, 3);
  const Vec3s start(ball.positions().begin(), ball.positions().end());
  for (const Vec3& x : {Vec3(0.1, 0.31, 0.3), Vec3(0.23, 0.2, 0.3), Vec3(0.05, 0.15, 0.22), Vec3(0.1, 0.25, 0.3)}) {
    ball.set_motion(start, start);
    const BodyAttachment attachment = attach(ball, x);
    EXPECT_LT((carried(attachment, ball) - x).norm(), 1e-12);
    const Mat3 turn = Eigen::AngleAxisd(1.3, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    const Vec3 shift(0.4, -0.2, 0.1);
    Vec3s end = start;
    for (Vec3& p : end) p = turn * p + shift;
    ball.set_motion(start, end);
    EXPECT_LT((carried(attachment, ball) - (turn * x + shift)).norm(), 1e-12);
  }
}

TEST(BodyAttachment, IsToTheNearestPointWhereTheBodyIsAtTheEndOfItsStep) {
  BodySurface ball = test::sphere(Vec3::Zero(), 0.1, 3);
  const Vec3s start(ball.positions().begin(), ball.positions().end());
  Vec3s end = start;
  for (Vec3& p : end) p.x() += 1;
  ball.set_motion(start, end);
  const BodyAttachment attachment = attach(ball, Vec3(1, 0.12, 0));
  Vec3 on_surface = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    on_surface +=
        attachment.barycentric[static_cast<Eigen::Index>(k)] * start[at(ball.triangle(attachment.triangle)[k])];
  EXPECT_NEAR(on_surface.y(), 0.1, 1e-3);
  EXPECT_LT(Vec2(on_surface.x(), on_surface.z()).norm(), 0.01);
}

// A sheet that is glued to a turning ball by one corner hangs from it, wherever the ball takes that.
TEST(BodyAttachment, APinOnTheBodyIsMetToTheBit) {
  BodySurface ball = test::sphere(Vec3(0, 0.1, 0), 0.1, 3);
  const Vec3s start(ball.positions().begin(), ball.positions().end());
  const auto turned = [&](double t_s, std::span<Vec3> x) {
    const Mat3 turn = Eigen::AngleAxisd(2 * t_s, Vec3::UnitX()).toRotationMatrix();
    for (std::size_t i = 0; i < start.size(); ++i) x[i] = turn * (start[i] - Vec3(0, 0.1, 0)) + Vec3(0, 0.1, 0);
  };
  test::Sheet sheet = test::equilateral_sheet(0.1, 0.1, 0.02);
  const Vec3 corner(0, 0.1, 0.103);
  const Vec3 shift = corner - sheet.x[0];
  for (Vec3& p : sheet.x) p += shift;
  test::ClothRun run(sheet, Fabric{});
  run.world.body = &ball;
  run.world.body_at = turned;
  Pin pin;
  pin.particle = 0;
  pin.on_body = attach(ball, run.state.x[0]);
  run.world.pins = {pin};
  run.run(30);
  const Mat3 turn = Eigen::AngleAxisd(2 * run.time_s, Vec3::UnitX()).toRotationMatrix();
  EXPECT_LT((run.state.x[0] - (turn * (corner - Vec3(0, 0.1, 0)) + Vec3(0, 0.1, 0))).norm(), 1e-9);
}

}  // namespace
}  // namespace toile::internal
