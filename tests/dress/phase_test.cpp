// What phases leave of gravity, elastic, friction and labels, in time.
#include "dress/phase.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

TEST(Phase, ARampIsStraightBetweenItsEnds) {
  const Ramp ramp{1, 3, 4, 8};
  EXPECT_EQ(ramp.at(0), 4);
  EXPECT_EQ(ramp.at(1), 4);
  EXPECT_EQ(ramp.at(2), 6);
  EXPECT_EQ(ramp.at(3), 8);
  EXPECT_EQ(ramp.at(9), 8);
  const Ramp jump{1, 1, 0, 1};
  EXPECT_EQ(jump.at(0.999), 0);
  EXPECT_EQ(jump.at(1), 1);
}

TEST(Phase, AWeldGetsItsWeightThenLosesItsLabels) {
  const Phase phase = after_weld(true, Pace{});
  for (const double t_s : {0.0, 0.2}) {
    EXPECT_EQ(phase.gravity.at(t_s), 0) << t_s;
    EXPECT_EQ(phase.elastic.at(t_s), 0) << t_s;
    EXPECT_EQ(phase.labels.at(t_s), 1) << t_s;
  }
  EXPECT_NEAR(phase.gravity.at(0.35), 0.5, 1e-12);
  EXPECT_EQ(phase.gravity.at(settling_s), 1);
  EXPECT_EQ(phase.labels.at(settling_s), 1);
  EXPECT_NEAR(phase.labels.at(0.75), 0.5, 1e-12);
  EXPECT_EQ(phase.labels.at(1), 0);
  EXPECT_EQ(phase.settled_s, settling_s);
}

// What is worn below stands still until then, and would slide down after it.
TEST(Phase, AFirstGarmentSlipsLongerThanOneOverOthers) {
  EXPECT_EQ(after_weld(true, Pace{}).friction.at(0.99), 0);
  EXPECT_EQ(after_weld(true, Pace{}).friction.at(1), 1);
  const Phase over_others = after_weld(false, Pace{});
  EXPECT_EQ(over_others.friction.at(0.49), 0);
  EXPECT_EQ(over_others.friction.at(over_others.held_until_s), 1);
}

TEST(Phase, NothingSticksNorSettlesWithinABodyThatGrows) {
  const Phase falls = within_growing(false), hangs = within_growing(true), apart = coming_apart(awaiting_rest);
  for (const Phase& phase : {falls, hangs, apart}) {
    EXPECT_EQ(phase.elastic.at(100), 0);
    EXPECT_EQ(phase.friction.at(100), 0);
    EXPECT_EQ(phase.labels.at(100), 1);
    EXPECT_GT(phase.settled_s, 1e9);
    EXPECT_GT(phase.held_until_s, 1e9);
  }
  EXPECT_EQ(falls.gravity.at(1), 1);
  EXPECT_EQ(hangs.gravity.at(1), 0);
  EXPECT_EQ(apart.gravity.at(1), 0);
  EXPECT_EQ(apart.pace.step_max_s, awaiting_rest.step_max_s);
}

TEST(Phase, WhatIsDrawnHasAllFromTheStart) {
  const Phase phase = as_drawn(steps_of(0.1), steps_of(0.2));
  for (const Ramp& ramp : {phase.gravity, phase.elastic, phase.friction}) EXPECT_EQ(ramp.at(0), 1);
  EXPECT_EQ(phase.labels.at(0), 0);
  EXPECT_EQ(phase.held_until_s, 0);
  EXPECT_EQ(phase.settled_s, 0);
}

}  // namespace
}  // namespace toile::internal
