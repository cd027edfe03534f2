// What is left of a run whose step collapsed: names, and a file to look at.
#include "sim/offenders.hpp"

#include "io/obj.hpp"
#include "io/scratch.hpp"
#include "sim/simulate.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <numeric>
#include <string>

namespace toile::internal {
namespace {

ClothMesh strip(int triangles) {
  ClothMesh mesh;
  mesh.particle_count = triangles + 2;
  mesh.panel_names = {"front", "back"};
  for (Index t = 0; t < triangles; ++t) {
    mesh.triangles.push_back({t, t + 1, t + 2});
    mesh.panel.push_back(t < 12 ? 0 : 1);
  }
  return mesh;
}

TEST(Offenders, AreNamedByPanel) {
  const ClothMesh mesh = strip(15);
  std::vector<Index> some = {3, 4, 13};
  EXPECT_EQ(name_triangles(mesh, some), "2 triangles of front (3, 4), 1 of back (13)");
  EXPECT_EQ(name_triangles(mesh, std::vector<Index>{14}), "1 triangle of back (14)");
  std::vector<Index> many(12);
  std::iota(many.begin(), many.end(), 0);
  EXPECT_EQ(name_triangles(mesh, many), "12 triangles of front (0, 1, 2, 3, 4, 5, 6, 7, ...)");
  EXPECT_EQ(name_triangles(mesh, {}), "");
}

TEST(Offenders, AreDrawnWithTheBodyNearThem) {
  const ClothMesh mesh = strip(15);
  Vec3s x;
  for (int i = 0; i < 17; ++i) x.emplace_back(0.1 * i, 0.1 * (i % 2), 0);
  const Vec3s body_x = {{0, 0, 0.01}, {0.1, 0, 0.01}, {0, 0.1, 0.01}, {0, 0, 1}, {0.1, 0, 1}, {0, 0.1, 1}};
  const std::vector<Triangle> body = {{0, 1, 2}, {3, 4, 5}};
  const std::vector<Index> some = {0, 13};
  const SurfaceMesh obj = offenders_obj(mesh, x, some, body, body_x);
  ASSERT_EQ(obj.triangles.size(), 3u) << "one of the body is a metre away";
  EXPECT_EQ(obj.positions.size(), 9u) << "no vertices that nobody uses";
  EXPECT_EQ(obj.group, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(obj.object, (std::vector<Index>{0, 0, 1}));
  EXPECT_EQ(obj.positions[static_cast<std::size_t>(obj.triangles[1][0])], x[13]);
  EXPECT_EQ(obj.positions[static_cast<std::size_t>(obj.triangles[2][1])], body_x[1]);
  x[1].y() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(offenders_obj(mesh, x, some, body, body_x).triangles.size(), 1u) << "nothing that no file can hold";
}

// A hand at 99 m/s, and cloth that is held behind and must not get longer.
TEST(Offenders, OfAStepThatCollapsedAreInAFile) {
  const Scratch scratch;
  const std::string scene =
      R"({"cloth": [{"name": "flag", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05}, "fabric": {"base": "cotton", "strain_limit": 0.05},
      "pins": [{"near_m": [0, -0.15, 0]}, {"near_m": [0, 0.15, 0], "hold": "path", "path_m": [[0.1, 0, 0.15, 0], [0.2, 9.9, 0.15, 0]]}]}],
    "time": {"seconds": SECONDS}})";
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  const auto run = [&](const char* seconds) {
    std::string text = scene;
    return simulate(parse_scene(text.replace(text.find("SECONDS"), 7, seconds), "s.json"), options);
  };
  const Report report = run("0.4");
  EXPECT_EQ(report.ended, "step_collapsed");
  EXPECT_EQ(outcome(report), Outcome::failed);
  ASSERT_FALSE(report.verdict.reasons.empty());
  const std::string& detail = report.verdict.reasons.front().detail;
  EXPECT_EQ(detail.rfind("in frame 4: the step collapsed", 0), 0u) << detail;
  EXPECT_NE(detail.find("of flag ("), std::string::npos) << detail;
  const SurfaceMesh offenders = load_obj(scratch / "out/offenders.obj");
  EXPECT_FALSE(offenders.triangles.empty());
  EXPECT_EQ(offenders.object_names, std::vector<std::string>{"cloth"});
  EXPECT_EQ(offenders.group_names, std::vector<std::string>{"flag"});

  EXPECT_EQ(run("0.1").ended, "time");
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/offenders.obj")) << "of another run";
}

}  // namespace
}  // namespace toile::internal
