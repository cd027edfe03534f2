// The step controller: frame boundaries, rejection, growth, diagnosis; and that the state is untouched when a step is refused.
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

#include "core/hash.hpp"
#include "core/parallel.hpp"

namespace toile {
namespace {

using test::ClothRun;
using test::Sheet;

std::string state_hash(const ClothState& state) {
  Hash hash;
  hash.add(std::span<const Vec3>(state.x));
  hash.add(std::span<const Vec3>(state.v));
  return hash.hex();
}

// A sheet dropped on a ball with self-contact, a corner pinned: contact, friction, rejection all take part.
std::string drop(int threads) {
  std::string hash;
  with_threads(threads, [&] {
    BodySurface ball = test::sphere(Vec3(0, -0.1, 0), 0.1, 4);
    Sheet sheet = test::equilateral_sheet(0.4, 0.4, 0.02);
    for (Vec3& p : sheet.x) p += Vec3(-0.2, 0.03, 0.2);
    ClothRun run(sheet, fabric_preset("silk", "", ""));
    run.world.body = &ball;
    run.pin(0);
    run.run(25);
    hash = state_hash(run.state);
  });
  return hash;
}

TEST(Determinism, OneTwoAndFiveThreadsGiveTheSameBits) {
  const std::string one = drop(1);
  EXPECT_EQ(drop(2), one);
  EXPECT_EQ(drop(5), one);
}

TEST(AdaptiveStep, LandsOnFrameBoundariesAndUsesTheLongestStepThatHolds) {
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  run.adaptive.step_max_s = 0.02;  // does not divide 1/30: two steps of 1/60
  const FrameReport report = run.frame();
  EXPECT_EQ(report.steps, 2);
  EXPECT_DOUBLE_EQ(report.step_max_s, 1.0 / 60);
  EXPECT_NEAR(run.state.v[0].y(), -9.81 / 30, 1e-12);
}

TEST(AdaptiveStep, HalvesOnAJerkAndGrowsBack) {
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  run.pin(0);
  run.run(10);
  for (std::size_t i = 0; i < run.state.v.size() / 2; ++i) run.state.v[i] += Vec3(0, 0, 20);
  const FrameReport jerk = run.frame();
  EXPECT_GT(jerk.rejected, 0);
  EXPECT_LT(jerk.step_min_s, 1.0 / 60);
  FrameReport last;
  for (int f = 0; f < 20; ++f) last = run.frame();
  EXPECT_EQ(last.steps, 1);
}

TEST(AdaptiveStep, ACollapseNamesTheTriangleAndLeavesTheStateWhereItWasAccepted) {
  ClothRun run(test::equilateral_sheet(0.1, 0.1, 0.02), Fabric{});
  run.pin(0);
  Pin torn;  // a second particle that is driven away at 1 km/s
  torn.particle = 20;
  const Vec3 start = run.state.x[20];
  torn.path = [start](double t_s) -> Vec3 { return start + Vec3(1000 * t_s, 0, 0); };
  run.world.pins.push_back(torn);
  run.start();
  const Vec3s before = run.state.x;
  const FrameReport report = run.stepper->advance(run.state, 0, 1.0 / 30);
  EXPECT_FALSE(report.ok);
  EXPECT_NE(report.diagnosis.find("particle 20"), std::string::npos) << report.diagnosis;
  EXPECT_EQ(state_hash({before, run.state.v}), state_hash(run.state));
}

TEST(AdaptiveStep, PinsFollowTheirPathsExactly) {
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), Fabric{});
  Pin pin;
  pin.particle = 3;
  const Vec3 start = run.state.x[3];
  pin.path = [start](double t_s) -> Vec3 { return start + Vec3(0.3 * t_s, 0.1 * std::sin(t_s), -0.2 * t_s); };
  run.world.pins.push_back(pin);
  run.run(30);
  EXPECT_LT((run.state.x[3] - pin.path(run.time_s)).norm(), 1e-12);
}

TEST(Golden, StateHashesOfThreeScenes) {
  // Change these only on purpose, and say so in CHANGELOG.md.
  const auto hanging = [] {
    ClothRun run(test::equilateral_sheet(0.3, 0.3, 0.03), Fabric{});
    run.pin(0);
    run.run(15);
    return state_hash(run.state);
  };
  const auto folding = [] {
    BodySurface slab = test::tilted_slab(1, 0.2, 0);
    Sheet sheet = test::equilateral_sheet(0.2, 0.3, 0.02);
    for (Vec3& p : sheet.x) p = Vec3(p.x() - 0.1, 0.004 - p.z(), 0.001 * std::abs(p.z()));  // stands on its edge
    ClothRun run(sheet, Fabric{});
    run.world.body = &slab;
    run.run(15);
    return state_hash(run.state);
  };
  EXPECT_EQ(hanging(), "06cd67aa6deb5e59");
  EXPECT_EQ(folding(), "e314f1a036ad5a72");
  EXPECT_EQ(drop(1), "5a1d4aaccb71c1b5");
}

}  // namespace
}  // namespace toile
