#include "preview/low_discrepancy.hpp"

#include <gtest/gtest.h>

#include <set>

namespace toile::internal {
namespace {

// A (0, m, 2)-net: one of 16 points in each box of area 1/16, for every shape of box with sides 2^-a.
TEST(LowDiscrepancy, SixteenPointsOfEveryPairFillEveryKindOfBoxOnce) {
  for (const std::uint32_t seed : {1u, 77u, 123456u}) {
    for (int pair = 1; pair <= 6; ++pair) {
      for (int a = 0; a <= 4; ++a) {
        std::set<std::pair<int, int>> boxes;
        for (std::uint32_t i = 0; i < 16; ++i) {
          PathSampler sampler(seed, i, 16);
          Vec2f u = sampler.next();
          for (int k = 1; k < pair; ++k) u = sampler.next();
          ASSERT_TRUE(u.x() >= 0 && u.x() < 1 && u.y() >= 0 && u.y() < 1);
          boxes.insert({static_cast<int>(u.x() * static_cast<float>(1 << a)),
                        static_cast<int>(u.y() * static_cast<float>(1 << (4 - a)))});
        }
        EXPECT_EQ(boxes.size(), 16u) << "seed " << seed << " pair " << pair << " shape " << a;
      }
    }
  }
}

TEST(LowDiscrepancy, PairsOfDimensionsAndPixelsDiffer) {
  PathSampler a(5, 3, 16), b(6, 3, 16);
  const Vec2f first = a.next(), second = a.next();
  EXPECT_NE(first, second);
  EXPECT_NE(first, b.next());
}

TEST(LowDiscrepancy, CosineDirectionsAreUnitAboutTheirNormalAndTheirMeanCosineIsTwoThirds) {
  for (const Vec3f& n : {Vec3f(0, 0, -1), Vec3f(0, 1, 0), Vec3f(0.6f, -0.48f, 0.64f)}) {
    double mean = 0;
    for (std::uint32_t i = 0; i < 256; ++i) {
      PathSampler sampler(9, i, 256);
      const Vec3f d = cosine_direction(n, sampler.next());
      ASSERT_NEAR(d.norm(), 1, 1e-5);
      ASSERT_GE(d.dot(n), -1e-6);
      mean += d.dot(n) / 256.0;
    }
    EXPECT_NEAR(mean, 2.0 / 3.0, 0.005);
  }
}

}  // namespace
}  // namespace toile::internal
