// Open sheets as closed slabs.
#include "mesh/thicken.hpp"

#include "mesh/check.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <vector>

namespace toile::internal {
namespace {

constexpr double thickness = 0.01;

double volume(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) sum += x[at(a)].dot(x[at(b)].cross(x[at(c)])) / 6;
  return sum;
}

// A part of a cylinder around z, seen from outside: `cells` along an arc and `cells` along z.
struct Arc {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  Arc(double radius, double angle, double length, Index cells) {
    for (Index i = 0; i <= cells; ++i)
      for (Index j = 0; j <= cells; ++j) {
        const double phi = angle * i / cells;
        x.emplace_back(radius * std::cos(phi), radius * std::sin(phi), length * j / cells);
      }
    for (Index i = 0; i < cells; ++i)
      for (Index j = 0; j < cells; ++j) {
        const Index a = i * (cells + 1) + j, b = a + cells + 1;
        triangles.insert(triangles.end(), {Triangle{a, b, b + 1}, Triangle{a, b + 1, a + 1}});
      }
  }
};

TEST(Thicken, MakesAnArcAClosedSlabBehindItsFace) {
  constexpr double radius = 0.2, angle = 2, length = 0.5;
  Arc arc(radius, angle, length, 40);
  const std::vector<Vec3> before = arc.x;
  const std::vector<Triangle> front = arc.triangles;
  thicken(thickness, arc.x, arc.triangles);
  check_closed("slab", arc.x, arc.triangles);
  ASSERT_EQ(arc.x.size(), 2 * before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(arc.x[i], before[i]);
    EXPECT_NEAR((arc.x[i + before.size()] - before[i]).norm(), thickness, 1e-12);
    EXPECT_LT(arc.x[i + before.size()].head<2>().norm(), radius - 0.99 * thickness);  // behind: nearer to the axis
  }
  for (std::size_t t = 0; t < front.size(); ++t) EXPECT_EQ(arc.triangles[t], front[t]);
  const double inner = radius - thickness, exact = 0.5 * angle * length * (radius * radius - inner * inner);
  EXPECT_NEAR(volume(arc.x, arc.triangles) / exact, 1, 2e-3);
}

TEST(Thicken, PartsFansThatMeetAtOneVertex) {
  std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  std::vector<Triangle> triangles = {{0, 1, 2}, {0, 3, 4}};
  thicken(thickness, x, triangles);
  check_closed("bow tie", x, triangles);
  EXPECT_EQ(x.size(), 12u);  // two prisms
  EXPECT_NEAR(volume(x, triangles), thickness, 1e-12);
}

TEST(Thicken, LeavesNothingAsItIs) {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  thicken(thickness, x, triangles);
  EXPECT_TRUE(x.empty());
  EXPECT_TRUE(triangles.empty());
}

}  // namespace
}  // namespace toile::internal
