// One bristle: a spring below the cone, Coulomb's force above it, and what it remembers.
#include "step/bristle.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

constexpr double k = 100;  // N/m

// The contact of particle 0 with particle 1 below it.
LinearSpring contact() {
  LinearSpring spring;
  spring.particle = {0, 1, -1, -1};
  spring.weight = {1, -1, 0, 0};
  spring.direction = Vec3::UnitY();
  spring.force_N = 5;
  spring.stiffness_N_per_m = k;
  return spring;
}

// Force on particle 0 where it ends after a way of u.
Vec3 force(const Bristle& bristle, const Vec3& u) {
  std::vector<LinearSpring> springs;
  bristle.append_springs(contact(), Vec3::Zero(), 0, springs);
  Vec3 sum = Vec3::Zero();
  for (const LinearSpring& s : springs) sum += (s.force_N - s.stiffness_N_per_m * s.direction.dot(u)) * s.direction;
  return sum;
}

Bristle begun() {
  Bristle bristle;
  bristle.carry_on(Vec3::UnitY(), k);
  return bristle;
}

TEST(Bristle, IsASpringBelowTheCone) {
  Bristle bristle = begun();
  const Vec3 u(2e-3, 0, -1e-3);
  bristle.decide(u, 1);
  EXPECT_FALSE(bristle.slips());
  EXPECT_NEAR((force(bristle, u) + k * u).norm(), 0, 1e-12);
  bristle.end(u, 1);
  EXPECT_EQ(bristle.stretch_m(), u);
  bristle.carry_on(Vec3::UnitY(), k);
  bristle.decide(-u, 1);  // back to where it took hold
  EXPECT_NEAR(force(bristle, -u).norm(), 0, 1e-12);
}

TEST(Bristle, IsCoulombsForceAboveTheConeHoweverFarTheWay) {
  Bristle bristle = begun();
  bristle.decide(Vec3(0.03, 0, 0.04), 1);
  EXPECT_TRUE(bristle.slips());
  for (const double faster :
       {1.0, 1.7, 5.0}) {  // what speeds up after the last pass is not held back by more than the cone
    const Vec3 u = faster * Vec3(0.03, 0, 0.04);
    EXPECT_NEAR((force(bristle, u) + Vec3(0.6, 0, 0.8)).norm(), 0, 1e-12) << faster;
  }
}

TEST(Bristle, TurnsItsForceWithTheWay) {
  Bristle bristle = begun();
  bristle.decide(Vec3(0.05, 0, 0), 1);
  // The derivative of -mu lambda u/|u| across u.
  const double small = 1e-6;
  const Vec3 slope = (force(bristle, Vec3(0.05, 0, small)) - force(bristle, Vec3(0.05, 0, 0))) / small;
  const auto exact = [](const Vec3& u) { return Vec3(-u / u.norm()); };
  const Vec3 expected = (exact(Vec3(0.05, 0, small)) - exact(Vec3(0.05, 0, -small))) / (2 * small);
  EXPECT_NEAR((slope - expected).norm() / expected.norm(), 0, 1e-6);
}

TEST(Bristle, KeepsNoMoreStretchThanTheConeHolds) {
  Bristle bristle = begun();
  bristle.decide(Vec3(0.05, 0, 0), 1);
  bristle.end(Vec3(0.05, 0, 0), 1);
  EXPECT_NEAR((bristle.stretch_m() - Vec3(0.01, 0, 0)).norm(), 0, 1e-12) << "1 N / 100 N/m";
}

TEST(Bristle, SticksWhenItsForceWouldDriveWhatItStoppedAndAfterTheSecondTimeUntilTheStepEnds) {
  Bristle bristle = begun();
  EXPECT_FALSE(bristle.decide(Vec3(0.05, 0, 0), 1));
  EXPECT_TRUE(bristle.decide(Vec3(-0.02, 0, 0), 1)) << "driven back by the force of slipping";
  EXPECT_FALSE(bristle.slips());
  EXPECT_FALSE(bristle.decide(Vec3(0.05, 0, 0), 1));
  EXPECT_TRUE(bristle.slips()) << "what drove it back is gone";
  EXPECT_TRUE(bristle.decide(Vec3(-0.02, 0, 0), 1));
  EXPECT_FALSE(bristle.decide(Vec3(0.05, 0, 0), 1));
  EXPECT_FALSE(bristle.slips());
  bristle.carry_on(Vec3::UnitY(), k);
  bristle.decide(Vec3(0.05, 0, 0), 1);
  EXPECT_TRUE(bristle.slips());
}

TEST(Bristle, KeepsItsForceWhenItsStiffnessGrowsAndFollowsTheSurfaceWhenItTurns) {
  Bristle bristle = begun();
  bristle.decide(Vec3(2e-3, 0, 0), 1);
  bristle.end(Vec3(2e-3, 0, 0), 1);
  bristle.carry_on(Vec3::UnitY(), 4 * k);
  EXPECT_NEAR((bristle.stretch_m() - Vec3(0.5e-3, 0, 0)).norm(), 0, 1e-15);
  const Vec3 n = Vec3(1, 1, 0).normalized();
  bristle.carry_on(n, 4 * k);
  EXPECT_NEAR(bristle.stretch_m().dot(n), 0, 1e-15);
  EXPECT_NEAR(bristle.stretch_m().norm(), 0.5e-3, 1e-15);
}

TEST(Bristle, WithoutALoadDoesNothing) {
  Bristle bristle = begun();
  bristle.decide(Vec3(0.05, 0, 0), 0);
  std::vector<LinearSpring> springs;
  bristle.append_springs(contact(), Vec3::Zero(), 0, springs);
  EXPECT_TRUE(springs.empty());
}

TEST(Bristle, TakesOverWhatTheConeAllows) {
  Bristle bristle = begun();
  bristle.take_over(Vec3(-0.5, 0, 0), 1);  // friction pulled towards -x
  bristle.decide(Vec3::Zero(), 1);
  EXPECT_NEAR((force(bristle, Vec3::Zero()) - Vec3(-0.5, 0, 0)).norm(), 0, 1e-12);
  bristle.take_over(Vec3(-3, 0, 0), 1);
  bristle.decide(Vec3(1e-3, 0, 0), 1);
  EXPECT_TRUE(bristle.slips());
  EXPECT_NEAR((force(bristle, Vec3(1e-3, 0, 0)) - Vec3(-1, 0, 0)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace toile::internal
