// Stacks of sheets that fall on each other, on the floor and on a sphere: they come to rest, and nothing passes through anything.
#include "io/scratch.hpp"
#include "sim/simulate.hpp"
#include "support/bodies.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

namespace toile {
namespace {

enum class Under { floor, sphere };

std::string to_obj(const BodySurface& body) {
  std::string text;
  for (const Vec3& p : body.positions())
    text += "v " + std::to_string(p.x()) + ' ' + std::to_string(p.y()) + ' ' + std::to_string(p.z()) + '\n';
  for (const Triangle& t : body.triangles())
    text += "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' ' + std::to_string(t[2] + 1) + '\n';
  return text;
}

// Each sheet is turned by 18 degrees against the one below it and lies 5 mm above it.
Report stack(int sheets, Under under, double seconds, double aside_m) {
  const Scratch scratch;
  std::string text = R"({"cloth": [)";
  for (int i = 0; i < sheets; ++i) {
    text += std::string(i == 0 ? "" : ", ") + R"({"name": "sheet )" + std::to_string(i) +
            R"(", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.025}, "placement": {"translation_m": [)" +
            std::to_string((0.003 + aside_m) * i) + ", " + std::to_string(0.005 + 0.005 * i) + ", " +
            std::to_string(0.002 * i) + R"(], "rotation_deg": [-90, )" + std::to_string(18 * i) + ", 0]}}";
  }
  text += R"(], "body": )";
  if (under == Under::floor) {
    text += R"({"cylinder": {"radius_m": 0.6, "height_m": 0.3}})";
  } else {
    scratch.put("sphere.obj", to_obj(test::sphere(Vec3(0, -0.15, 0), 0.15, 4)));
    text += R"({"mesh": "sphere.obj", "unit": "m"})";
  }
  text += R"(, "time": {"seconds": )" + std::to_string(seconds) + R"(, "step_max_ms": 20, "until_still": false}})";
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  return simulate(parse_scene(text, scratch / "s.json"), options);
}

// From any start: how far aside each sheet lies changes which threads come to lie on which, and every bit.
void expect_rest(int sheets, Under under, double seconds) {
  std::array<double, 3> speed{};
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const Report report = stack(sheets, under, seconds, 0.37e-3 * static_cast<double>(k));
    EXPECT_EQ(report.ended, "time");
    EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0) << sheets;
    EXPECT_EQ(report.audit.cloth_body_edges.max, 0) << sheets;
    speed[k] = report.audit.still_mm_per_s_p99;
  }
  std::printf("%d sheets: %.2f %.2f %.2f mm/s\n", sheets, speed[0], speed[1], speed[2]);
  for (const double p99 : speed) EXPECT_LT(p99, 2) << sheets << " sheets, the last second of " << seconds;
}

TEST(Stack, OfTwoFiveAndTenSheetsOnTheFloorComesToRest) {
  for (const int sheets : {2, 5, 10}) expect_rest(sheets, Under::floor, 2);
}

TEST(Stack, OfTwoFiveAndTenSheetsOnASphereComesToRest) {
  for (const int sheets : {2, 5, 10}) expect_rest(sheets, Under::sphere, 4);
}

}  // namespace
}  // namespace toile
