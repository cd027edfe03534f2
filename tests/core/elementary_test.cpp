// Own elementary functions against the C library's in long double (64-bit mantissa), and the values that IEEE 754 asks for.
#include "core/elementary.hpp"

#include "core/hash.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace toile::internal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tiny = std::numeric_limits<double>::denorm_min();
constexpr double huge = std::numeric_limits<double>::max();

// Distance in units in the last place of the exact result (of the smallest number where that is subnormal).
double ulps(double got, long double exact) {
  const double rounded = std::abs(static_cast<double>(exact));
  const double unit = rounded > 0 ? std::nextafter(rounded, infinity) - rounded : tiny;
  return static_cast<double>(std::abs(static_cast<long double>(got) - exact) / static_cast<long double>(unit));
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  double uniform(double a, double b) { return a + (b - a) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
  // Any finite double: every exponent as likely as any other.
  double any() {
    for (;;) {
      const std::uint64_t pattern = bits_();
      double x = 0;
      std::memcpy(&x, &pattern, sizeof x);
      if (std::isfinite(x)) return x;
    }
  }

 private:
  std::mt19937_64 bits_;
};

double atan2_error(double y, double x) {
  return ulps(ieee_atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
}

TEST(Elementary, Atan2IsWithinTwoUlpEverywhere) {
  static_assert(std::numeric_limits<long double>::digits >= 64, "the reference needs more digits than double has");
  Draw draw(1);
  double worst = 0;
  for (int k = 0; k < 400000; ++k) {
    worst = std::max(worst, atan2_error(draw.uniform(-1, 1), draw.uniform(-1, 1)));   // all directions
    worst = std::max(worst, atan2_error(draw.uniform(-0.13, 0.13), k % 2 ? 1 : -1));  // near the axis
    worst = std::max(worst, atan2_error(draw.any(), draw.any()));                     // all magnitudes, subnormal too
    const double y = draw.any();
    worst = std::max(worst, atan2_error(y, y * draw.uniform(0.3, 3)));
  }
  EXPECT_LE(worst, 2);
  RecordProperty("worst_ulp", std::to_string(worst));
}

TEST(Elementary, Atan2IsSeamlessWhereItsPiecesMeet) {
  for (int k = 1; k <= 16; ++k) {  // pieces of the tangent end at odd sixteenths, and at one
    double t = k / 16.0;
    for (int step = 0; step < 3; ++step) t = std::nextafter(t, 0);
    for (int step = 0; step < 7; ++step, t = std::nextafter(t, 2)) {
      EXPECT_LE(atan2_error(t, 1), 2) << t;
      EXPECT_LE(atan2_error(1, t), 2) << t;
      EXPECT_LE(atan2_error(t, -1), 2) << t;
      EXPECT_LE(atan2_error(-1, -t), 2) << t;
    }
  }
}

TEST(Elementary, Atan2OfAxesSignedZerosAndInfinitiesIsThatOfIeee754) {
  const std::array<double, 10> values = {0.0, -0.0, 1, -1, infinity, -infinity, tiny, -tiny, huge, -huge};
  for (const double y : values) {
    for (const double x : values) {
      const double got = ieee_atan2(y, x), expected = std::atan2(y, x);
      EXPECT_EQ(std::signbit(got), std::signbit(expected)) << y << ' ' << x;
      EXPECT_DOUBLE_EQ(got, expected) << y << ' ' << x;
    }
  }
  EXPECT_EQ(ieee_atan2(0, -1), std::numbers::pi);
  EXPECT_EQ(ieee_atan2(1, 0), std::numbers::pi / 2);
  EXPECT_EQ(ieee_atan2(2, 2), std::numbers::pi / 4);
  EXPECT_TRUE(std::isnan(ieee_atan2(std::nan(""), 1)));
  EXPECT_TRUE(std::isnan(ieee_atan2(1, std::nan(""))));
}

TEST(Elementary, SineAndCosineAreWithinTwoUlpUpToAMillion) {
  Draw draw(2);
  double worst_sin = 0, worst_cos = 0;
  const auto check = [&](double x) {
    const auto exact = static_cast<long double>(x);
    worst_sin = std::max(worst_sin, ulps(ieee_sin(x), std::sin(exact)));
    worst_cos = std::max(worst_cos, ulps(ieee_cos(x), std::cos(exact)));
  };
  for (int k = 0; k < 200000; ++k) {
    check(draw.uniform(-1, 1));
    check(draw.uniform(-7, 7));
    check(draw.uniform(-1e6, 1e6));
    const double x = draw.any();
    if (std::abs(x) <= 1) check(x);
    check(std::round(draw.uniform(-6e5, 6e5)) * (std::numbers::pi / 2));  // where one of the two nearly vanishes
  }
  EXPECT_LE(worst_sin, 2);
  EXPECT_LE(worst_cos, 2);
  RecordProperty("worst_ulp", std::to_string(worst_sin) + " " + std::to_string(worst_cos));
}

TEST(Elementary, SineAndCosineOfSpecialArguments) {
  EXPECT_EQ(ieee_sin(0), 0);
  EXPECT_TRUE(std::signbit(ieee_sin(-0.0)));
  EXPECT_FALSE(std::signbit(ieee_sin(0.0)));
  EXPECT_EQ(ieee_sin(tiny), tiny);
  EXPECT_EQ(ieee_cos(0), 1);
  EXPECT_EQ(ieee_cos(tiny), 1);
  for (const double x : {1.1e6, -1.1e6, huge, infinity, -infinity, std::nan("")}) {
    EXPECT_TRUE(std::isnan(ieee_sin(x))) << x;
    EXPECT_TRUE(std::isnan(ieee_cos(x))) << x;
  }
}

TEST(Elementary, ArcSineIsWithinThreeUlp) {
  Draw draw(3);
  double worst = 0;
  const auto check = [&](double x) {
    worst = std::max(worst, ulps(ieee_asin(x), std::asin(static_cast<long double>(x))));
  };
  for (int k = 0; k < 200000; ++k) {
    check(draw.uniform(-1, 1));
    check(1 - draw.uniform(0, 1e-6));
    check(draw.uniform(-1e-6, 1e-6));
  }
  EXPECT_LE(worst, 3);
  RecordProperty("worst_ulp", std::to_string(worst));
  EXPECT_EQ(ieee_asin(1), std::numbers::pi / 2);
  EXPECT_EQ(ieee_asin(-1), -std::numbers::pi / 2);
  EXPECT_EQ(ieee_asin(0), 0);
  EXPECT_TRUE(std::isnan(ieee_asin(std::nextafter(1, 2))));
}

TEST(Elementary, HasTheSameBitsOnEveryMachine) {
  Draw draw(4);
  std::vector<double> values;
  for (int k = 0; k < 10000; ++k) {
    const double x = draw.uniform(-1, 1), y = draw.uniform(-1, 1);
    values.push_back(ieee_atan2(y, x));
    values.push_back(ieee_sin(draw.uniform(-10, 10)));
    values.push_back(ieee_cos(draw.uniform(-10, 10)));
    values.push_back(ieee_asin(draw.uniform(-1, 1)));
  }
  Hash hash;
  hash.add(std::span<const double>(values));
  EXPECT_EQ(hash.hex(), "c2f9e46901815527");  // stored once; it may change only with core/elementary.cpp
}

}  // namespace
}  // namespace toile::internal
