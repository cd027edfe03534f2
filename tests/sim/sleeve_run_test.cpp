// tests/sim/sleeve_run_test.cpp: sleeves are sewn around the whole arm.
#include "body/mannequin.hpp"
#include "core/error.hpp"
#include "io/file.hpp"
#include "io/obj.hpp"
#include "io/scratch.hpp"
#include "support/paths.hpp"
#include "support/run_into.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

namespace toile::internal {
namespace {

// The T-shirt with sleeves down to the wrist, 17.2 cm round there.
std::string long_sleeves() {
  std::string text = read_file(test::source_path("patterns/tshirt.json"));
  for (const auto& [short_hem, long_hem] :
       {std::pair{"[22.5, -8.279]", "[58, -4.3]"}, std::pair{"[22.5, 8.2]", "[58, 4.3]"},
        std::pair{"[22.5, -7.191]", "[58, -4.3]"}, std::pair{"[-22.5, -8.279]", "[-58, -4.3]"},
        std::pair{"[-22.5, 8.2]", "[-58, 4.3]"}, std::pair{"[-22.5, -7.191]", "[-58, -4.3]"}}) {
    std::size_t found = text.find(short_hem);
    if (found == std::string::npos) throw Error(ErrorKind::usage, std::string("tshirt.json has no ") + short_hem);
    for (; found != std::string::npos; found = text.find(short_hem, found))  // of the front and of the back
      text.replace(found, std::string_view(short_hem).size(), long_hem);
  }
  return text;
}

// The woman with hands that are 1.6 times as thick.
SurfaceMesh with_thick_hands() {
  Mannequin woman = make_mannequin(MannequinKind::woman);
  const Vec3 shoulder(0.193, 1.424, 0), along = Vec3(1, -1, 0).normalized();
  const double wrist_m = 0.565;  // from the shoulder
  for (Vec3& p : woman.positions) {
    const double side = p.x() > 0 ? 1 : -1;
    p.x() *= side;
    const double past_m = (p - shoulder).dot(along) - wrist_m;
    if (past_m > 0 && p.x() > 0.3) {
      const Vec3 axis = shoulder + (wrist_m + past_m) * along;
      p = axis + (1 + 0.6 * std::min(1.0, past_m / 0.03)) * (p - axis);
    }
    p.x() *= side;
  }
  SurfaceMesh mesh;
  mesh.positions = std::move(woman.positions);
  mesh.triangles = std::move(woman.triangles);
  return mesh;
}

TEST(SleeveRun, ACuffThatNoHandGoesThroughClosesAroundTheWrist) {
  const Scratch scratch;
  std::ofstream(scratch / "sleeves.json") << long_sleeves();
  write_obj(scratch / "hands.obj", with_thick_hands());
  const Report report =
      test::run_into(scratch / "out", parse_scene(R"({"cloth": [{"pattern": ")" + (scratch / "sleeves.json") +
                                                      R"(", "resolution_cm": 3}], "body": {"mesh": ")" +
                                                      (scratch / "hands.obj") + R"("}, "time": {"seconds": 0.5}})",
                                                  "s.json"));
  ASSERT_EQ(report.ended, "time");
  EXPECT_TRUE(report.open_seams.empty());
  EXPECT_EQ(report.audit.cloth_cloth_edges.last, 0);
  EXPECT_EQ(report.audit.cloth_body_edges.last, 0);
  EXPECT_LT(report.audit.stretch.gauge_max, 0.25) << "hands do not pull at the sleeves";
}

}  // namespace
}  // namespace toile::internal
