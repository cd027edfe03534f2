// A recorded foot that is turned farther than an ankle can: led back, without a jump; others are left alone.
#include "rig/ankle_turns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace toile::internal {
namespace {

constexpr double frames_per_s = 120;

Quaternion bent(double degrees) { return rotation_about(Vec3(1, 0, 0), degrees * std::numbers::pi / 180); }
const Quaternion shank = rotation_about(Vec3(0, 0.6, 0.8), 0.7);

std::vector<AnkleTurn> foot(std::size_t frames, double degrees) {
  return std::vector<AnkleTurn>(frames, {shank, shank * bent(degrees)});
}

double bend_deg(const AnkleTurn& ankle) {
  const Quaternion turn = ankle.shank.inverse() * ankle.foot;
  return 2 * std::atan2(turn.v.norm(), std::abs(turn.w)) * 180 / std::numbers::pi;
}

TEST(AnkleTurns, WhatAnAnkleCanDoIsLeftToTheBit) {
  std::vector<AnkleTurn> frames = foot(5, 59.9);
  const Quaternion was = frames[2].foot;
  EXPECT_EQ(hold_ankle(frames, frames_per_s).degrees, 0);
  EXPECT_TRUE(frames[2].foot.w == was.w && frames[2].foot.v == was.v);
}

TEST(AnkleTurns, WhatItCannotIsTheLessTheFartherItGoes) {
  for (const auto& [turned, left] :
       std::vector<std::pair<double, double>>{{66, 48}, {75, 30}, {89, 2}, {160, 0}, {180, 0}}) {
    std::vector<AnkleTurn> frames = foot(5, turned);
    EXPECT_NEAR(hold_ankle(frames, frames_per_s).degrees, turned, 1e-6);
    EXPECT_NEAR(bend_deg(frames[2]), left, 1e-5) << turned;
  }
}

// A foot that turns once around its ankle within a second, the axis changing sides half way.
TEST(AnkleTurns, AFootThatGoesRoundDoesNotJump) {
  std::vector<AnkleTurn> frames;
  for (int f = 0; f <= 240; ++f) {
    const double t = f / 240.0, smooth = t * t * t * (10 + t * (-15 + 6 * t));  // at rest at both ends
    frames.push_back({shank, shank * bent(360 * smooth)});
  }
  const std::vector<AnkleTurn> was = frames;
  EXPECT_GT(hold_ankle(frames, frames_per_s).degrees, 179);
  EXPECT_NEAR(bend_deg(frames[120]), 0, 1e-6);
  for (std::size_t f = 0; f < frames.size(); ++f) EXPECT_LT(bend_deg(frames[f]), 60.001) << f;
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const Quaternion step = frames[f - 1].foot.inverse() * frames[f].foot;
    const double degrees = 2 * std::atan2(step.v.norm(), std::abs(step.w)) * 180 / std::numbers::pi;
    EXPECT_LT(degrees, 5) << f;  // 600 degrees a second; recorded: 340
  }
  EXPECT_TRUE(frames[10].foot.v == was[10].foot.v);
}

}  // namespace
}  // namespace toile::internal
