// A recorded spine that folds in one joint: shared by all of them, without a jump; others are left alone.
#include "rig/spine_bends.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

const Vec3 up(0, 1, 0);
constexpr double rate_hz = 120;

Quaternion forwards(double degrees) { return rotation_about(Vec3(1, 0, 0), degrees * std::numbers::pi / 180); }

// Turns in the world of hips that lean by `hips`, and of joints each bent by so much against the one below.
SpineTurns spine(double hips, const std::vector<double>& bends) {
  SpineTurns turns = {forwards(hips)};
  for (const double bend : bends) turns.push_back(turns.back() * forwards(bend));
  return turns;
}

double bend(const SpineTurns& turns, std::size_t joint) {
  const double cosine = (turns[joint - 1] * up).dot(turns[joint] * up);
  return std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi;
}

bool same_bits(const Quaternion& p, const Quaternion& q) { return p.w == q.w && p.v == q.v; }

TEST(SpineBends, WhatOneJointCannotIsSharedByAll) {
  std::vector<SpineTurns> frames(5, spine(20, {80, -5, -15}));
  const SpineTurns was = frames[2];
  const SpineBend most = share_bends(frames, up, rate_hz);
  EXPECT_NEAR(most.degrees, 80, 1e-9);
  EXPECT_EQ(most.joint, 1U);
  for (std::size_t joint = 1; joint <= 3; ++joint) EXPECT_LT(bend(frames[2], joint), 30 + 1e-6) << joint;
  EXPECT_GT(bend(frames[2], 1), 29);  // no more than is needed
  EXPECT_TRUE(same_bits(frames[2].front(), was.front()));
  EXPECT_TRUE(same_bits(frames[2].back(), was.back()));
}

TEST(SpineBends, ASpineThatBendsTooFarAsAWholeEndsAtEvenShares) {
  std::vector<SpineTurns> frames(3, spine(0, {100, 20}));
  share_bends(frames, up, rate_hz);
  EXPECT_NEAR(bend(frames[1], 1), 60, 1e-6);
  EXPECT_NEAR(bend(frames[1], 2), 60, 1e-6);
}

TEST(SpineBends, WhatASpineCanDoIsLeftToTheBit) {
  std::vector<SpineTurns> frames(3, spine(30, {25, 29, -20}));
  const std::vector<SpineTurns> was = frames;
  EXPECT_EQ(share_bends(frames, up, rate_hz).degrees, 0);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(same_bits(frames[1][i], was[1][i]));
}

TEST(SpineBends, AJointAloneKeepsWhatItHas) {
  std::vector<SpineTurns> frames(3, spine(0, {120}));
  const Quaternion was = frames[0].back();
  EXPECT_EQ(share_bends(frames, up, rate_hz).degrees, 0);
  EXPECT_TRUE(same_bits(frames[0].back(), was));
}

// A fold that comes and goes within a second.
TEST(SpineBends, IsSharedWithoutAJumpInSpeed) {
  std::vector<SpineTurns> frames;
  for (int f = 0; f <= 240; ++f)
    frames.push_back(spine(0, {80 * std::pow(std::sin(std::numbers::pi * f / 240.0), 16), 0, 0}));
  const std::vector<SpineTurns> was = frames;
  share_bends(frames, up, rate_hz);
  std::vector<double> taken;
  for (std::size_t f = 0; f < frames.size(); ++f) taken.push_back(bend(was[f], 1) - bend(frames[f], 1));
  EXPECT_GT(taken[120], 45);
  EXPECT_TRUE(same_bits(frames[30][1], was[30][1]));
  for (std::size_t f = 1; f + 1 < taken.size(); ++f)
    EXPECT_LT(std::abs(taken[f + 1] - 2 * taken[f] + taken[f - 1]), 0.02 * taken[120]) << f;
}

}  // namespace
}  // namespace toile::internal
