#include "mesh/cloth_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

namespace toile::internal {
namespace {

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

Vec3 along(const Vec3& weights, const std::array<Vec3, 3>& x) {
  return weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2];
}

TEST(MaterialFrame, OfTheUnitTriangleIsReadOffTheAxes) {
  const MaterialFrame frame = material_frame({Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)});
  EXPECT_EQ(frame.alpha, Vec3(-1, 1, 0));
  EXPECT_EQ(frame.beta, Vec3(-1, 0, 1));
  EXPECT_EQ(frame.area_m2, 0.5);
}

TEST(MaterialFrame, FindsTheColumnsOfAnyLinearMap) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    // x = c + w_u u + w_v v on some triangle of 1 cm to 1 m.
    const auto point = [&] {
      const double y = uniform(random, -1, 1), x = uniform(random, -1, 1);
      return Vec2(x, y);
    };
    std::array<Vec2, 3> uv = {point(), point(), point()};
    Mat2 sides;
    sides << uv[1] - uv[0], uv[2] - uv[0];
    if (sides.determinant() < 0) std::swap(uv[1], uv[2]);
    if (std::abs(sides.determinant()) < 0.01) continue;

    const auto vector = [&] {
      const double z = uniform(random, -2, 2), y = uniform(random, -2, 2), x = uniform(random, -2, 2);
      return Vec3(x, y, z);
    };
    const Vec3 c = vector(), w_u = vector(), w_v = vector();
    std::array<Vec3, 3> x;
    for (std::size_t i = 0; i < 3; ++i) x[i] = c + w_u * uv[i].x() + w_v * uv[i].y();

    const MaterialFrame frame = material_frame(uv);
    EXPECT_LT((along(frame.alpha, x) - w_u).norm(), 1e-11);
    EXPECT_LT((along(frame.beta, x) - w_v).norm(), 1e-11);
    EXPECT_NEAR(frame.area_m2, std::abs(sides.determinant()) / 2, 1e-14);
  }
}

TEST(MaterialFrame, GivesATranslationNoPart) {
  const MaterialFrame frame = material_frame({Vec2(0.3, 0.1), Vec2(0.37, 0.13), Vec2(0.29, 0.18)});
  EXPECT_EQ(frame.alpha[0] + (frame.alpha[1] + frame.alpha[2]), 0);
  EXPECT_EQ(frame.beta[0] + (frame.beta[1] + frame.beta[2]), 0);
}

TEST(MaterialFrame, OfTheFlatClothIsTheIdentity) {
  // Laid out with u along x and v along y, the threads have unit length and point along the axes.
  const std::array<Vec2, 3> uv = {Vec2(0.2, -0.1), Vec2(0.9, 0.3), Vec2(0.4, 0.8)};
  std::array<Vec3, 3> x;
  for (std::size_t i = 0; i < 3; ++i) x[i] = Vec3(uv[i].x(), uv[i].y(), 0);
  const MaterialFrame frame = material_frame(uv);
  EXPECT_LT((along(frame.alpha, x) - Vec3::UnitX()).norm(), 1e-14);
  EXPECT_LT((along(frame.beta, x) - Vec3::UnitY()).norm(), 1e-14);
}

TEST(MaterialFrame, OfAFlippedTriangleHasNegativeArea) {
  EXPECT_EQ(material_frame({Vec2(0, 0), Vec2(0, 1), Vec2(1, 0)}).area_m2, -0.5);
}

}  // namespace
}  // namespace toile::internal
