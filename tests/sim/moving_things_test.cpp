// Solids that move by themselves, and pins that take a part of a cloth along and let it go.
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/simulate.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

struct Frames {
  Report report;
  std::vector<Vec3s> cloth, body;
};

std::vector<Vec3s> read_all(const std::string& path) {
  Pc2Reader reader(path);
  std::vector<Vec3s> frames(static_cast<std::size_t>(reader.samples()));
  for (int k = 0; k < reader.samples(); ++k) reader.read(k, frames[static_cast<std::size_t>(k)]);
  return frames;
}

Frames run(const std::string& scene) {
  const Scratch scratch;
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  Frames frames;
  const SceneFile read = read_scene(scene, "s.json");
  frames.report = read.places.complete_errors_of([&] { return simulate(read.scene, options); });
  frames.cloth = read_all(scratch / "out/cloth.pc2");
  if (scene.find("solids") != std::string::npos) frames.body = read_all(scratch / "out/body.pc2");
  return frames;
}

Vec3 middle(const Vec3s& x, std::size_t first, std::size_t count) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = first; i < first + count; ++i) sum += x[i];
  return sum / static_cast<double>(count);
}

TEST(MovingThings, ASolidThatRisesTakesTheClothAlong) {
  const Frames frames = run(R"({
    "cloth": [{"grid": {"width_m": 0.5, "height_m": 0.5, "edge_m": 0.05},
               "placement": {"translation_m": [0, 0.303, 0], "rotation_deg": [-90, 0, 0]}}],
    "solids": [{"box": {"size_m": [1, 0.1, 1]}, "placement": {"translation_m": [0, -0.05, 0]}},
               {"sphere": {"radius_m": 0.15}, "edge_m": 0.04, "placement": {"translation_m": [0, 0.15, 0]},
                "moves": [{"t_s": 0.4}, {"t_s": 0.8, "shift_m": [0, 0.2, 0], "rotation_deg": [0, 90, 0]}]}],
    "time": {"seconds": 1.2, "step_max_ms": 8}})");  // in one step per frame the cloth lands with a fold on top
  EXPECT_TRUE(frames.report.verdict.pass);
  EXPECT_EQ(frames.report.motion.frames, 36) << "no drape before it: times count from the first frame";
  ASSERT_EQ(frames.body.size(), 37u);
  const std::size_t ball = frames.body.front().size() - 8;  // the box comes first
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(frames.body.back()[i], frames.body.front()[i]) << "the box stands";
  EXPECT_NEAR((middle(frames.body[12], 8, ball) - Vec3(0, 0.15, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((middle(frames.body[18], 8, ball) - Vec3(0, 0.25, 0)).norm(), 0, 1e-6) << "half of the way";
  EXPECT_NEAR((middle(frames.body[36], 8, ball) - Vec3(0, 0.35, 0)).norm(), 0, 1e-6);
  const Vec3 from = frames.body.front()[8] - Vec3(0, 0.15, 0), to = frames.body.back()[8] - Vec3(0, 0.35, 0);
  EXPECT_NEAR((to - Vec3(from.z(), from.y(), -from.x())).norm(), 0, 1e-6) << "a quarter of a turn about its own middle";
  double top = 0;
  for (const Vec3& x : frames.cloth.back()) top = std::max(top, x.y());
  EXPECT_GT(top, 0.5);
  EXPECT_LT(top, 0.515);
}

// Whatever memory held before, which is where the body was taken to be.
TEST(MovingThings, ABodyThatStandsStillStaysBesideASolidThatMoves) {
  const auto scene = [](const std::string& key) {
    return R"({"cloth": [{"grid": {"width_m": 0.5, "height_m": 0.5, "edge_m": 0.05},
                          "placement": {"translation_m": [0, 0.02, 0], "rotation_deg": [-90, 0, 0]}}],
               "body": {"cylinder": {"radius_m": 0.2, "height_m": 0.5}},
               "solids": [{"box": {"size_m": [0.1, 0.1, 0.1]}, "placement": {"translation_m": [5, 0, 0]},
                           "moves": [{"t_s": 0}, {"t_s": 1)" +
           key + R"(}]}], "time": {"seconds": 0.4}})";
  };
  const Frames still = run(scene(""));
  mallopt(M_PERTURB, 165);
  const Frames moving = run(scene(R"(, "shift_m": [0.1, 0, 0])"));
  mallopt(M_PERTURB, 0);
  EXPECT_TRUE(moving.report.verdict.pass);
  EXPECT_EQ(moving.report.state_hash, still.report.state_hash);
  ASSERT_EQ(moving.body.size(), still.body.size());
  const std::size_t own = still.body.front().size() - 8;
  for (const Vec3s& frame : moving.body)
    for (std::size_t i = 0; i < own; ++i) ASSERT_EQ(frame[i], moving.body.front()[i]) << i;
  EXPECT_GT((moving.body.back().back() - moving.body.front().back()).norm(), 0.03);
}

TEST(MovingThings, ASolidGrowsAboutItsOwnPlace) {
  const Frames frames = run(R"({
    "cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.05}, "pins": [{"near_m": [0, 0.1, 0]}]}],
    "solids": [{"box": {"size_m": [0.2, 0.2, 0.2]}, "placement": {"translation_m": [2, 1, 0], "rotation_deg": [0, 0, 45]},
                "moves": [{"t_s": 0}, {"t_s": 0.1, "scale": 1.5}]}],
    "time": {"seconds": 0.2}})");
  EXPECT_TRUE(frames.report.verdict.pass);
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 from = frames.body.front()[i] - Vec3(2, 1, 0);
    EXPECT_NEAR(from.norm(), std::sqrt(0.03), 1e-6);
    EXPECT_LT((frames.body.back()[i] - Vec3(2, 1, 0) - 1.5 * from).norm(), 1e-6);
  }
}

TEST(MovingThings, WhatNoStepCouldFollowIsRefusedBeforeTheRun) {
  const auto refusal = [](const std::string& what) {
    try {
      run(R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.05})" + what +
          R"(], "time": {"seconds": 0.1}})");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("(accepted)");
  };
  const std::string ball =
      R"(}], "solids": [{"sphere": {"radius_m": 0.5}, "placement": {"translation_m": [9, 0, 0]}, )";
  EXPECT_NE(
      refusal(ball + R"("moves": [{"t_s": 0}, {"t_s": 1}, {"t_s": 1.001, "shift_m": [0, 0.2, 0]}]})")
          .find("/solids/0/moves/2: expected no point faster than 100 m/s from the key before, got up to 200 m/s"),
      std::string::npos);
  EXPECT_NE(refusal(ball + R"("moves": [{"t_s": 0}, {"t_s": 1, "rotation_deg": [0, 36000, 0]}]})").find("/moves/1"),
            std::string::npos);
  EXPECT_NE(refusal(ball + R"("edge_m": 0.0005})").find("/solids/0: edge_m: expected at most 2000000 triangles"),
            std::string::npos);
  EXPECT_NE(refusal(R"(, "pins": [{"near_m": [0.1, 0.1, 0], "hold": "moves", "about_m": [0.1, 0, 0],
                        "moves": [{"t_s": 0}, {"t_s": 0.01, "rotation_deg": [0, 0, 900]}]}]})")
                .find("/cloth/0/pins/0/moves/1"),
            std::string::npos);
}

