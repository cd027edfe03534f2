// A sheet of cloth that is folded over once and let go: poplin with a pressed fold stays folded, neoprene springs open.
#include "core/elementary.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/simulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace toile::internal {
namespace {

constexpr double pi = 3.14159265358979323846;

std::string letter_pattern(double pressed_deg) {
  std::string text =
      R"({"pattern": {"panels": {"letter": {"vertices": [[-10, 0], [10, 0], [10, 15], [10, 30], [-10, 30], [-10, 15]], "edges": [)";
  for (int k = 0; k < 6; ++k)
    text += (k ? ", {\"endpoints\": [" : "{\"endpoints\": [") + std::to_string(k) + ", " + std::to_string((k + 1) % 6) +
            "]}";
  text +=
      R"(], "translation": [0, 0, 0], "rotation": [0, 0, 0]}}, "stitches": [], "panel_order": ["letter"]}, "parameters": {},
      "properties": {"units_in_meter": 100, "curvature_coords": "relative", "normalize_panel_translation": false})";
  if (pressed_deg != 0)
    text += R"(, "toile": {"panels": {"letter": {"folds": [{"endpoints": [5, 2], "angle_deg": )" +
            std::to_string(-pressed_deg) + "}]}}}";
  return text + "}";
}

// On a table, its far half is lifted over the near one by two corners within 1.5 s, and let go after 2.  The angle by which it is folded ten
// seconds later, in degrees; 180: half lies on half.
double folded_deg(const std::string& fabric, double pressed_deg) {
  const Scratch scratch;
  scratch.put("letter.json", letter_pattern(pressed_deg));
  const std::string text =
      R"({"cloth": [{"name": "letter", "pattern": "letter.json", "resolution_cm": 1.5, "fabric": ")" + fabric + R"(",
      "placement": {"translation_m": [0, 0.005, 0.15], "rotation_deg": [-90, 0, 0]},
      "pins": [{"in_box_m": [[-0.2, -1, -0.02], [0.2, 1, 0.2]], "to_s": 2},
       {"near_m": [-0.1, 0.005, -0.15], "hold": "path", "to_s": 2, "path_m": [[0.2, -0.1, 0.005, -0.15], [0.8, -0.1, 0.14, 0], [1.5, -0.1, 0.02, 0.13]]},
       {"near_m": [0.1, 0.005, -0.15], "hold": "path", "to_s": 2, "path_m": [[0.2, 0.1, 0.005, -0.15], [0.8, 0.1, 0.14, 0], [1.5, 0.1, 0.02, 0.13]]}]}],
      "solids": [{"box": {"size_m": [1, 0.2, 1]}, "placement": {"translation_m": [0, -0.1, 0]}}],
      "time": {"fps": 30, "seconds": 12}})";
  RunOptions options;
  options.directory = scratch / "out";
  const Report report = simulate(parse_scene(text, scratch.put("s.json", text)), options);
  EXPECT_TRUE(report.verdict.pass) << fabric;
  Pc2Reader frames(scratch / "out/cloth.pc2");
  Vec3s first, last;
  frames.read(0, first);
  frames.read(frames.samples() - 1, last);
  const auto middle_of = [&](double z) {  // of a row across the letter, which lay there at first
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (std::abs(first[i].z() - z) > 0.008) continue;
      sum += last[i];
      ++count;
    }
    return Vec3(sum / count);
  };
  const Vec3 fold = middle_of(0), far = middle_of(-0.15) - fold, near = middle_of(0.15) - fold;
  return 180 - 180 / pi * std::acos(far.dot(near) / (far.norm() * near.norm()));
}

TEST(FoldedLetter, OfPoplinStaysFoldedAndOfNeopreneSpringsOpen) {
  EXPECT_GT(folded_deg("poplin", 160), 150);
  EXPECT_LT(folded_deg("neoprene", 0), 20);
}

}  // namespace
}  // namespace toile::internal
