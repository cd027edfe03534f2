#include "preview/print.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "preview/srgb.hpp"

namespace toile::internal {
namespace {

const Vec3f red(0.8f, 0, 0), blue(0, 0, 0.7f), white(0.9f, 0.9f, 0.9f);
const Vec2f fine = Vec2f::Constant(1e-6f);

Sett sett() { return Sett({{red, 0.01}, {white, 0.02}}); }
Print stripes(const Vec2& offset_m = {0, 0}, double turn_deg = 0) {
  return {Stripes{sett()}, offset_m, turn_deg * std::numbers::pi / 180, 1};
}
Print dots() { return {Dots{blue, 0.006, 0.02}, {0, 0}, 0, 1}; }

// From the top: black and white, red and green.
Texture four_texels() {
  const std::vector<std::uint8_t> rgba{0, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 255, 0, 255, 0, 255};
  return {2, 2, rgba};
}
Print picture(const Texture& texture, const Vec2& repeat_m) { return {Picture{texture, repeat_m}, {0, 0}, 0, 1}; }

TEST(Print, StripesLieSideBySideAndRepeat) {
  const Print print = stripes();
  for (const double x : {0.005, 0.035, -0.025, 3.005}) {
    EXPECT_LT((print.at({x, 7.3}, fine).warp - red).norm(), 1e-5f) << x;
    EXPECT_LT((print.at({x + 0.015, -1}, fine).weft - white).norm(), 1e-5f) << x;
  }
  EXPECT_EQ(print.at({0.005, 0}, fine).cover, 1.0f);
}

TEST(Print, IsMovedAndTurnedInTheDrawing) {
  EXPECT_LT((stripes({0.012, 0}).at({0.013, 0}, fine).warp - red).norm(), 1e-5f);
  EXPECT_LT((stripes({0.012, 0}).at({0.011, 0}, fine).warp - white).norm(), 1e-5f);
  // A quarter turn, counter-clockwise: what was along x is along y.
  const Print across = stripes({0, 0}, 90);
  for (const double x : {-0.4, 0.0, 0.013}) {
    EXPECT_LT((across.at({x, 0.005}, fine).warp - red).norm(), 1e-5f) << x;
    EXPECT_LT((across.at({x, 0.015}, fine).warp - white).norm(), 1e-5f) << x;
  }
  // Turned around its own origin, and then moved.
  EXPECT_LT((stripes({0.5, 0.001}, 90).at({0, 0.0105}, fine).warp - red).norm(), 1e-5f);
  EXPECT_LT((stripes({0.5, 0.001}, 90).at({0, 0.0115}, fine).warp - white).norm(), 1e-5f);
  EXPECT_LT((stripes({0, 0}, 45).at({0.007, 0.007}, fine).warp - red).norm(), 1e-5f);
  EXPECT_LT((stripes({0, 0}, 45).at({0.008, 0.008}, fine).warp - white).norm(), 1e-5f);
}

TEST(Print, StripesAreTheExactMeanOverAPixel) {
  const Sett two = sett();
  for (const double x : {0.0, 0.004, 0.0101, 0.0295, -0.7}) {
    for (const double extent : {1e-4, 0.003, 0.03, 0.047, 1.0}) {
      constexpr int samples = 20000;
      int in_red = 0;
      for (int i = 0; i < samples; ++i) {
        const double at = (x + extent * ((i + 0.5) / samples - 0.5)) / 0.03;
        if (at - std::floor(at) < 1.0 / 3) ++in_red;
      }
      const float share = static_cast<float>(in_red) / samples;
      EXPECT_LT((two.mean_over(x, extent) - (share * red + (1 - share) * white)).norm(), 1e-3f) << x << ' ' << extent;
    }
  }
  EXPECT_LT((two.mean() - (red + 2 * white) / 3).norm(), 1e-6f);
}

// Along the stripes a pixel may be as long as it likes.
TEST(Print, ALongPixelSeesItsOwnDirectionOnly) {
  EXPECT_LT((stripes().at({0.005, 0}, {1e-6f, 0.5f}).warp - red).norm(), 1e-5f);
  EXPECT_LT((stripes({0, 0}, 90).at({0, 0.005}, {0.5f, 1e-6f}).warp - red).norm(), 1e-5f);
}

TEST(Print, ACheckHasTheSettInItsWarpAndInItsWeft) {
  const Print check{Check{sett()}, {0, 0}, 0, 1};
  const Dye crossing = check.at({0.005, 0.02}, fine);
  EXPECT_LT((crossing.warp - red).norm(), 1e-5f);
  EXPECT_LT((crossing.weft - white).norm(), 1e-5f);
  const Dye other = check.at({0.02, 0.005}, fine);
  EXPECT_LT((other.warp - white).norm(), 1e-5f);
  EXPECT_LT((other.weft - red).norm(), 1e-5f);
  EXPECT_TRUE(check.is_woven());
  EXPECT_FALSE(stripes().is_woven());
}

TEST(Print, DotsLieOnAGrid) {
  const Print print = dots();
  for (const Vec2& centre : {Vec2(0, 0), Vec2(0.02, -0.04), Vec2(0.1, 0.02)}) {
    EXPECT_NEAR(print.at(centre + Vec2(0.0028, 0), fine).cover, 1, 1e-5);
    EXPECT_NEAR(print.at(centre + Vec2(0, 0.0032), fine).cover, 0, 1e-5);
    EXPECT_NEAR(print.at(centre + Vec2(0.0024, 0.0024), fine).cover, 0, 1e-5) << "round";
    EXPECT_NEAR(print.at(centre + Vec2(0.01, 0.01), fine).cover, 0, 1e-5);
  }
  EXPECT_LT((print.at({0, 0}, fine).warp - blue).norm(), 1e-5f);
}

TEST(Print, DotsKeepTheirMeanAtAnyDistance) {
  const Print print = dots();
  const double share = std::numbers::pi * 0.003 * 0.003 / (0.02 * 0.02);
  EXPECT_NEAR(print.mean().cover, share, 1e-6);
  for (const float extent : {1e-6f, 1e-3f, 5e-3f, 0.013f, 0.03f, 0.1f}) {
    double sum = 0;
    constexpr int samples = 120;
    for (int i = 0; i < samples; ++i)
      for (int j = 0; j < samples; ++j)
        sum += print.at({0.02 * (i + 0.5) / samples, 0.02 * (j + 0.5) / samples}, Vec2f::Constant(extent)).cover;
    EXPECT_NEAR(sum / (samples * samples), share, 0.02 * share) << extent;
  }
  EXPECT_FLOAT_EQ(print.at({0, 0}, Vec2f::Constant(0.05f)).cover, print.mean().cover);
}

TEST(Print, APictureStandsUprightOnItsLowerLeftCorner) {
  const Print print = picture(four_texels(), {0.2, 0.1});
  const auto at = [&](double x, double y) -> Vec3f { return print.at({x, y}, fine).warp; };
  EXPECT_LT((at(0.05, 0.025) - Vec3f(0.9f, 0, 0)).norm(), 1e-4f);
  EXPECT_LT((at(0.15, 0.025) - Vec3f(0, 0.9f, 0)).norm(), 1e-4f);
  EXPECT_LT((at(0.05, 0.075) - Vec3f(0, 0, 0)).norm(), 1e-4f);
  EXPECT_LT((at(0.15, 0.075) - white).norm(), 1e-4f);
  EXPECT_LT((at(0.15 - 0.4, 0.075 + 0.3) - white).norm(), 1e-4f) << "repeats";
  // Half way between the middles of two texels.
  EXPECT_LT((at(0.1, 0.025) - Vec3f(0.5f, 0.5f, 0)).norm(), 1e-4f);
}

TEST(Print, APictureIsMixedInLinearLight) {
  const std::vector<std::uint8_t> grey{188, 188, 188, 255};
  EXPECT_NEAR(Texture(1, 1, grey).mean().x(), srgb_decoded(188 / 255.0f), 1e-4f);
  EXPECT_NEAR(Texture(1, 1, grey).mean().x(), 0.5029f, 1e-3f);
  // A checkerboard of black and white, from afar: half the light.
  std::vector<std::uint8_t> board;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 30; ++x)
      for (int k = 0; k < 4; ++k) board.push_back(k == 3 || (x + y) % 2 == 0 ? 255 : 0);
  const Texture texture(30, 50, board);
  EXPECT_NEAR(texture.mean().x(), 0.5f, 1e-4f);
  EXPECT_NEAR(texture.mean().w(), 1.0f, 1e-6f);
  for (const double x : {0.1, 0.33, 0.99}) EXPECT_NEAR(texture.at({x, 0.4}, Vec2f(0.3f, 0.3f)).x(), 0.5f, 0.02f) << x;
}

TEST(Print, APictureSeenAslantIsBlurredAlongOneDirectionOnly) {
  std::vector<std::uint8_t> lines;  // upright, 8 texels wide
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int k = 0; k < 4; ++k) lines.push_back(k == 3 || x / 8 % 2 == 0 ? 255 : 0);
  const Texture texture(64, 64, lines);
  const Vec2f narrow(1 / 64.0f, 8 / 64.0f);
  EXPECT_NEAR(texture.at({4.0 / 64, 0.3}, narrow).x(), 1.0f, 1e-3f);
  EXPECT_NEAR(texture.at({12.0 / 64, 0.3}, narrow).x(), 0.0f, 1e-3f);
}

TEST(Print, APicturesOpacityWeighsItsColours) {
  // Red that is seen, and green that is not.
  const std::vector<std::uint8_t> rgba{255, 0, 0, 255, 0, 255, 0, 0};
  const Dye mean = picture(Texture(2, 1, rgba), {0.1, 0.1}).mean();
  EXPECT_NEAR(mean.cover, 0.5f, 1e-4f);
  EXPECT_NEAR(mean.warp.x(), 0.45f, 1e-4f);
  EXPECT_NEAR(mean.warp.y(), 0.0f, 1e-4f);
}

TEST(Print, WhatIsNotFiniteGivesTheMean) {
  EXPECT_TRUE(stripes().at({NAN, 0}, fine).warp.allFinite());
  EXPECT_TRUE(picture(four_texels(), {0.1, 0.1}).at({0, 0}, {INFINITY, 1}).warp.allFinite());
}

}  // namespace
}  // namespace toile::internal