TEST(MovingThings, WhatIsHeldTurnsExactlyUntilItIsLetGo) {
  const Frames frames = run(R"({
    "cloth": [{"grid": {"width_m": 0.4, "height_m": 0.4, "edge_m": 0.05},
      "pins": [{"in_box_m": [[-0.21, -1, -1], [-0.19, 1, 1]]},
               {"in_box_m": [[0.19, -1, -1], [0.21, 1, 1]], "hold": "moves", "to_s": 0.5, "about_m": [0.2, 0, 0],
                "moves": [{"t_s": 0.1}, {"t_s": 0.5, "shift_m": [-0.05, 0, 0], "rotation_deg": [180, 0, 0]}]}]}],
    "time": {"seconds": 1}})");
  EXPECT_TRUE(frames.report.verdict.pass);
  const Vec3s& start = frames.cloth.front();
  int held = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (start[i].x() < -0.19) {
      EXPECT_LT((frames.cloth.back()[i] - start[i]).norm(), 1e-6);
    }
    if (start[i].x() < 0.19) continue;
    ++held;
    // At 0.3 s, half of the way: a quarter of a turn about x through (0.2, 0, 0).
    const Vec3 expected(start[i].x() - 0.025, -start[i].z(), start[i].y());
    EXPECT_LT((frames.cloth[9][i] - expected).norm(), 1e-6) << i;
    EXPECT_GT((frames.cloth.back()[i] - frames.cloth[15][i]).norm(), 0.02) << "it falls when it is let go";
  }
  EXPECT_EQ(held, 9);
}

TEST(MovingThings, WhatIsTakenLaterMovesFromWhereItIs) {  // whatever its moves had done before
  const Frames frames = run(R"({
    "cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05},
      "pins": [{"near_m": [0, 0.15, 0], "hold": "moves", "from_s": 0.5, "about_m": [0, 0.15, 0],
        "moves": [{"t_s": 0, "shift_m": [0.3, 0, 0], "rotation_deg": [0, 0, 90]}, {"t_s": 0.5}, {"t_s": 0.6, "shift_m": [0.3, 0.1, 0]}]}]}],
    "time": {"seconds": 1}, "world": {"air_density_kg_per_m3": 0}})");
  EXPECT_TRUE(frames.report.verdict.pass);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < frames.cloth.front().size(); ++i)
    if ((frames.cloth.front()[i] - Vec3(0, 0.15, 0)).norm() < 0.01) taken = i;
  const Vec3 fallen = frames.cloth[15][taken];
  EXPECT_LT(fallen.y(), -0.9) << "free for half a second: 1.23 m";
  EXPECT_LT((frames.cloth[18][taken] - fallen - Vec3(0, 0.1, 0)).norm(), 1e-6);
  EXPECT_LT((frames.cloth.back()[taken] - fallen - Vec3(0, 0.1, 0)).norm(), 1e-6);
}

}  // namespace
}  // namespace toile::internal
