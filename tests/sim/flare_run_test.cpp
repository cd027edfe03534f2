// tests/sim/flare_run_test.cpp: a skirt cut as nearly two circles is sewn below the waist.
#include "io/scratch.hpp"
#include "support/run_into.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace toile::internal {
namespace {

// 330 degrees about a point 1 m high, radii of 6.6 and 40 cm.
std::string panel(const std::string& z_cm, bool front) {
  const std::string curved = R"(, "curvature": {"type": "circle", "params": [)";
  const std::string waist = R"(, "label": "lower_interface")";
  const std::string vertices =
      "[[-10.3528, 38.637], [10.3528, 38.637], [1.7082, 6.3751], [-1.7082, 6.3751]]";  // outside, then inside
  std::string edges;
  if (front)
    edges = R"({"endpoints": [0, 1])" + curved + R"(40, 1, 1]}}, {"endpoints": [1, 2]}, {"endpoints": [2, 3])" +
            curved + R"(6.6, 1, 0]})" + waist + R"(}, {"endpoints": [3, 0]})";
  else
    edges = R"({"endpoints": [0, 3]}, {"endpoints": [3, 2])" + curved + R"(6.6, 1, 1]})" + waist +
            R"(}, {"endpoints": [2, 1]}, {"endpoints": [1, 0])" + curved + R"(40, 1, 0]}})";
  return R"({"translation": [0, 100, )" + z_cm + R"(], "rotation": [0, 0, 0], "label": "leg", "vertices": )" +
         vertices + R"(, "edges": [)" + edges + "]}";
}

TEST(FlareRun, ASkirtOfTwoCirclesIsSewnBelowTheWaist) {
  const Scratch scratch;
  std::ofstream(scratch / "circles.json") << R"({"pattern": {"panels": {"front": )" + panel("25", true) +
                                                 R"(, "back": )" + panel("-20", false) +
                                                 R"(}, "stitches": [
               [{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}],
               [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}]]},
               "properties": {"units_in_meter": 100, "normalize_panel_translation": false}})";
  const Report report =
      test::run_into(scratch / "out", parse_scene(R"({"cloth": [{"pattern": ")" + (scratch / "circles.json") +
                                                      R"(", "resolution_cm": 3}], "body": {"mannequin": "woman"},
                                                      "time": {"seconds": 0.5}})",
                                                  "s.json"));
  ASSERT_EQ(report.ended, "time");
  EXPECT_TRUE(report.open_seams.empty());
  EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0);
  EXPECT_EQ(report.audit.cloth_body_edges.max, 0);
}

}  // namespace
}  // namespace toile::internal
