// Edges with a label while a garment is sewn: drawn to a height, kept where they were placed, or free.
#include "dress/label_springs.hpp"
#include "garment/garments.hpp"
#include "sewing_run.hpp"
#include "support/bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

using test::expect_closed_without_crossings;
using test::SewingRun;

// One tube above the other, sewn together at the upper one's lower edge, which is labelled.
Pattern two_tubes(Pattern pattern, const Pattern& below) {
  pattern.panels.insert(pattern.panels.end(), below.panels.begin(), below.panels.end());
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) pattern.panels[p].name += std::to_string(p);
  pattern.stitches.insert(pattern.stitches.end(), {test::stitch(2, 1, 3, 3), test::stitch(2, 3, 3, 1),
                                                   test::stitch(0, 0, 2, 2), test::stitch(1, 0, 3, 2)});
  for (const std::size_t panel : {0, 1}) pattern.panels[panel].edges[0].label = "lower_interface";
  return pattern;
}

// How high its edges with this label are, on average, m.
double height_of(const GarmentMesh& garment, const std::string& label, const Vec3s& x) {
  double sum = 0, count = 0;
  for (const LabelledEdge& edge : garment.labels) {
    if (edge.label != label) continue;
    for (const Index i : edge.particles) {
      sum += x[at(i)].y();
      ++count;
    }
  }
  return sum / count;
}

// A narrow band above wide panels: sewn together they meet where the middle of their mass is, unless the band is held.
TEST(Sewing, ABandThatIsHeldDrawsHeavierPanelsUpToItself) {
  const Pattern pattern = two_tubes(test::tube_pattern(0.2, 0.04, 0.1, Vec3(0, 0.2, 0)),
                                    test::tube_pattern(0.2, 0.3, 0.1, Vec3(0, -0.1, 0)));
  const double waist_m = 0.18;
  std::array<double, 2> fallen_m{};
  for (const bool held : {false, true}) {
    SewingOptions options;
    options.label_heights = {{"lower_interface", waist_m}};
    options.labels_hold_panels = held;
    SewingRun run(pattern, 0.02, nullptr, options);
    run.run(12);
    ASSERT_EQ(run.sewing->status(), SewingStatus::sewing);
    fallen_m[held ? 1 : 0] = waist_m - height_of(run.garment, "lower_interface", run.sewing->state().x);
    run.run(200);
    expect_closed_without_crossings(run);
  }
  EXPECT_GT(fallen_m[0], 0.05);
  EXPECT_LT(fallen_m[1], 0.02);
}

// A bodice of 30 cm above wide tiers: its lower end is not drawn down to them.
TEST(Sewing, ABodiceThatIsKeptSinksNoFartherThanFiveCentimetres) {
  Pattern pattern = two_tubes(test::tube_pattern(0.2, 0.3, 0.1, Vec3(0, 0.2, 0)),
                              test::tube_pattern(0.2, 0.5, 0.1, Vec3(0, -0.4, 0)));
  std::array<double, 2> fallen_m{};
  for (const bool kept : {false, true}) {
    SewingOptions options;
    options.keeps_bodice = kept;
    SewingRun run(pattern, 0.02, nullptr, options);
    run.run(20);
    ASSERT_EQ(run.sewing->status(), SewingStatus::sewing);
    fallen_m[kept ? 1 : 0] = height_of(run.garment, "lower_interface", run.garment.x) -
                             height_of(run.garment, "lower_interface", run.sewing->state().x);
    run.run(300);
    expect_closed_without_crossings(run);
  }
  EXPECT_GT(fallen_m[0], 0.09);
  EXPECT_LT(fallen_m[1], 0.06) << "it may sink by 5 cm";
}

// Waist and neckline of a bodice to whose waist something is sewn, and nothing else: once 5 cm below their places, not before.
TEST(LabelSprings, OfABodiceHoldWaistAndNecklineFromFiveCentimetresBelow) {
  const auto tube = test::tube_pattern(0.2, 0.3, 0.1, Vec3(0, 0.2, 0));
  Pattern sewn = two_tubes(tube, test::tube_pattern(0.2, 0.5, 0.1, Vec3(0, -0.4, 0))), alone = tube;
  for (Pattern* pattern : {&sewn, &alone})
    for (const std::size_t panel : {0, 1}) {
      pattern->panels[panel].edges[0].label = "lower_interface";
      pattern->panels[panel].edges[1].label = "left_armhole";
      pattern->panels[panel].edges[2].label = "left_collar";
    }
  EXPECT_TRUE(LabelSprings::of_bodice(SewingRun(alone, 0.02, nullptr, {}).garment).empty())
      << "no panel draws, and it goes nowhere of itself";

  const GarmentMesh garment = SewingRun(sewn, 0.02, nullptr, {}).garment;
  std::set<Index> labelled;
  for (const LabelledEdge& edge : garment.labels)
    if (edge.label != "left_armhole") labelled.insert(edge.particles.begin(), edge.particles.end());
  const auto held_at = [&](double below_m) {
    ClothState state{garment.x, Vec3s(garment.x.size(), Vec3::Zero())};
    for (Vec3& x : state.x) x.y() -= below_m;
    std::vector<LinearSpring> springs;
    LabelSprings::of_bodice(garment).append(state, 1, springs);
    std::set<Index> held;
    for (const LinearSpring& spring : springs) {
      EXPECT_GT(spring.force_N * spring.direction.y(), 0);
      held.insert(spring.particle[0]);
    }
    return held;
  };
  EXPECT_EQ(held_at(0.06), labelled);
  EXPECT_TRUE(held_at(0.04).empty());
}

