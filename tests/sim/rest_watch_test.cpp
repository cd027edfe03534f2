// When cloth is said to be at rest.
#include "sim/rest_watch.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace toile::internal {
namespace {

// After how many frames, at 30 a second, cloth rests that is this slow, mm/s; -1: not within three seconds.
int rests_after(double mm_per_s, const RestLimits& limits) {
  RestWatch watch;
  Vec3s x(100, Vec3::Zero());
  watch.begin(x, 30, limits);
  for (int frame = 1; frame <= 90; ++frame) {
    for (Vec3& p : x) p.x() += 1e-3 * mm_per_s / 30;
    watch.frame(x);
    if (watch.at_rest()) return frame;
  }
  return -1;
}

TEST(RestWatch, CallsADrapeStillBelowTwoMillimetresPerSecondForHalfASecond) {
  EXPECT_EQ(rests_after(1, still), 15);
  EXPECT_EQ(rests_after(3, still), -1);
}

TEST(RestWatch, HasLimitsOfItsOwnForWhatOthersGoOver) {
  const RestLimits coarse{10, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(rests_after(8, coarse), 15);
  EXPECT_EQ(rests_after(12, coarse), -1);
}

// What was too fast within the last second is not still, however slow it is now.
TEST(RestWatch, LooksBackForASecond) {
  RestWatch watch;
  Vec3s x(100, Vec3::Zero());
  watch.begin(x, 30);
  int frame = 0;
  const auto move = [&](double mm_per_s, int frames) {
    for (int k = 0; k < frames; ++k, ++frame) {
      for (Vec3& p : x) p.x() += 1e-3 * mm_per_s / 30;
      watch.frame(x);
    }
  };
  move(100, 1);
  move(1, 29);
  EXPECT_FALSE(watch.at_rest()) << frame;
  move(1, 1);
  EXPECT_TRUE(watch.at_rest()) << frame;
}

}  // namespace
}  // namespace toile::internal
