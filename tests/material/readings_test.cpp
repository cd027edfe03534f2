#include "material/readings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "material/monotone_curve.hpp"

namespace toile::internal {
namespace {

TEST(Readings, TheMeanHasTheStandardErrorOfItsReadings) {
  const Estimate five = estimate_of(Readings{10, 11, 9, 10.5, 9.5}, 0.05, "scale");
  EXPECT_DOUBLE_EQ(five.value, 10);
  EXPECT_NEAR(five.uncertainty(), std::sqrt((1 + 1 + 0.25 + 0.25) / 4 / 5) * 1.142, 1e-12);
  EXPECT_EQ(five.readings, 5);
  EXPECT_EQ(five.from, "scale");
}

TEST(Readings, ASingleOneHasThatOfItsMethodAndEqualOnesATenthOfIt) {
  EXPECT_DOUBLE_EQ(estimate_of(Readings{20}, 0.05, "").uncertainty(), 1);
  EXPECT_DOUBLE_EQ(estimate_of(Readings{20, 20, 20}, 0.05, "").uncertainty(), 0.1);
}

TEST(Readings, MethodsThatAgreeAreWeightedByTheInverseOfTheirVariances) {
  const Combined both = combine(std::vector<Estimate>{{100, 0.1, 3, "a"}, {112, 0.05, 4, "b"}});
  EXPECT_NEAR(both.estimate.value, (100 * 100 + 112 * 400) / 500.0, 1e-12);
  EXPECT_NEAR(both.estimate.relative, 1 / std::sqrt(500.0), 1e-12);
  EXPECT_EQ(both.estimate.readings, 7);
  EXPECT_EQ(both.estimate.from, "a, b");
  EXPECT_TRUE(both.agree);
  EXPECT_EQ(both.widened, 1);
}

TEST(Readings, MethodsThatDisagreeAreFoundAndTheUncertaintyIsWidened) {
  const Combined apart = combine(std::vector<Estimate>{{100, 0.05, 1, "a"}, {150, 0.05, 1, "b"}});
  EXPECT_FALSE(apart.agree);
  EXPECT_EQ(apart.freedom, 1);
  EXPECT_NEAR(apart.chi_square, 2 * 16, 1e-9);  // each a fifth off 125, of which a twentieth is u
  EXPECT_NEAR(apart.estimate.relative, 0.05 / std::sqrt(2.0) * std::sqrt(32.0), 1e-9);
  // 3.84, not above: an uncertainty of 1.38 times that lies just inside.
  const double share = 0.05 * std::sqrt(3.8 / 2);
  EXPECT_TRUE(
      combine(std::vector<Estimate>{{100 * (1 - share), 0.05, 1, "a"}, {100 * (1 + share), 0.05, 1, "b"}}).agree);
  const double more = 0.05 * std::sqrt(3.9 / 2);
  EXPECT_FALSE(
      combine(std::vector<Estimate>{{100 * (1 - more), 0.05, 1, "a"}, {100 * (1 + more), 0.05, 1, "b"}}).agree);
}

TEST(Readings, DisagreeOnceInTwentyTimesByChance) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const int methods : {2, 3}) {
    int found = 0;
    for (int trial = 0; trial < 4000; ++trial) {
      std::vector<Estimate> sources;
      for (int k = 0; k < methods; ++k) {
        const double r = 0.02 + 0.02 * k, off = normal(random);
        sources.push_back({1 + r * off, r, 1, ""});
      }
      found += combine(sources).agree ? 0 : 1;
    }
    EXPECT_NEAR(found / 4000.0, 0.05, 0.012) << methods;
  }
}

TEST(Readings, CubeRootIsThat) {
  for (const double x : {1e-12, 8.5e-6, 0.125, 1.0, 7.9, 8.0, 1e9})
    EXPECT_NEAR(cube_root(x) / std::cbrt(x), 1, 4e-16) << x;
  EXPECT_EQ(cube_root(0), 0);
}

TEST(MonotoneCurve, GoesThroughItsPointsAscendsAndIsInverted) {
  const std::vector<std::array<double, 2>> points = {{0, 0}, {1, 0.1}, {2, 5}, {2.5, 5.2}, {4, 30}};
  const MonotoneCurve curve(points);
  for (const auto& [x, y] : points) EXPECT_NEAR(curve.value(x), y, 1e-12);
  double before = -1;
  for (double x = 0; x <= 4; x += 1.0 / 64) {
    const double y = curve.value(x);
    EXPECT_GT(y, before) << x;
    before = y;
    EXPECT_NEAR(curve.inverse(y), x, 1e-9);
    const double h = 1e-6;
    if (x < h || x + h > 4) continue;
    EXPECT_NEAR(curve.slope(x), (curve.value(x + h) - curve.value(x - h)) / (2 * h), 1e-4 * (1 + curve.slope(x))) << x;
  }
  EXPECT_EQ(curve.value(-1), 0);
  EXPECT_EQ(curve.inverse(31), 4);
}

}  // namespace
}  // namespace toile::internal
