// Places where cloth passes through cloth: left alone, pushed apart, guarded again.
#include "dress/tangles.hpp"

#include "support/sheets.hpp"
#include "verify/crossings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace toile::internal {
namespace {

TEST(Tangles, AreLeftAloneUntilTheyAreGone) {
  // A triangle that stands through another, and a third far away.
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  Vec3s x{{-0.01, 0, 0.01},  {0.01, 0, 0.01}, {0, 0, -0.02}, {0, -0.01, 0}, {0, 0.01, 0.005},
          {0, 0.01, -0.005}, {1, 0, 0},       {1, 0, 1},     {1, 1, 0}};
  const Topology topology = build_topology(9, triangles);
  Tangles tangles(topology, triangles);
  tangles.find(x);
  ASSERT_TRUE(tangles.any());
  std::vector<double> scale(9, 0.7);
  tangles.switch_off(scale);
  EXPECT_EQ(scale, (std::vector<double>{0, 0, 0, 0, 0, 0, 0.7, 0.7, 0.7}));
  Vec3s apart = x;
  for (const std::size_t i : {3U, 4U, 5U}) apart[i].y() += 0.1;
  tangles.find(apart);
  EXPECT_FALSE(tangles.any());
  tangles.switch_off(scale);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_GT(scale[i], 0) << "guarded from the very frame in which they came free";
  EXPECT_EQ(scale[8], 0.7);
  tangles.find(x);
  EXPECT_FALSE(tangles.any()) << "once free it is guarded, and not looked at again";
}

// A flap that has come through the sheet beside it: what pushes takes it back out, and holds nobody afterwards.
TEST(Tangles, ArePushedApartTheWayThatTakesLeast) {
  test::Sheet sheet = test::stack(0.2, 0.02, 2e-3, 2);
  const std::size_t one = sheet.x.size() / 2;
  const double inward_m = std::copysign(0.03, sheet.x.back().z());
  for (std::size_t i = one; i < sheet.x.size();
       ++i) {  // a corner of the upper layer, folded down through the lower one
    Vec3& p = sheet.x[i];
    p.y() -= 0.5 * std::max(0.0, 0.07 - p.x() - std::abs(p.z()));
    p += Vec3(0.03, 0, inward_m);
  }
  const Topology topology = build_topology(sheet.mesh.particle_count, sheet.mesh.triangles);
  Tangles tangles(topology, sheet.mesh.triangles);
  tangles.find(sheet.x);
  ASSERT_TRUE(tangles.any());
  std::vector<LinearSpring> springs;
  tangles.append_springs(springs);
  ASSERT_FALSE(springs.empty());
  Vec3 upper = Vec3::Zero(), lower = Vec3::Zero();
  for (const LinearSpring& spring : springs) {
    EXPECT_EQ(spring.stiffness_N_per_m, 0) << "drag: nothing is thrown";
    EXPECT_GT(spring.damping_N_s_per_m, 0);
    for (std::size_t k = 0; k < 4; ++k) {
      if (spring.particle[k] < 0) continue;
      (static_cast<std::size_t>(spring.particle[k]) < one ? lower : upper) +=
          spring.weight[k] * spring.force_N * spring.direction;
    }
  }
  EXPECT_GT(upper.y(), 0);
  EXPECT_LT((upper + lower).norm(), 1e-9) << "what one is pushed the other is pushed back";
  EXPECT_GT(upper.y(), 3 * std::hypot(upper.x(), upper.z()));
  std::vector<double> scale(sheet.x.size(), 1);
  tangles.switch_off(scale);
  EXPECT_GT(std::count(scale.begin(), scale.end(), 1.0), static_cast<std::ptrdiff_t>(sheet.x.size() / 3));
  tangles.find(test::stack(0.2, 0.02, 2e-3, 2).x);
  springs.clear();
  tangles.append_springs(springs);
  EXPECT_TRUE(springs.empty());
}

TEST(Tangles, EveryParticleOfACrossingIsLeftAloneHoweverLongItsEdges) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  const Vec3s x{{-0.3, 0, 0.3}, {0.3, 0, 0.3}, {0, 0, -0.6}, {0, -0.3, 0}, {0, 0.3, 0.15}, {0, 0.3, -0.15}};
  const Topology topology = build_topology(6, triangles);
  Tangles tangles(topology, triangles);
  tangles.find(x);
  std::vector<double> scale(6, 1);
  tangles.switch_off(scale);
  EXPECT_EQ(scale, std::vector<double>(6, 0));
}

}  // namespace
}  // namespace toile::internal
