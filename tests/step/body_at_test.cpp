// The room for a body's vertices comes filled: what a function leaves alone stands still.
#include "step/body_at.hpp"
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

const BodyAt moves_the_first = [](double t_s, std::span<Vec3> x) { x[0] = Vec3(t_s, 0, 0); };

#ifdef NDEBUG
TEST(BodyAt, WhatAFunctionLeavesAloneStandsStill) {
  const Vec3s standing = {{0, 0, 0}, {1, 2, 3}};
  Vec3s x;
  moves_the_first(0.5, standing, x);
  EXPECT_EQ(x, (Vec3s{{0.5, 0, 0}, {1, 2, 3}}));
  x.assign(7, Vec3(9, 9, 9));  // of something else
  moves_the_first(0.25, standing, x);
  EXPECT_EQ(x, (Vec3s{{0.25, 0, 0}, {1, 2, 3}}));
  moves_the_first(0.75, x, x);
  EXPECT_EQ(x, (Vec3s{{0.75, 0, 0}, {1, 2, 3}}));
}

TEST(BodyAt, AStepHandsOutRoomThatIsFilled) {
  BodySurface slab = test::tilted_slab(3, 0.2, 0);
  const std::vector<Vec3> rest(slab.positions().begin(), slab.positions().end());
  test::ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.1), Fabric{});
  for (Vec3& x : run.state.x) x += Vec3(0, 5, 0);
  run.world.body = &slab;
  int asked = 0;
  run.world.body_at = [&](double, std::span<Vec3> x) {
    ++asked;
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(x[i], rest[i]);
  };
  run.run(3);
  EXPECT_GE(asked, 4);
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_EQ(slab.next_positions()[i], rest[i]);
}
#else
TEST(BodyAtDeathTest, AFunctionThatLeavesAVertexAloneIsABug) {
  const Vec3s standing = {{0, 0, 0}, {1, 2, 3}};
  Vec3s x;
  EXPECT_DEATH(moves_the_first(0.5, standing, x), "hasNaN");
}

TEST(BodyAtDeathTest, WhatNobodyFilledIsNotANumber) {
  EXPECT_TRUE(Vec3s(3)[2].hasNaN());
  Vec3s x(1, Vec3::Zero());
  x.resize(2);
  EXPECT_TRUE(x[1].hasNaN());
}
#endif

}  // namespace
}  // namespace toile::internal
