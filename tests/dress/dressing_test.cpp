// A garment that sewing could not close is taken apart and sewn on; around whom it is sewn.
#include "dress/dressing.hpp"

#include "body/mannequin.hpp"
#include "dress/dressing_body.hpp"
#include "garment/garments.hpp"
#include "support/bare_step.hpp"
#include "support/crossings.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

// A tube in the air, and a loose strip between both sides of both its seams, as a fold would be caught.
Pattern tube_with_a_strip_between(double strip_m) {
  Pattern pattern = test::tube_pattern(0.12, 0.12, 0.1);
  pattern.panels.push_back(test::front_rectangle(0.3, strip_m, Vec3::Zero()));
  pattern.panels.back().name = "strip";
  return pattern;
}

struct DressingTube {
  explicit DressingTube(double strip_m) : garment(mesh_garment(tube_with_a_strip_between(strip_m), 0.02)) {
    SewingOptions options;
    options.patience_s = 0.05;
    options.largest_fold_m = 0;
    options.weld_share = 1;
    dressing.emplace(Outfit{}, garment, std::span<const Fabric>(&fabric, 1), std::span<const Vec2>{}, nullptr,
                     test::bare_step(), options);
  }
  SewingStatus sewn() {
    Sewing& sewing = dressing->sewing();
    for (int f = 0; f < 200 && sewing.status() == SewingStatus::sewing; ++f) sewing.frame();
    return sewing.status();
  }
  Fabric fabric;
  GarmentMesh garment;
  std::optional<Dressing> dressing;
};

int crossings_of(const Outfit& outfit) { return test::crossings_of(outfit.state.x, outfit.mesh.triangles); }

TEST(Dressing, WhatIsCaughtBetweenTheSeamsIsTakenApartAndTheSeamsClose) {
  DressingTube tube(0.04);
  ASSERT_EQ(tube.sewn(), SewingStatus::blocked);
  const double evaluated_s = tube.dressing->sewing().seconds().eval;
  ASSERT_TRUE(tube.dressing->take_apart({}, {}, {}));
  EXPECT_GE(tube.dressing->sewing().seconds().eval, evaluated_s);
  EXPECT_EQ(tube.sewn(), SewingStatus::closed);
  EXPECT_EQ(crossings_of(tube.dressing->worn()), 0);
}

TEST(Dressing, TakingApartEnds) {
  DressingTube tube(0.04);
  ASSERT_EQ(tube.sewn(), SewingStatus::blocked);
  EXPECT_FALSE(tube.dressing->take_apart({}, {}, [] { return true; })) << "stopped";
  EXPECT_EQ(tube.dressing->sewing().status(), SewingStatus::blocked) << "it is where it was";
  EXPECT_TRUE(tube.dressing->take_apart({}, {}, {}));
  EXPECT_FALSE(tube.dressing->take_apart({}, {}, {})) << "no less is in the way";
}

TEST(DressingBody, WhatFallsFirstFallsAroundAThinBody) {
  const Mannequin mannequin = make_mannequin(MannequinKind::woman);
  const std::size_t particles = mannequin.positions.size();
  Arms arms = find_arms(mannequin.positions, mannequin.triangles);
  ASSERT_TRUE(arms);
  DressingBody body(mannequin.positions, mannequin.triangles, particles, mannequin.triangles.size(), std::move(*arms));
  DressingBody::Pose pose;
  pose.lift = {1, 1};
  pose.reach = {0.2, 0.2};
  const auto at = [&](double t_s) {
    Vec3s x(particles);
    body.at(t_s, x);
    return x;
  };
  body.set_pose(pose);
  const Vec3s thin = at(0), growing = at(1), full = at(body.growth_s());
  EXPECT_NE(thin, growing);
  EXPECT_EQ(full, mannequin.positions);
  pose.falls_s = DressingBody::falling_s;
  body.set_pose(pose);
  EXPECT_EQ(at(DressingBody::falling_s), thin);
  EXPECT_EQ(at(DressingBody::falling_s + 1), growing);
  EXPECT_EQ(at(body.growth_s()), mannequin.positions);
  EXPECT_EQ(body.growth_s(), DressingBody::longest_growth_s);
}

}  // namespace
}  // namespace toile::internal
