// Cloth in a crease of the body, where one particle touches two faces, and between faces less than two offsets apart.
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;

const double offset = BodyContactOptions{}.offset_m;

// A block along z with a notch in its top, whose walls lean out by `half_angle_deg` from a floor of `floor_m` in width; 0: a V.
BodySurface notched(double half_angle_deg, double floor_m, double depth_m) {
  const double half = 0.5 * floor_m, lean = depth_m * std::tan(half_angle_deg * 3.14159265358979323846 / 180);
  std::vector<std::pair<double, double>> profile = {
      {-1, -0.5}, {1, -0.5}, {1, depth_m}, {half + lean, depth_m}, {half, 0}};
  std::vector<Triangle> cap = {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}};
  if (floor_m > 0) {
    profile.insert(profile.end(), {{-half, 0}, {-half - lean, depth_m}, {-1, depth_m}});
    cap.insert(cap.end(), {{0, 4, 5}, {0, 5, 6}, {0, 6, 7}});
  } else {
    profile.insert(profile.end(), {{-lean, depth_m}, {-1, depth_m}});
    cap.insert(cap.end(), {{0, 4, 5}, {0, 5, 6}});
  }
  const auto n = static_cast<Index>(profile.size());
  std::vector<Vec3> x;
  for (const double z : {0.5, -0.5})
    for (const auto& [u, y] : profile) x.emplace_back(u, y, z);
  std::vector<Triangle> triangles;
  for (const Triangle& t : cap) {
    triangles.push_back(t);
    triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    triangles.push_back({i, i + n, j});
    triangles.push_back({j, i + n, j + n});
  }
  return BodySurface(std::move(x), std::move(triangles));
}

// A sheet over the notch, one particle of which is drawn by a force.
struct Drawn {
  Drawn(BodySurface& body, double friction) {
    Sheet sheet = test::equilateral_sheet(0.08, 0.08, 0.02);
    const Vec3 centre(0.04, 0, -0.04);
    const auto nearest = std::min_element(sheet.x.begin(), sheet.x.end(), [&](const Vec3& a, const Vec3& b) {
      return (a - centre).norm() < (b - centre).norm();
    });
    particle = static_cast<Index>(nearest - sheet.x.begin());
    const Vec3 from = *nearest;
    for (Vec3& p : sheet.x) p += Vec3(0.0003, 0.05, 0) - from;
    run.emplace(sheet, Fabric{});
    run->world.body = &body;
    run->step.body.friction = friction;
    run->world.springs = [this](const ClothState&, double, double, std::vector<LinearSpring>& springs) {
      LinearSpring pull;
      pull.particle[0] = particle;
      pull.weight[0] = 1;
      pull.direction = force_N.normalized();
      pull.force_N = force_N.norm();
      springs.push_back(pull);
    };
  }
  const Vec3& place() const { return run->state.x[static_cast<std::size_t>(particle)]; }

  Index particle = 0;
  Vec3 force_N{0, -0.2, 0};
  std::optional<ClothRun> run;
};

TEST(Crease, WhatIsDrawnIntoItComesToRestAtTheOffsetFromBothFaces) {
  for (const double half_angle : {40.0, 50.0, 60.0}) {
    for (const double friction : {0.0, 0.4}) {
      SCOPED_TRACE(testing::Message() << half_angle << " degrees, friction " << friction);
      BodySurface body = notched(half_angle, 0, 0.04);
      Drawn drawn(body, friction);
      drawn.run->step.relinearisations = 6;  // as scenes are run
      drawn.run->run(300);  // threads that are pushed come to rest late (docs/limits.md#cloth-that-is-slow-to-rest)
      const Vec3 settled = drawn.place();
      for (int frame = 0; frame < 30; ++frame) {
        drawn.run->frame();
        EXPECT_GT(body.nearest(drawn.place(), 1).gap_m, 0.97 * offset);
        EXPECT_LT((drawn.place() - settled).norm(), 2e-5);
        EXPECT_LT(drawn.run->fastest(), 1e-3);
      }
      if (friction > 0) continue;  // it may hold the sheet higher up
      EXPECT_LT(body.nearest(drawn.place(), 1).gap_m, 1.03 * offset);
      EXPECT_LT(std::abs(drawn.place().x()), 0.05 * offset);
    }
  }
}

TEST(Crease, OneFaceLetsGoOfWhatIsDrawnOutAlongTheOther) {
  for (const double side : {-1.0, 1.0}) {
    BodySurface body = notched(45, 0, 0.04);
    Drawn drawn(body, 0);
    drawn.run->run(60);
    ASSERT_LT(body.nearest(drawn.place(), 1).gap_m, 1.03 * offset);
    const Vec3 up_the_wall = Vec3(side, 1, 0).normalized(), from_it = Vec3(-side, 1, 0).normalized();
    drawn.force_N = 0.03 * up_the_wall - 0.003 * from_it;
    for (int frame = 0; frame < 30 && drawn.place().dot(up_the_wall) < 4 * offset; ++frame) {
      drawn.run->frame(1.0 / 240);
      EXPECT_NEAR(drawn.place().dot(from_it), offset, 0.05 * offset);
    }
    EXPECT_GE(drawn.place().dot(up_the_wall), 4 * offset);
  }
}

TEST(Crease, BetweenWallsLessThanTwoOffsetsApartItStaysInTheMiddle) {
  BodySurface body = notched(0, 1.2 * offset, 0.04);
  Sheet sheet = test::equilateral_sheet(0.02, 0.02, 0.01);
  for (Vec3& p : sheet.x) p = Vec3(-0.2 * offset, p.x() + 0.01, p.z());
  ModelOptions weightless;
  weightless.gravity_m_per_s2 = Vec3::Zero();
  ClothRun run(sheet, Fabric{}, weightless);
  run.world.body = &body;
  run.run(30);
  for (int frame = 0; frame < 30; ++frame) {
    run.frame();
    for (const Vec3& p : run.state.x) EXPECT_NEAR(p.x(), 0, 0.03 * offset);
    EXPECT_LT(run.fastest(), 1e-4);
  }
}

}  // namespace
}  // namespace toile::internal
