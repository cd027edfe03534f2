#include "preview/weave.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace toile::internal {
namespace {

double uniform(std::mt19937_64& bits) { return static_cast<double>(bits() >> 11) * 0x1p-53; }

TEST(Weave, BandCoverIsTheExactShareOfTheInterval) {
  std::mt19937_64 bits(7);
  for (int n = 0; n < 200; ++n) {
    const double period = 0.01 + uniform(bits), band = period * uniform(bits);
    const double x = 20 * (uniform(bits) - 0.5), extent = 3 * period * uniform(bits);
    constexpr int samples = 20000;
    int inside = 0;
    for (int i = 0; i < samples; ++i) {
      const double at = x + extent * ((i + 0.5) / samples - 0.5);
      if (std::abs(at - period * std::round(at / period)) <= band / 2) ++inside;
    }
    EXPECT_NEAR(band_cover(static_cast<float>(x), static_cast<float>(extent), static_cast<float>(period),
                           static_cast<float>(band)),
                static_cast<double>(inside) / samples, 2e-3)
        << x << ' ' << extent << ' ' << period << ' ' << band;
  }
}

TEST(Weave, IsDarkOnLinesDarkerOnEveryFifthAndBrightBetween) {
  const float g = 0.02f, sharp = 1e-4f;
  const float open = weave_shade(0.5f * g, 0.5f * g, sharp, sharp, g);
  const float line = weave_shade(1.0f * g, 0.5f * g, sharp, sharp, g);
  const float bold = weave_shade(5.0f * g, 0.5f * g, sharp, sharp, g);
  EXPECT_FLOAT_EQ(open, 1);
  EXPECT_LT(line, 0.8f);
  EXPECT_LT(bold, 0.8f * line);
  EXPECT_NEAR(weave_shade(0.5f * g, 1.0f * g, sharp, sharp, g), line, 1e-5f);  // the same along v
  EXPECT_NEAR(weave_shade(-1.0f * g, 0.5f * g, sharp, sharp, g), line, 1e-5f);
}

TEST(Weave, FadesToItsMeanUnderAPixelThatCoversManyLines) {
  for (const float x : {0.0f, 0.003f, 0.01f, 0.137f})
    EXPECT_NEAR(weave_shade(x, x, 7.9f, 7.9f, 0.02f), weave_mean(0.02f), 5e-3);
}

TEST(Weave, IsAbsentWithoutAGridWidth) {
  EXPECT_EQ(weave_shade(0, 0, 0, 0, 0), 1);
  EXPECT_EQ(weave_mean(0), 1);
}

}  // namespace
}  // namespace toile::internal
