// Real pattern files of GarmentCode and of the 2021 Garment-Pattern-Generator; skipped where the files are absent.
#include "core/error.hpp"
#include "garment/pattern.hpp"
#include "garment/pattern_check.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>

namespace toile::internal {
namespace {

std::string sample_path(const std::string& name) { return test::shared_path("patterns/") + name; }

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no sample file " << (path)

struct Expected {
  const char* file;
  int panels, stitches, darts, eased;
  double longest_ratio;
  bool legacy;
  double low_y, high_y;
};

void PrintTo(const Expected& e, std::ostream* out) { *out << e.file; }

class PatternSample : public testing::TestWithParam<Expected> {};

TEST_P(PatternSample, HasTheKnownFigures) {
  const Expected& expected = GetParam();
  const std::string path = sample_path(expected.file);
  SKIP_WITHOUT(path);
  const Pattern pattern = load_pattern(path);
  const PatternSummary summary = summarize(pattern);
  EXPECT_EQ(summary.panels.size(), static_cast<std::size_t>(expected.panels));
  EXPECT_EQ(summary.stitches, expected.stitches);
  EXPECT_EQ(summary.darts, expected.darts);
  EXPECT_EQ(summary.eased_stitches, expected.eased);
  EXPECT_NEAR(summary.longest_ratio, expected.longest_ratio, 5e-4);
  EXPECT_EQ(pattern.legacy_frame, expected.legacy);
  EXPECT_NEAR(summary.box_min_m.y(), expected.low_y, 1e-3);
  EXPECT_NEAR(summary.box_max_m.y(), expected.high_y, 1e-3);
}

TEST_P(PatternSample, FrontPanelsFaceForwardAndBackPanelsBackward) {
  const std::string path = sample_path(GetParam().file);
  SKIP_WITHOUT(path);
  const Pattern pattern = load_pattern(path);
  const PatternSummary summary = summarize(pattern);
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Vec3 normal = pattern.panels[p].rotation().col(2) * (summary.panels[p].clockwise ? -1 : 1);
    const double z = pattern.panels[p].translation_m.z();
    if (std::abs(z) < 0.1) continue;  // side panels of the skirt
    // The tee's left sleeves are turned by 180 degrees; the outward normal still points away from the body.
    EXPECT_GT(normal.z() * z, 0) << summary.panels[p].name;
  }
}

TEST_P(PatternSample, SampledSeamsMeetTheirCorners) {
  const std::string path = sample_path(GetParam().file);
  SKIP_WITHOUT(path);
  const Pattern pattern = load_pattern(path);
  for (const Panel& panel : pattern.panels) {
    for (std::size_t k = 0; k < panel.edges.size(); ++k) {
      const auto here = sample_edge(panel, panel.edges[k], 20);
      const auto next = sample_edge(panel, panel.edges[(k + 1) % panel.edges.size()], 20);
      EXPECT_EQ(std::memcmp(here.back().data(), next.front().data(), 2 * sizeof(double)), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, PatternSample,
    testing::Values(Expected{"garmentcode/shirt_mean_specification.json", 8, 18, 0, 0, 1.003, false, 0.946, 1.406},
                    Expected{"garmentcode/dress_pencil_specification.json", 6, 23, 4, 11, 1.302, false, 0.113, 1.406},
                    Expected{"garment_pattern_generator/dress_sleeveless.json", 4, 10, 0, 0, 1.0, true, -0.733, 0.294},
                    Expected{"garment_pattern_generator/pants_straight_sides.json", 4, 6, 0, 0, 1.0, true, -0.651,
                             -0.051},
                    Expected{"garment_pattern_generator/skirt_4_panels.json", 4, 8, 0, 0, 1.0184, true, -0.678, -0.016},
                    Expected{"garment_pattern_generator/skirt_waistband.json", 4, 6, 0, 2, 2.2222, true, -0.65, 0.003},
                    Expected{"garment_pattern_generator/tee.json", 6, 12, 0, 0, 1.0, true, -0.322, 0.294}),
    [](const auto& tested) { return std::filesystem::path(tested.param.file).stem().string(); });

TEST(PatternSampleErrors, TemplateWithCommentsIsNoJsonAndSaysWhere) {
  const std::string path = sample_path("garment_pattern_generator/template_spec_with_comments.json");
  SKIP_WITHOUT(path);
  try {
    load_pattern(path);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("template_spec_with_comments.json:1:1"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace toile::internal
