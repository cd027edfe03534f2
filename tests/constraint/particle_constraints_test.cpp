// Constraints of particles: the directions that are held, z for combined ones, and the filter.            [BW98 5.1-5.3]
#include "constraint/particle_constraints.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/sheets.hpp"

namespace toile::internal {
namespace {

using test::Random;

Vec3 unit(Random& random) {
  for (;;) {
    const Vec3 a = random.vector(1);
    if (a.norm() > 0.1) return a.normalized();
  }
}

// Symmetric, S S = S, and of the rank that the degrees of freedom say.
void expect_projection(const ParticleConstraints& constraints, Index particle) {
  const Mat3& S = constraints.S(particle);
  EXPECT_LT((S - S.transpose()).norm(), 1e-14);
  EXPECT_LT((S * S - S).norm(), 1e-12);
  EXPECT_NEAR(S.trace(), constraints.degrees_of_freedom(particle), 1e-12);
  EXPECT_LT((S * constraints.z(particle)).norm(), 1e-12) << "z must lie in the range of I - S";
}

TEST(ParticleConstraints, LeavesEveryParticleFreeAtFirst) {
  const ParticleConstraints constraints(3);
  EXPECT_EQ(constraints.size(), 3);
  EXPECT_TRUE(constraints.constrained().empty());
  for (Index i = 0; i < 3; ++i) {
    EXPECT_TRUE(constraints.is_free(i));
    EXPECT_EQ(constraints.S(i), Mat3::Identity());
    EXPECT_EQ(constraints.z(i), Vec3::Zero());
  }
}

TEST(ParticleConstraints, AHeldParticleHasNoFreedomAndExactlyItsZ) {
  ParticleConstraints constraints(3);
  const Vec3 z(0.1, -0.7, 0.3);
  constraints.hold(1, z);
  EXPECT_EQ(constraints.degrees_of_freedom(1), 0);
  EXPECT_EQ(constraints.S(1), Mat3::Zero());
  EXPECT_EQ(constraints.z(1), z);
  EXPECT_TRUE(constraints.is_free(0));
  EXPECT_TRUE(constraints.is_free(2));
}

TEST(ParticleConstraints, HoldingTwiceTakesTheLastZAndListsTheParticleOnce) {
  ParticleConstraints constraints(2);
  constraints.hold_along(1, Vec3::UnitX(), 0.5);
  constraints.hold(1, Vec3(1, 2, 3));
  constraints.hold(1, Vec3(4, 5, 6));
  EXPECT_EQ(constraints.z(1), Vec3(4, 5, 6));
  ASSERT_EQ(constraints.constrained().size(), 1U);
  EXPECT_EQ(constraints.constrained()[0], 1);
}

TEST(ParticleConstraints, AHeldParticleIsNotReleasedByADirection) {
  ParticleConstraints constraints(1);
  constraints.hold(0, Vec3(1, 2, 3));
  constraints.hold_along(0, Vec3::UnitX(), 9);
  EXPECT_EQ(constraints.z(0), Vec3(1, 2, 3));
  EXPECT_EQ(constraints.degrees_of_freedom(0), 0);
}

TEST(ParticleConstraints, OneDirectionTakesOneDegreeOfFreedom) {
  Random random(11);
  for (int k = 0; k < 50; ++k) {
    ParticleConstraints constraints(1);
    const Vec3 n = unit(random);
    constraints.hold_along(0, n, 0.25);
    EXPECT_EQ(constraints.degrees_of_freedom(0), 2);
    expect_projection(constraints, 0);
    EXPECT_LT((constraints.S(0) * n).norm(), 1e-14);
    const Vec3 across = n.unitOrthogonal();
    EXPECT_LT((constraints.S(0) * across - across).norm(), 1e-14);
    EXPECT_LT((constraints.z(0) - 0.25 * n).norm(), 1e-15);
  }
}

TEST(ParticleConstraints, TwoObliqueDirectionsKeepBothVelocitiesWithTheLeastNorm) {
  Random random(12);
  for (int k = 0; k < 200; ++k) {
    const Vec3 n = unit(random), m = unit(random);
    if (n.cross(m).norm() < 0.05) continue;
    const double zn = random(-1, 1), zm = random(-1, 1);
    ParticleConstraints constraints(1);
    constraints.hold_along(0, n, zn);
    constraints.hold_along(0, m, zm);
    EXPECT_EQ(constraints.degrees_of_freedom(0), 1);
    expect_projection(constraints, 0);
    EXPECT_NEAR(n.dot(constraints.z(0)), zn, 1e-11);
    EXPECT_NEAR(m.dot(constraints.z(0)), zm, 1e-11);
    const Vec3 left = n.cross(m).normalized();
    EXPECT_NEAR(left.dot(constraints.z(0)), 0, 1e-10) << "least norm: nothing along what stays free";
    EXPECT_LT((constraints.S(0) - left * left.transpose()).norm(), 1e-10);
  }
}

TEST(ParticleConstraints, ThreeDirectionsAreHeldWithTheOneVelocityThatSatisfiesAll) {
  Random random(13);
  for (int k = 0; k < 200; ++k) {
    const Vec3 a = unit(random), b = unit(random), c = unit(random);
    if (std::abs(a.cross(b).dot(c)) < 0.05) continue;
    const Vec3 z = random.vector(1);
    ParticleConstraints constraints(1);
    constraints.hold_along(0, a, a.dot(z));
    constraints.hold_along(0, b, b.dot(z));
    constraints.hold_along(0, c, c.dot(z));
    EXPECT_EQ(constraints.degrees_of_freedom(0), 0);
    EXPECT_EQ(constraints.S(0), Mat3::Zero());
    EXPECT_LT((constraints.z(0) - z).norm(), 1e-10);
  }
}

TEST(ParticleConstraints, ExactForAxes) {
  ParticleConstraints constraints(1);
  constraints.hold_along(0, Vec3::UnitX(), 0.5);
  constraints.hold_along(0, Vec3::UnitZ(), -2);
  EXPECT_EQ(constraints.z(0), Vec3(0.5, 0, -2));
  EXPECT_EQ(constraints.S(0), Mat3(Vec3(0, 1, 0).asDiagonal()));
}

TEST(ParticleConstraints, OfParallelAndOppositeDirectionsTheFirstStays) {
  for (const double sign : {1.0, -1.0}) {
    ParticleConstraints constraints(1);
    constraints.hold_along(0, Vec3::UnitY(), 0.5);
    constraints.hold_along(0, sign * Vec3::UnitY(), 7);
    constraints.hold_along(0, sign * Vec3(1e-5, 1, 0).normalized(), 7);
    EXPECT_EQ(constraints.degrees_of_freedom(0), 2);
    EXPECT_EQ(constraints.z(0), Vec3(0, 0.5, 0));
    EXPECT_EQ(constraints.constrained().size(), 1U);
  }
}

TEST(ParticleConstraints, ADirectionWithinThePlaneOfTwoAddsNothing) {
  ParticleConstraints constraints(1);
  constraints.hold_along(0, Vec3::UnitX(), 1);
  constraints.hold_along(0, Vec3::UnitY(), 2);
  constraints.hold_along(0, Vec3(0.6, 0.8, 0), 50);
  EXPECT_EQ(constraints.degrees_of_freedom(0), 1);
  EXPECT_EQ(constraints.z(0), Vec3(1, 2, 0));
}

TEST(ParticleConstraints, ClearFreesEverythingAndWhatFollowsStartsAnew) {
  ParticleConstraints constraints(4);
  constraints.hold(3, Vec3(1, 2, 3));
  constraints.hold_along(1, Vec3::UnitX(), 1);
  constraints.hold_along(1, Vec3::UnitY(), 2);
  constraints.clear();
  EXPECT_EQ(constraints.size(), 4);
  EXPECT_TRUE(constraints.constrained().empty());
  for (Index i = 0; i < 4; ++i) {
    EXPECT_TRUE(constraints.is_free(i));
    EXPECT_EQ(constraints.S(i), Mat3::Identity());
    EXPECT_EQ(constraints.z(i), Vec3::Zero());
  }
  constraints.hold_along(1, Vec3::UnitZ(), 5);
  EXPECT_EQ(constraints.degrees_of_freedom(1), 2);
  EXPECT_EQ(constraints.z(1), Vec3(0, 0, 5));
  EXPECT_EQ(constraints.constrained().size(), 1U);
}

TEST(ParticleConstraints, ListsTheConstrainedInTheOrderInWhichTheyWereFirstHeld) {
  ParticleConstraints constraints(9);
  constraints.hold_along(7, Vec3::UnitX(), 0);
  constraints.hold(2, Vec3::Zero());
  constraints.hold_along(5, Vec3::UnitX(), 0);
  constraints.hold_along(7, Vec3::UnitY(), 0);
  constraints.hold(5, Vec3::Zero());
  const auto held = constraints.constrained();
  EXPECT_EQ(std::vector<Index>(held.begin(), held.end()), (std::vector<Index>{7, 2, 5}));
}

TEST(ParticleConstraints, TheFilterIsAnOrthogonalProjection) {
  Random random(14);
  ParticleConstraints constraints(40);
  for (Index i = 0; i < 40; ++i) {
    for (int k = 0; k < i % 4; ++k) constraints.hold_along(i, unit(random), random(-1, 1));
  }
  Vec3s a, b;
  for (int i = 0; i < 40; ++i) {
    a.push_back(random.vector(1));
    b.push_back(random.vector(1));
  }
  Vec3s once = a, other = b;
  constraints.filter(once);
  constraints.filter(other);
  Vec3s twice = once;
  constraints.filter(twice);
  double left = 0, right = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((twice[i] - once[i]).norm(), 1e-12);
    EXPECT_LE(once[i].norm(), a[i].norm() * (1 + 1e-14));
    if (i % 4 == 0) {  // free: to the bit
      EXPECT_EQ(once[i], a[i]);
    }
    if (i % 4 == 3) {  // three random directions: held
      EXPECT_EQ(once[i], Vec3::Zero());
    }
    left += once[i].dot(b[i]);
    right += a[i].dot(other[i]);
  }
  EXPECT_NEAR(left, right, 1e-12) << "self-adjoint";
}

}  // namespace
}  // namespace toile::internal
