// tests/body/thin_body_test.cpp: a body drawn in towards its middle, and its arms.
#include "body/thin_body.hpp"
#include "body/arms.hpp"
#include "body/mannequin.hpp"
#include "body/solid_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile {
namespace {

TEST(ThinBody, IsThinnerThanTheFullOneWhichComesBackToTheBit) {
  const SolidMesh cylinder = rounded_cylinder(0.1, 1, Vec3(0, 1, 0));
  const ThinBody body(cylinder.positions, cylinder.triangles);
  Vec3s thin(cylinder.positions.size()), half(thin.size()), full(thin.size());
  body.at(0, thin);
  body.at(0.5, half);
  body.at(1, full);
  EXPECT_EQ(full, cylinder.positions);
  double of_thin = 0, of_half = 0;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    ASSERT_TRUE(thin[i].allFinite());
    if (std::abs(cylinder.positions[i].y() - 0.5) > 0.2) continue;
    of_thin = std::max(of_thin, std::hypot(thin[i].x(), thin[i].z()));
    of_half = std::max(of_half, std::hypot(half[i].x(), half[i].z()));
    // The round flow of a cylinder keeps directions: every vertex comes in along its own radius.
    EXPECT_NEAR(thin[i].x() * cylinder.positions[i].z(), thin[i].z() * cylinder.positions[i].x(), 1e-4);
  }
  EXPECT_LT(of_thin, of_half);
  EXPECT_LT(of_half, 0.1);
  EXPECT_GT(of_thin, 0.01);
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
}  // namespace toile
