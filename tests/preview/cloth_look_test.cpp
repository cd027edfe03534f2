#include "preview/cloth_look.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace toile::internal {
namespace {

// Over 3 x 3 cm, sampled.
Vec3f mean_of_threads(const ClothLook& look, bool right_side, float extent_m) {
  constexpr int samples = 700;
  Vec3f sum = Vec3f::Zero();
  for (int i = 0; i < samples; ++i)
    for (int j = 0; j < samples; ++j)
      sum += thread_colour(look, right_side, Vec2(0.03 * (i + 0.5) / samples, 0.2 + 0.03 * (j + 0.5) / samples),
                           Vec2f::Constant(extent_m));
  return sum / static_cast<float>(samples * samples);
}

TEST(ClothLook, ACloseUpHasTheColourOfTheClothFromAfar) {
  for (const std::string fabric : {"silk", "cotton", "wool", "denim", "knit"}) {
    const ClothLook look = look_of(fabric);
    for (const bool right_side : {true, false}) {
      const Vec3f mean = mean_colour(look, right_side);
      for (const float extent_m : {1e-6f, 2e-4f, 1e-3f}) {
        const Vec3f threads = mean_of_threads(look, right_side, extent_m);
        EXPECT_LT((threads - mean).cwiseQuotient(mean).cwiseAbs().maxCoeff(), 0.02f)
            << fabric << ' ' << right_side << ' ' << extent_m << ' ' << threads.transpose() << " and "
            << mean.transpose();
      }
    }
  }
}

TEST(ClothLook, ThreadsAreSeenCloseUpAndNotFromAfar) {
  const auto spread = [](const ClothLook& look, float extent_m) {
    float low = 1e9f, high = 0;
    for (int i = 0; i < 400; ++i) {
      const float value = luminance(thread_colour(look, true, Vec2(3.7e-5 * i, 2.3e-5 * i), Vec2f::Constant(extent_m)));
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return (high - low) / luminance(mean_colour(look, true));
  };
  for (const std::string fabric : {"silk", "cotton", "wool", "denim", "knit"}) {
    const ClothLook look = look_of(fabric);
    EXPECT_GT(spread(look, 1e-6f), 0.25f) << fabric;
    EXPECT_LT(spread(look, 0.01f), 0.03f) << fabric;
  }
}

// Of a twill whose weft is pale, the wrong side is the paler one.
TEST(ClothLook, DenimIsPaleInside) {
  const ClothLook denim = look_of("denim");
  EXPECT_GT(luminance(mean_colour(denim, false)), 2 * luminance(mean_colour(denim, true)));
}

TEST(ClothLook, UnknownFabricsLookLikeCotton) {
  EXPECT_EQ(look_of("").warp, look_of("cotton").warp);
  EXPECT_NE(look_of("silk").warp, look_of("cotton").warp);
}

TEST(ClothLook, DyedClothHasTheNewColourAndItsThreadsDiffer) {
  const ClothLook cotton = look_of("cotton"), red = dyed(cotton, Vec3f(0.5f, 0.1f, 0.1f));
  const Vec3f mean = mean_colour(red, true);
  EXPECT_NEAR(mean.x(), 0.5f, 1e-3f);
  EXPECT_NEAR(mean.y(), 0.1f, 1e-3f);
  EXPECT_NEAR(luminance(red.warp) / luminance(red.weft), luminance(cotton.warp) / luminance(cotton.weft), 1e-4f);
}

TEST(ClothLook, LineCoverIsTheExactShareOfTheInterval) {
  for (const float x : {-0.9f, -0.3f, 0.0f, 0.2f, 0.6f, 1.4f})
    for (const float extent : {0.01f, 0.5f, 3.0f}) {
      constexpr int samples = 20000;
      int inside = 0;
      for (int i = 0; i < samples; ++i)
        if (std::abs(x + extent * ((static_cast<float>(i) + 0.5f) / samples - 0.5f)) <= 0.5f) ++inside;
      EXPECT_NEAR(line_cover(x, extent, 1.0f), static_cast<float>(inside) / samples, 2e-3f) << x << ' ' << extent;
    }
}

}  // namespace
}  // namespace toile::internal
