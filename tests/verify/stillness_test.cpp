// When cloth is said to be at rest.
#include "verify/stillness.hpp"

#include "core/error.hpp"
#include "core/state_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

constexpr double mm = 1e-3;

// 100 vertices; `way(frame)` in mm along z for all of them.
template <class Way>
StillnessMeter fed(double fps, int frames, Way way, double window_s = 1) {
  StillnessMeter meter(fps, window_s);
  for (int frame = 0; frame <= frames; ++frame) meter.add(Vec3s(100, Vec3(0.1, 0, mm * way(frame))));
  return meter;
}

TEST(Stillness, OfASteadyMotionIsItsSpeedAtAnyRate) {
  for (const double fps : {10.0, 30.0, 240.0}) {
    const StillnessMeter meter = fed(fps, 500, [&](int frame) { return 8 * frame / fps; });
    EXPECT_TRUE(meter.full());
    EXPECT_NEAR(meter.speed_p99_mm_per_s(), 8, 1e-3) << fps;
  }
}

TEST(Stillness, OverItsFirstFramesDividesByTheirTime) {
  EXPECT_EQ(fed(30, 0, [](int) { return 7; }).speed_p99_mm_per_s(), 0);
  const StillnessMeter half = fed(30, 15, [](int frame) { return frame; });
  EXPECT_FALSE(half.full());
  EXPECT_NEAR(half.speed_p99_mm_per_s(), 30, 1e-3);
  EXPECT_TRUE(fed(
                  30, 15, [](int frame) { return frame; }, 0.5)
                  .full());
}

// A jump of 6 mm counts for a second, and no longer.
TEST(Stillness, LooksBackForASecond) {
  const auto jump = [](int frame) { return frame > 0 ? 6 : 0; };
  EXPECT_NEAR(fed(30, 30, jump).speed_p99_mm_per_s(), 6, 1e-3);
  EXPECT_NEAR(fed(30, 31, jump).speed_p99_mm_per_s(), 0, 1e-3);
}

// A swing returns to where it was: the farthest place of the second counts, not that at its beginning.
TEST(Stillness, OfASwingIsItsWidthHoweverFastItIs) {
  for (const double hertz : {1.0, 2.0, 7.5})
    EXPECT_NEAR(fed(30, 120, [&](int frame) { return 4 * std::cos(2 * std::numbers::pi * hertz * frame / 30); })
                    .speed_p99_mm_per_s(),
                8, 0.1)
        << hertz;
}

TEST(Stillness, IsTheNinetyNinthPercentileOfTheVertices) {
  StillnessMeter meter(30, 1.0 / 30);
  Vec3s x(100, Vec3(1, 1, 1));
  meter.add(x);
  for (std::size_t i = 0; i < 100; ++i) x[i].z() += 1e-4 * static_cast<double>(i + 1);
  meter.add(x);
  EXPECT_NEAR(meter.speed_p99_mm_per_s(), 30 * 9.9, 0.01);
}

TEST(Stillness, StartsAnewAfterAFrameThatCannotBeMeasured) {
  StillnessMeter meter = fed(30, 60, [](int frame) { return 10 * frame; });
  meter.skip();
  EXPECT_TRUE(meter.empty());
  EXPECT_EQ(meter.speed_p99_mm_per_s(), 0);
  meter.add(Vec3s(7, Vec3::Zero()));
  EXPECT_THROW(meter.add(Vec3s(8, Vec3::Zero())), InputError);
}

TEST(Stillness, GoesOnFromItsState) {
  StillnessMeter meter = fed(30, 40, [](int frame) { return 3 * frame; }), later;
  StateWriter writer;
  writer(meter);
  StateReader reader(writer.bytes(), "state");
  reader(later);
  for (StillnessMeter* m : {&meter, &later}) m->add(Vec3s(100, Vec3(0.1, 0, 0.2)));
  EXPECT_TRUE(later.full());
  EXPECT_EQ(later.speed_p99_mm_per_s(), meter.speed_p99_mm_per_s());
}

}  // namespace
}  // namespace toile::internal