// A band of 75 cm, 20 cm high, is closed around a ball of 94 cm: it goes up, to where it is as wide as the ball, and its upper edge, which is
// wanted lower, is not drawn down over it.
TEST(Sewing, ABandTooNarrowForWhatIsBelowIsWornAboveItWithoutAFold) {
  Pattern pattern = test::tube_pattern(0.376, 0.2, 0.36, Vec3(0, 0.1, 0));
  for (Panel& panel : pattern.panels) panel.edges[2].label = "lower_interface";
  BodySurface ball = test::sphere(Vec3::Zero(), 0.15, 4);
  const double waist_m = 0.17;
  SewingOptions options;
  options.label_heights = {{"lower_interface", waist_m}};
  options.labels_hold_panels = true;
  SewingRun run(pattern, 0.02, &ball, options);
  run.run(400);
  expect_closed_without_crossings(run);
  const double upper_m = height_of(run.garment, "lower_interface", run.sewing->state().x);
  EXPECT_GT(upper_m, waist_m + 0.05);
  for (const Vec3& p : run.sewing->state().x) EXPECT_LT(p.y(), upper_m + 0.01) << "the upper edge is at the top";
}

TEST(Sewing, ALabelledEdgeIsDrawnToItsHeightOnceTheSeamsAreClosed) {
  Pattern pattern = test::tube_pattern(0.12, 0.12, 0.1);
  for (Panel& panel : pattern.panels) panel.edges[0].label = "lower_interface";
  SewingOptions options;
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  ASSERT_EQ(garment.labels.size(), 2U);
  const auto height = [&](const Vec3s& x) { return height_of(garment, "lower_interface", x); };
  const double wanted = height(garment.x) + 0.03;
  options.label_heights = {{"lower_interface", wanted}, {"unknown", 7}};
  SewingRun held(pattern, 0.02, nullptr, options), free(pattern, 0.02);
  held.run(200);
  free.run(200);
  ASSERT_EQ(held.sewing->status(), SewingStatus::closed);
  EXPECT_NEAR(height(free.sewing->state().x), height(garment.x), 2e-3);
  EXPECT_GT(height(held.sewing->state().x), height(garment.x) + 1e-3) << "on its way";

  // At the height and above it they rest; below they pull up, never harder than their limit.
  const LabelSprings springs(garment, options.label_heights);
  ClothState state{garment.x, Vec3s(garment.x.size(), Vec3::Zero())};
  for (const double above : {-0.5, -0.01, 0.0, 0.01, 0.5}) {
    for (Vec3& p : state.x) p.y() = wanted + above;
    std::vector<LinearSpring> rows;
    springs.append(state, 0.5, rows);
    double force = 0;
    for (const LinearSpring& row : rows) {
      force += row.force_N * row.direction.y();
      EXPECT_LE(row.stiffness_N_per_m * std::fabs(above), std::fabs(row.force_N) + 1e-12) << "a step cannot overshoot";
    }
    const double limit = 0.5 * 20 * 0.24;  // two edges of 12 cm
    EXPECT_NEAR(force, std::clamp(-above / 0.02, 0.0, 1.0) * limit, 1e-9) << above;
  }
}

TEST(Sewing, LabelledEdgesAreFreeUntilTheSeamsAreClosed) {
  Pattern pattern = test::tube_pattern(0.12, 0.12, 0.1);
  for (Panel& panel : pattern.panels) panel.edges[0].label = "hem";
  SewingOptions options;
  options.label_heights = {{"hem", 1.0}};
  SewingRun held(pattern, 0.02, nullptr, options), free(pattern, 0.02);
  for (SewingRun* run : {&held, &free}) run->run(10);  // of 12 frames
  ASSERT_EQ(held.sewing->status(), SewingStatus::sewing);
  const Vec3s &x = held.sewing->state().x, &y = free.sewing->state().x;
  EXPECT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(Vec3)), 0);
}

TEST(Sewing, LabelSpringsFollowTheirParticlesIntoTheWeld) {
  Pattern pattern = test::tube_pattern(0.12, 0.12, 0.1);
  pattern.panels[1].edges[0].label = "hem";
  const GarmentMesh garment = mesh_garment(pattern, 0.02);
  const WeldedMesh welded = weld(garment);
  const std::vector<LabelHeight> heights{{"hem", 1.0}};
  const LabelSprings panels(garment, heights), whole = panels.welded(welded.particle_of);
  std::vector<LinearSpring> before, after;
  panels.append({garment.x, Vec3s(garment.x.size(), Vec3::Zero())}, 1, before);
  whole.append({Vec3s(at(welded.mesh.particle_count), Vec3::Zero()), {}}, 1, after);
  ASSERT_EQ(before.size(), garment.labels.at(0).particles.size());
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_EQ(after[k].particle[0], welded.particle_of[at(before[k].particle[0])]);
}

}  // namespace
}  // namespace toile::internal
