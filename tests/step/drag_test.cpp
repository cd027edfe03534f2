// What the user does to a cloth while it runs: pull it, take hold of it, let it go.
#include "support/run_cloth.hpp"

#include <limits>

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;

constexpr double gravity = 9.81;

double mass(const ClothRun& run) {
  double sum = 0;
  for (const double m : run.model.mass_kg) sum += m;
  return sum;
}
Vec3 momentum(const ClothRun& run) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < run.state.v.size(); ++i) sum += run.model.mass_kg[i] * run.state.v[i];
  return sum;
}

// A point within a triangle in the middle of the cloth.
Drag grip(const ClothRun& run) {
  const Triangle& t = run.model.mesh.triangles[run.model.mesh.triangles.size() / 2];
  Drag drag;
  drag.particle = {t[0], t[1], t[2]};
  drag.weight = {0.5, 0.3, 0.2};
  return drag;
}
Vec3 point(const Drag& drag, const Vec3s& x) {
  Vec3 p = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) p += drag.weight[k] * x[static_cast<std::size_t>(drag.particle[k])];
  return p;
}

TEST(Drag, AClothHangsFromItsSpringWhereTheSpringCarriesItsWeight) {
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  Drag drag = grip(run);
  const Vec3 hand = point(drag, run.state.x);
  drag.target = [hand](double) { return hand; };
  drag.stiffness_N_per_m = 5;
  drag.max_force_N = std::numeric_limits<double>::infinity();
  drag.damping_N_s_per_m = 0.2;
  run.world.drags.push_back(drag);
  run.run(120);
  const Vec3 below = hand - point(drag, run.state.x);
  EXPECT_LT((below - Vec3(0, mass(run) * gravity / 5, 0)).norm(), 2e-4);
}

TEST(Drag, AMovingHandIsFollowedWithoutLag) {
  // At constant speed the spring carries the weight and nothing else: its damping counts the hand's velocity.
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  Drag drag = grip(run);
  const Vec3 hand = point(drag, run.state.x), speed(0.7, 0.2, -0.3);
  drag.target = [hand, speed](double t_s) -> Vec3 { return hand + t_s * speed; };
  drag.stiffness_N_per_m = 5;
  drag.max_force_N = std::numeric_limits<double>::infinity();
  drag.damping_N_s_per_m = 0.2;
  run.world.drags.push_back(drag);
  for (Vec3& v : run.state.v) v = speed;
  run.run(120);
  const Vec3 below = drag.target(run.time_s) - point(drag, run.state.x);
  EXPECT_LT((below - Vec3(0, mass(run) * gravity / 5, 0)).norm(), 3e-4);
}

TEST(Drag, AStiffSpringDoesNotOvershootWithinAStep) {
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  ClothRun run(test::equilateral_sheet(0.1, 0.1, 0.02), Fabric{}, weightless);
  for (std::size_t i = 0; i < run.state.x.size(); ++i) {  // every particle, so that the cloth goes as a whole
    Drag drag;
    drag.particle[0] = static_cast<Index>(i);
    const Vec3 to = run.state.x[i] + Vec3(0, 0.01, 0);
    drag.target = [to](double) { return to; };
    drag.stiffness_N_per_m = 1e4;
    drag.max_force_N = std::numeric_limits<double>::infinity();
    run.world.drags.push_back(drag);
  }
  run.frame();
  EXPECT_GT(run.state.x[0].y(), 0.0099);
  EXPECT_LE(run.state.x[0].y(), 0.01);
}

TEST(Drag, ItPullsNoHarderThanItsLimit) {
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{}, weightless);
  Drag drag = grip(run);
  drag.target = [](double) { return Vec3(0, 100, 0); };
  drag.stiffness_N_per_m = 1e3;
  drag.damping_N_s_per_m = 10;
  drag.max_force_N = 0.01;
  run.world.drags.push_back(drag);
  run.run(15);
  EXPECT_LT((momentum(run) - Vec3(0, 0.01 * run.time_s, 0)).norm(), 0.02 * 0.01 * run.time_s);
}

TEST(Release, AClothThatIsLetGoFallsFreelyAtOnce) {
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  run.pin(0);
  run.pin(10);
  Drag drag = grip(run);
  drag.target = [](double) { return Vec3(0.1, 0.1, 0); };
  drag.stiffness_N_per_m = 10;
  drag.max_force_N = std::numeric_limits<double>::infinity();
  run.world.drags.push_back(drag);
  run.run(30);
  run.world.pins.clear();
  run.world.drags.clear();
  const Vec3 before = momentum(run);
  run.frame();
  const Vec3 fall(0, -mass(run) * gravity / 30, 0);
  EXPECT_LT((momentum(run) - before - fall).norm(), 1e-4 * fall.norm());  // blocks are rounded to float one by one
}

TEST(Release, OfOnePinOfTwoLeavesTheOtherHolding) {
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  run.pin(0);
  run.pin(10);
  run.run(30);
  const Vec3 corner = run.state.x[0], gone = run.state.x[10];
  run.world.pins.pop_back();
  run.run(30);
  EXPECT_LT((run.state.x[0] - corner).norm(), 1e-12);
  EXPECT_GT((run.state.x[10] - gone).norm(), 0.1);
  run.pin(10);  // and taken hold of again, where it is
  const Vec3 held = run.state.x[10];
  run.run(15);
  EXPECT_LT((run.state.x[10] - held).norm(), 1e-12);
}

TEST(StepWorld, ItsSpringsAreAskedForTheEndOfEveryStep) {
  ClothRun run(test::equilateral_sheet(0.1, 0.1, 0.02), Fabric{});
  run.adaptive.step_max_s = 1.0 / 120;
  std::vector<double> ends;
  run.world.springs = [&](const ClothState&, double end_s, double h_s, std::vector<LinearSpring>&) {
    EXPECT_DOUBLE_EQ(h_s, 1.0 / 120);
    if (ends.empty() || end_s != ends.back()) ends.push_back(end_s);
  };
  run.run(2);
  ASSERT_EQ(ends.size(), 8U);
  for (std::size_t k = 0; k < ends.size(); ++k) EXPECT_NEAR(ends[k], static_cast<double>(k + 1) / 120, 1e-12);
}

}  // namespace
}  // namespace toile::internal
