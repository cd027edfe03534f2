// Small scenes whose last state is known to the bit: on every instruction set of the machine here, and in every build that runs the label
// `golden` (docs/conventions.md#determinism).
//
// A hash changes only on purpose, with the reason in CHANGELOG.md.  TOILE_TEST_TARGETS restricts the instruction sets.
#include "core/parallel.hpp"
#include "io/scratch.hpp"
#include "sim/simulate.hpp"
#include "support/every_target.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace toile::internal {
namespace {

// Two panels of 28 x 16 cm, sewn at both sides.  `back`: where its panel lies, and which of its edges is sewn to the front's first and second.
std::string tube(const std::string& back, int first, int second) {
  const std::string outline = R"("vertices": [[0, 0], [28, 0], [28, 16], [0, 16]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})";
  return R"({"pattern": {"panels": {
    "front": {"translation": [-14, 0, 10], "rotation": [0, 0, 0], )" +
         outline + R"(, "back": {)" + back + ", " + outline + R"(}, "stitches": [
    [{"panel": "front", "edge": 1}, {"panel": "back", "edge": )" +
         std::to_string(first) + R"(}], [{"panel": "front", "edge": 3}, {"panel": "back", "edge": )" +
         std::to_string(second) + R"(}]]}, "properties": {"units_in_meter": 100, "curvature_coords": "relative"}})";
}

// A scene of a tube on a cylinder.
std::string on_a_cylinder(const std::string& pattern) {
  return R"({"cloth": [{"pattern": ")" + pattern +
         R"(", "resolution_cm": 3, "panels": {"front": {"rest_stretch_v": 0.95}}}],
    "body": {"cylinder": {"radius_m": 0.08, "height_m": 0.4, "top_m": [0, 0.3, 0]}, "friction": 0.3},
    "time": {"fps": 30, "seconds": 0.6, "until_still": false}})";
}

void expect_hash(const std::string& scene, const std::string& state_hash) {
  const Scratch scratch;
  const std::string file = scratch.put("scene.json", scene);
  scratch.put("tube.json", tube(R"("translation": [14, 0, -10], "rotation": [0, 180, 0])", 3, 1));
  // The right side of its back is inward: sewing leaves crossings.
  scratch.put("flipped_tube.json", tube(R"("translation": [-14, 0, -10], "rotation": [0, 0, 0])", 1, 3));
  int threads = 2;  // for the first
  test::on_every_target([&](const char* target) {
    RunOptions options;
    options.directory = scratch / target;
    options.command = "test";
    Report report;
    with_threads(threads, [&] { report = simulate(parse_scene(scene, file), options); });
    std::string how = report.ended;
    for (const Reason& reason : report.verdict.reasons) how.append(", ").append(reason.code);
    EXPECT_EQ(report.state_hash, state_hash) << target << ": " << how;
    EXPECT_GT(report.frames, 3) << target;
    threads = 1;
  });
}

// A sheet of silk over a ball, and one of cotton that falls upon it and folds.
TEST(Golden, LayersThatFoldOverABall) {
  expect_hash(R"({"cloth": [
      {"grid": {"width_m": 0.24, "height_m": 0.24, "edge_m": 0.02}, "fabric": "silk",
       "placement": {"translation_m": [0, 0.004, 0], "rotation_deg": [-90, 0, 0]}},
      {"name": "upright", "grid": {"width_m": 0.2, "height_m": 0.12, "edge_m": 0.02}, "fabric": "cotton",
       "placement": {"translation_m": [0.01, 0.08, 0.005], "rotation_deg": [-20, 0, 5]}}],
    "solids": [{"sphere": {"radius_m": 0.06}, "placement": {"translation_m": [0, -0.064, 0]}}],
    "contact": {"friction": 0.5}, "time": {"fps": 30, "seconds": 0.5}})",
              "81b7accdb7808f3b");
}

TEST(Golden, ATubeIsSewnOnACylinder) { expect_hash(on_a_cylinder("tube.json"), "a55ad65f14b2c36b"); }

TEST(Golden, WhatAFlippedPanelTanglesIsPushedApart) {
  expect_hash(on_a_cylinder("flipped_tube.json"), "0ba9df79d2529a2f");
}

TEST(Golden, APersonGrowsIntoASkirt) {
  expect_hash(
      R"({"cloth": [{"pattern": ")" + test::source_path("patterns/short_skirt.json") + R"(", "resolution_cm": 6}],
    "body": {"mannequin": "woman"}, "time": {"fps": 30, "seconds": 0.2, "until_still": false}})",
      "a5875bc097c56da4");
}

TEST(Golden, AMannequinTwistsUnderAKerchief) {
  expect_hash(R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.03},
       "placement": {"translation_m": [0, 1.72, 0], "rotation_deg": [-90, 0, 0]}}],
    "body": {"mannequin": "woman", "motion": {"name": "twist", "lead_in_s": 0.2}},
    "time": {"fps": 30, "seconds": 0.2, "drape_seconds": 0.1}})",
              "9993ef0793b01641");
}

TEST(Golden, ABallIsDrivenThroughACurtain) {
  expect_hash(R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.025}, "fabric": "wool",
       "pins": [{"near_m": [-0.15, 0.15, 0]}, {"near_m": [0.15, 0.15, 0], "hold": "moves",
                 "moves": [{"t_s": 0}, {"t_s": 0.4, "shift_m": [-0.05, 0, 0], "rotation_deg": [0, 0, 30]}]}]}],
    "solids": [{"sphere": {"radius_m": 0.05}, "edge_m": 0.02, "placement": {"translation_m": [0.01, -0.02, 0.09]},
                "moves": [{"t_s": 0}, {"t_s": 0.3, "shift_m": [0, 0, -0.15], "rotation_deg": [0, 90, 0]}]}],
    "time": {"fps": 30, "seconds": 0.5}})",
              "87fa6366af28426d");
}

// A flag that pulls itself together in the wind; a hand pulls at it; fifty times as stiff, so that it is solved in double.
TEST(Golden, AStiffFlagInTheWind) {
  expect_hash(R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.15, "edge_m": 0.0125},
       "fabric": {"base": "cotton", "stretch_u_N_per_m": 150000, "stretch_v_N_per_m": 150000, "shear_N_per_m": 20000},
       "panels": {"sheet": {"rest_stretch_path": [[0, 1, 1], [0.3, 0.95, 0.98]]}},
       "pins": [{"in_box_m": [[-0.11, -1, -1], [-0.09, 1, 1]]}],
       "drags": [{"near_m": [0.1, 0, 0], "path_m": [[0, 0.1, 0, 0], [0.3, 0.1, 0.02, 0.05]]}]}],
    "world": {"wind_m_per_s": [4, 0, 2], "air_density_kg_per_m3": 1.2},
    "time": {"fps": 30, "seconds": 0.4, "integrator": "bdf2"}})",
              "fa192e8fce23e823");
}

}  // namespace
}  // namespace toile::internal
