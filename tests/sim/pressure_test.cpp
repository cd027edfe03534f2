// Pressure in scenes: a balloon, pressure in time, a cushion that is sewn, and refusals.
#include "dress/forces.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/setup.hpp"
#include "support/bodies.hpp"
#include "support/paths.hpp"
#include "support/run_into.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

namespace toile::internal {
namespace {

void write_ball(const std::string& path, double radius_m, int levels) {
  const BodySurface ball = test::sphere(Vec3::Zero(), radius_m, levels);
  std::ofstream file(path);
  file.precision(17);
  for (const Vec3& p : ball.positions()) file << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const Triangle& t : ball.triangles()) file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

double mean_radius(const std::vector<Vec3>& x) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : x) middle += p / static_cast<double>(x.size());
  double radius = 0;
  for (const Vec3& p : x) radius += (p - middle).norm() / static_cast<double>(x.size());
  return radius;
}

std::vector<Vec3> inflated_frame(const std::string& path) {
  Pc2Reader reader(path);
  std::vector<Vec3> x;
  reader.read(reader.samples() - 1, x);
  return x;
}

// Threads both ways carry T = p r/2 at every place: k (l - 1) = p r0 l/2, of a ball that is l times as wide as at rest.
TEST(PressureInScenes, ABalloonIsAsWideAsItsThreadsSayAndStaysWhereItIs) {
  const Scratch scratch;
  write_ball(scratch / "ball.obj", 0.1, 3);
  const double k = 1000;
  for (const double Pa : {300.0, 1500.0}) {
    const std::string file = scratch / "s.json";
    const Report report =
        test::run_into(scratch / "out", parse_scene(R"({"cloth": [{"mesh": "ball.obj", "rest_shape": "start",
        "fabric": {"base": "cotton", "stretch_u_N_per_m": 1000, "stretch_v_N_per_m": 1000, "shear_N_per_m": 200, "strain_limit": 0},
        "panels": {"ball": {"pressure_Pa": )" + std::to_string(Pa) +
                                                        R"(}}}],
        "world": {"gravity_m_per_s2": [0, 0, 0]}, "time": {"seconds": 3}})",
                                                    file));
    EXPECT_EQ(report.ended, "time");
    EXPECT_LT(report.audit.still_mm_per_s_p99, 5);
    const std::vector<Vec3> x = inflated_frame(scratch / "out/cloth.pc2");
    const double expected = k / (k - Pa * 0.1 / 2) - 1;
    EXPECT_NEAR((mean_radius(x) / 0.1 - 1) / expected, 1, 0.1) << Pa;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : x) middle += p / static_cast<double>(x.size());
    EXPECT_LT(middle.norm(), 1e-4) << "a closed cloth does not push itself anywhere";
  }
}

// A loose sheet without weight goes up as fast as what was pumped says: v = integral of p / sigma.
TEST(PressureInScenes, ChangesInTime) {
  const Scratch scratch;
  test::run_into(scratch / "out",
                 parse_scene(R"({"cloth": [{"name": "sheet", "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.04},
      "fabric": {"base": "cotton", "density_kg_per_m2": 0.2}, "panels": {"sheet": {"pressure_path": [[0.2, 0], [0.6, 1], [1, 0]]}}}],
      "world": {"gravity_m_per_s2": [0, 0, 0], "air_density_kg_per_m3": 0}, "time": {"seconds": 1.2, "fps": 60}})",
                             "s.json"));
  Pc2Reader reader(scratch / "out/cloth.pc2");
  std::vector<Vec3> x, before;
  reader.read(12, before);
  EXPECT_NEAR(before[0].z(), 0, 1e-9);
  reader.read(reader.samples() - 2, before);
  reader.read(reader.samples() - 1, x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR((x[i].z() - before[i].z()) * 60, 0.4 / 0.2, 0.01) << "a grid faces +z";
    EXPECT_NEAR(x[i].x(), before[i].x(), 1e-6);
  }
}

TEST(PressureInScenes, IsRefusedWhereItCannotBeMeant) {
  const auto refused = [](const std::string& panel, const std::string& place) {
    try {
      parse_scene(R"({"cloth": [{"name": "sheet", "grid": {}, "panels": {"sheet": )" + panel + "}}]}", "s.json");
      ADD_FAILURE() << panel;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("/cloth/0/panels/sheet" + place), std::string::npos) << error.what();
    }
  };
  refused(R"({"pressure_Pa": 2e5})", "/pressure_Pa: expected");
  refused(R"({"pressure_Pa": "high"})", "/pressure_Pa: expected");
  refused(R"({"pressure_path": [[1, 5], [0.5, 5]]})", "/pressure_path/1");
  refused(R"({"pressure_Pa": 5, "pressure_path": [[0, 5]]})", "");
  refused(R"({"pressure_pa": 5})", "");
}

// Two discs, sewn together all around and filled: the cushion of scenes/, coarse.
TEST(PressureInScenes, ACushionIsFilledOnceItIsSewn) {
  const Scratch scratch;
  const auto cushion = [](const std::string& seconds) {
    return parse_scene(R"({"cloth": [{"pattern": ")" + test::source_path("patterns/things/cushion.json") +
                           R"(", "resolution_cm": 2, "fabric": "silk",
      "panels": {"front": {"pressure_Pa": 200}, "back": {"pressure_Pa": 200}}}],
      "world": {"gravity_m_per_s2": [0, 0, 0]}, "time": {"until_still": false, "seconds": )" +
                           seconds + "}}",
                       "s.json");
  };
  const auto thickness = [&] {
    double low = 9, high = -9;
    for (const Vec3& p : inflated_frame(scratch / "out/cloth.pc2")) {
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
    return high - low;
  };
  test::run_into(scratch / "out", cushion("0.17"));
  EXPECT_LT(thickness(), 0.05) << "just sewn: gravity and pressure come later";
  const Report report = test::run_into(scratch / "out", cushion("2"));
  EXPECT_EQ(report.ended, "time");
  EXPECT_EQ(report.audit.cloth_cloth_edges.last, 0);
  // A foil balloon of two discs of radius a is 0.914 a thick [Paulsen 1994]; silk gives along its bias.
  EXPECT_NEAR(thickness(), 0.914 * 0.2, 0.15 * 0.914 * 0.2);
}

TEST(PressureInScenes, MayLift) {
  const auto lifts = [](const std::string& of_sheet) {
    const Scene scene =
        parse_scene(R"({"cloth": [{"name": "sheet", "grid": {}, "panels": {"sheet": )" + of_sheet + "}}]}", "s.json");
    const std::vector<LoadedCloth> cloth{load_cloth(scene, 0, read_text_file)};
    Outfit outfit = outfit_of_shapes(cloth);
    OutfitRun run(run_options(scene, step_options(scene, cloth.front().edge_m)), outfit, nullptr);
    run.set_events(events_of(scene, outfit, cloth));
    return may_lift(run);
  };
  EXPECT_FALSE(lifts("{}"));
  EXPECT_TRUE(lifts(R"({"pressure_Pa": 3})"));
  EXPECT_TRUE(lifts(R"({"pressure_path": [[0, 1]]})"));
}

}  // namespace
}  // namespace toile::internal
