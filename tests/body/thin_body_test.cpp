// tests/body/thin_body_test.cpp: a body drawn in towards its middle, and its arms.
#include "body/thin_body.hpp"
#include "body/arms.hpp"
#include "body/mannequin.hpp"
#include "body/solid_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

// Of a cylinder the flow is known: L_0 of a coordinate across the axis is A_0 x / r_0^2 and M goes with the radius, so a step of dt leads from
// r to r^2 / (r + dt / r_0): by and large r = r_0 - t / r_0.
TEST(ThinBody, OfACylinderFollowsTheFlowAndComesBackToTheBit) {
  const double radius = 0.03;
  const SolidMesh cylinder = rounded_cylinder(radius, 1, Vec3(0, 1, 0));
  const ThinBody body(cylinder.positions, cylinder.triangles);
  Vec3s thin(cylinder.positions.size()), half(thin.size()), full(thin.size());
  body.at(0, thin);
  body.at(0.5, half);
  body.at(1, full);
  EXPECT_EQ(full, cylinder.positions);
  double wanted = radius;
  for (const double part : {1.0, 2.0, 4.0, 8.0}) wanted = wanted * wanted / (wanted + part / 15 * 2e-4 / radius);
  int in_the_middle = 0;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    ASSERT_TRUE(thin[i].allFinite());
    const Vec3& p = cylinder.positions[i];
    const double from_axis = std::hypot(p.x(), p.z());
    if (std::abs(p.y() - 0.5) > 0.2 || from_axis < 0.99 * radius) continue;
    ++in_the_middle;
    EXPECT_NEAR(std::hypot(thin[i].x(), thin[i].z()), wanted, 0.03 * radius);
    EXPECT_LT(std::hypot(half[i].x(), half[i].z()), from_axis);
    EXPECT_GT(std::hypot(half[i].x(), half[i].z()), std::hypot(thin[i].x(), thin[i].z()));
    EXPECT_NEAR(thin[i].x() * p.z(), thin[i].z() * p.x(), 1e-5) << "along its own radius";
  }
  EXPECT_GT(in_the_middle, 10);
}

TEST(ThinBody, LeavesAVertexOfNoTriangleWhereItIs) {
  SolidMesh cylinder = rounded_cylinder(0.1, 1, Vec3(0, 1, 0));
  cylinder.positions.push_back(Vec3(0.3, 0.5, 0.2));
  const ThinBody body(cylinder.positions, cylinder.triangles);
  Vec3s thin(cylinder.positions.size());
  body.at(0, thin);
  EXPECT_LT((thin.back() - cylinder.positions.back()).norm(), 1e-9);
}

TEST(Arms, OfTheMannequinsAreFoundAndPointDownAndOutwards) {
  for (const MannequinKind kind : {MannequinKind::woman, MannequinKind::man}) {
    const Mannequin mannequin = make_mannequin(kind);
    const Arms arms = find_arms(mannequin.positions, mannequin.triangles);
    ASSERT_TRUE(arms);
    const auto& [left, right] = *arms;
    EXPECT_GT(left.root.x(), 0.1);
    EXPECT_NEAR(left.root.x(), -right.root.x(), 0.02) << "a ring is a hundredth of the height from the next";
    EXPECT_NEAR(left.direction.x(), -right.direction.x(), 0.02);
    EXPECT_GT(left.direction.x(), 0.3);
    EXPECT_LT(left.direction.y(), -0.3);
    double highest = -1e9, lowest = 1e9;
    for (const Vec3& p : mannequin.positions) {
      highest = std::max(highest, p.y());
      lowest = std::min(lowest, p.y());
    }
    EXPECT_NEAR((left.root.y() - lowest) / (highest - lowest), 0.78, 0.05) << "at the armpit";
    for (std::size_t i = 0; i < left.past.size(); ++i)
      EXPECT_FALSE(left.past[i] > 0 && right.past[i] > 0) << "no vertex is on both arms";
  }
}

TEST(Arms, OfWhatIsNoPersonAreNone) {
  const SolidMesh cylinder = rounded_cylinder(0.2, 1, Vec3(0, 1, 0)), sphere = ball(0.3, 0.05);
  EXPECT_FALSE(find_arms(cylinder.positions, cylinder.triangles));
  EXPECT_FALSE(find_arms(sphere.positions, sphere.triangles));
  EXPECT_FALSE(find_arms({}, {}));
}

}  // namespace
}  // namespace toile::internal
