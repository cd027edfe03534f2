// When cloth is said to be at rest.
#include "sim/rest_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(RestWatch, CallsADrapeStillThatComesAMillimetreFarInHalfASecond) {
  EXPECT_EQ(rests_after(1, still), 15);
  EXPECT_EQ(rests_after(3, still), -1);
}

TEST(RestWatch, HasLimitsOfItsOwnForWhatOthersGoOver) {
  const RestLimits coarse{5, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(rests_after(8, coarse), 15);
  EXPECT_EQ(rests_after(12, coarse), -1);
}

// To and fro by 0.1 mm from frame to frame is 3 mm/s, and goes nowhere.
TEST(RestWatch, LooksAtTheWayNotAtATremble) {
  const auto rests = [](double amplitude_mm) {
    RestWatch watch;
    const Vec3s here(100, Vec3::Zero()), there(100, Vec3(1e-3 * amplitude_mm, 0, 0));
    watch.begin(here, 30);
    for (int frame = 1; frame <= 60; ++frame) watch.frame(frame % 2 == 1 ? there : here);
    return watch.at_rest();
  };
  EXPECT_TRUE(rests(0.1));
  EXPECT_FALSE(rests(0.2)) << "6 mm/s, above the verdict's limit";
}

// Away by 1.1 mm and back again within half a second, at 4.8 mm/s, is a way too.
TEST(RestWatch, SeesWhatCameBack) {
  RestWatch watch;
  Vec3s x(100, Vec3::Zero());
  watch.begin(x, 30);
  for (int frame = 1; frame <= 60; ++frame) {
    x.assign(x.size(), Vec3(0.00016 * std::min(frame % 15, 15 - frame % 15), 0, 0));
    watch.frame(x);
  }
  EXPECT_FALSE(watch.at_rest());
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
