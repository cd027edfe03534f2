#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"
#include "preview/pictures.hpp"
#include "preview/preview.hpp"

namespace toile::internal {
namespace {

TEST(Camera, FramesAllCornersOfABoxWithAMarginAndNoMoreThanThat) {
  const Vec3 low(-0.5, 0.1, -0.2), high(0.4, 1.8, 0.3);
  for (const double aspect : {0.5, 0.8, 1.0, 2.0}) {
    for (const double elevation : {-90.0, -30.0, 0.0, 15.0, 60.0, 90.0}) {
      for (double azimuth = -180; azimuth <= 360; azimuth += 37) {
        const Camera camera = frame_subject(low, high, azimuth, elevation, aspect);
        const int height = 1000, width = static_cast<int>(1000 * aspect);
        double reach = 0;
        for (int c = 0; c < 8; ++c) {
          const Vec3 corner(c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(), c & 4 ? high.z() : low.z());
          const Vec3 p = project(camera, width, height, corner);
          ASSERT_GT(p.z(), 0);
          reach = std::max({reach, std::abs(2 * p.x() / width - 1), std::abs(2 * p.y() / height - 1)});
        }
        EXPECT_LE(reach, 0.9201) << azimuth << ' ' << elevation << ' ' << aspect;
        EXPECT_GE(reach, 0.9199) << azimuth << ' ' << elevation << ' ' << aspect;
      }
    }
  }
}

TEST(Camera, LooksFromTheFrontTheLeftSideAndTheBack) {
  const Vec3 low(-1, 0, -1), high(1, 2, 1);
  EXPECT_GT(frame_subject(low, high, 0, 0, 1).eye.z(), 2);
  EXPECT_GT(frame_subject(low, high, 90, 0, 1).eye.x(), 2);
  EXPECT_LT(frame_subject(low, high, 180, 0, 1).eye.z(), -2);
  EXPECT_GT(frame_subject(low, high, 0, 30, 1).eye.y(), 2);
}

TEST(Camera, ShowsTheLeftSideOfAFacingBodyOnTheRightOfThePictureAndUpAbove) {
  const Camera camera{{0, 1, 5}, {0, 1, 0}, 28};
  const Vec3 centre = project(camera, 200, 100, {0, 1, 0});
  EXPECT_NEAR(centre.x(), 100, 1e-9);
  EXPECT_NEAR(centre.y(), 50, 1e-9);
  EXPECT_NEAR(centre.z(), 5, 1e-12);
  EXPECT_GT(project(camera, 200, 100, {0.5, 1, 0}).x(), 110);
  EXPECT_LT(project(camera, 200, 100, {0, 1.5, 0}).y(), 40);
  // The upper edge of the picture at the distance of the target.
  EXPECT_NEAR(project(camera, 200, 100, {0, 1 + 5 * std::tan(14 * M_PI / 180), 0}).y(), 0, 1e-9);
  EXPECT_LE(project(camera, 200, 100, {0, 1, 6}).z(), 0);
}

TEST(Camera, FramesAPointFromAFiniteDistance) {
  const Camera camera = frame_subject({1, 2, 3}, {1, 2, 3}, 20, 10, 1);
  EXPECT_GT((camera.eye - camera.target).norm(), 0.01);
  EXPECT_TRUE(camera.eye.allFinite());
}

// A camera that was framed anew for each view would come and go as the box turns.
TEST(Camera, ATurntableKeepsItsDistanceAndHoldsTheBoxAllTheWay) {
  const Vec3 low(-0.3, 0.8, -0.1), high(0.5, 1.5, 0.2);
  const std::vector<Camera> cameras = turntable(low, high, 8, 0.75, 24);
  ASSERT_EQ(cameras.size(), 24u);
  EXPECT_LT(
      (cameras[0].eye - frame_subject(low, high, 0, 8, 0.75).eye).cross(cameras[0].eye - cameras[0].target).norm(),
      1e-9);
  for (const Camera& camera : cameras) {
    EXPECT_NEAR((camera.eye - camera.target).norm(), (cameras[0].eye - cameras[0].target).norm(), 1e-12);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p((corner & 1) ? high.x() : low.x(), (corner & 2) ? high.y() : low.y(),
                   (corner & 4) ? high.z() : low.z());
      const Vec3 seen = project(camera, 300, 400, p);
      EXPECT_GT(seen.x(), 0.04 * 300 - 1e-6);
      EXPECT_LT(seen.x(), 0.96 * 300 + 1e-6);
      EXPECT_GT(seen.y(), 0.04 * 400 - 1e-6);
      EXPECT_LT(seen.y(), 0.96 * 400 + 1e-6);
    }
  }
  EXPECT_THROW(turntable(low, high, 8, 0.75, -1), InputError);
  EXPECT_TRUE(turntable(low, high, 8, 0.75, 0).empty());
}

TEST(Camera, RefusesWhatCannotBeFramed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(frame_subject({0, 0, nan}, {1, 1, 1}, 0, 0, 1), InputError);
  EXPECT_THROW(frame_subject({2, 0, 0}, {1, 1, 1}, 0, 0, 1), InputError);
  EXPECT_THROW(frame_subject({0, 0, 0}, {1, 1, 1}, nan, 0, 1), InputError);
  EXPECT_THROW(frame_subject({0, 0, 0}, {1, 1, 1}, 0, 91, 1), InputError);
  EXPECT_THROW(frame_subject({0, 0, 0}, {1, 1, 1}, 0, 0, 0), InputError);
  EXPECT_THROW(project({{0, 0, 0}, {0, 0, 0}, 28}, 10, 10, {1, 0, 0}), InputError);
  EXPECT_THROW(project({{0, 0, 1}, {0, 0, 0}, 180}, 10, 10, {1, 0, 0}), InputError);
}

}  // namespace
}  // namespace toile::internal
