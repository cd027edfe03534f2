// The linter on patterns that are good, and its drawing.
#include "broken_patterns.hpp"
#include "garment/boundary.hpp"
#include "garment/garment_mesh.hpp"
#include "garment/pattern_svg.hpp"
#include "garments.hpp"
#include "pattern_text.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <filesystem>

namespace toile::internal {
namespace {

std::string list(const LintReport& report) {
  std::string text;
  for (const LintFinding& f : report.findings)
    text += std::string(f.code) + ": " + f.place + ": expected " + f.expected + ", got " + f.got + "\n";
  return text;
}

std::vector<std::string> json_files(const std::string& folder) {
  std::vector<std::string> files;
  if (!std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Lint, FindsNothingInOurOwnGarments) {
  const std::vector<std::string> files = json_files(test::source_path("patterns"));
  EXPECT_EQ(files.size(), 12U);
  for (const std::string& file : files) {
    const LintReport report = lint_pattern(read_file(file), file);
    EXPECT_TRUE(report.findings.empty()) << file << "\n" << list(report);
    EXPECT_TRUE(report.usable);
    EXPECT_TRUE(report.mended_text.empty());
  }
}

TEST(Lint, FindsNothingInPatternsOfOthers) {
  std::vector<std::string> files;
  for (const char* folder : {"patterns/random", "patterns/garmentcode", "patterns/garment_pattern_generator"})
    for (const std::string& file : json_files(test::shared_path(folder))) files.push_back(file);
  if (files.empty()) GTEST_SKIP() << "no patterns of others here";
  int patterns = 0;
  for (const std::string& file : files) {
    const std::string text = read_file(file);
    if (text.find("\"stitches\"") == std::string::npos || text.front() != '{')
      continue;  // the list of bodies, a file with comments
    ++patterns;
    const LintReport report = lint_pattern(text, file);
    EXPECT_TRUE(report.findings.empty()) << file << "\n" << list(report);
  }
  EXPECT_GE(patterns, 60);
}

TEST(Lint, AFileWithoutFaultsIsWrittenAsItIs) {
  const std::string text = to_text(test::PatternFile("man_pants").root);
  EXPECT_EQ(to_text(JsonValue(Json::parse(text, "p.json"))), text);
  const Pattern before = load_pattern(test::source_path("patterns/man_pants.json")),
                after = parse_pattern(text, "p.json");
  ASSERT_EQ(before.panels.size(), after.panels.size());
  for (std::size_t p = 0; p < before.panels.size(); ++p) {
    EXPECT_EQ(before.panels[p].corners, after.panels[p].corners);
    EXPECT_EQ(before.panels[p].translation_m, after.panels[p].translation_m);
  }
}

TEST(Lint, NumbersOfTheExtensionFollowARepair) {
  // A corner before those of the fold goes, and a stitch before the pressed one.
  const std::string text = R"({"pattern": {"panels": {
    "a": {"translation": [0, 80, 20], "rotation": [0, 0, 0], "vertices": [[9, 9], [0, 0], [50, 0], [50, 50], [0, 50]],
      "edges": [{"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 4]}, {"endpoints": [4, 1]}]},
    "b": {"translation": [0, 80, -20], "rotation": [0, 0, 0], "vertices": [[0, 0], [0, 50], [50, 50], [50, 0]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}},
    "stitches": [[{"panel": "a", "edge": 3}, {"panel": "b", "edge": 0}], [{"panel": "b", "edge": 0}, {"panel": "a", "edge": 3}],
      [{"panel": "a", "edge": 1}, {"panel": "b", "edge": 2}]]},
    "toile": {"panels": {"a": {"folds": [{"endpoints": [1, 3], "angle_deg": 90}]}}, "stitches": [{"stitch": 2, "angle_deg": 30}]},
    "properties": {"units_in_meter": 100}})";
  const LintReport report = lint_pattern(text, "p.json");
  EXPECT_TRUE(report.usable) << list(report);
  const Pattern mended = parse_pattern(report.mended_text, "p.json");
  EXPECT_EQ(mended.panels[0].folds[0].line.start, 0);
  EXPECT_EQ(mended.panels[0].folds[0].line.end, 2);
  ASSERT_EQ(mended.stitches.size(), 2U);
  EXPECT_GT(mended.stitches[1].angle_rad, 0.5);
}

TEST(Lint, FinishesFollowTheirEdgesAndGoWithThem) {
  const std::string text = R"({"pattern": {"panels": {
    "a": {"translation": [0, 80, 20], "rotation": [0, 0, 0], "vertices": [[0, 0], [50, 0], [50, 50], [0, 50]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}},
    "stitches": []},
    "toile": {"panels": {"a": {"edges": [{"edge": 3, "hem_mm": 20}, {"edge": 1, "hem_mm": 5}]}}},
    "properties": {"units_in_meter": 100}})";
  const LintReport report = lint_pattern(text, "p.json");
  EXPECT_TRUE(report.usable) << list(report);
  const Pattern mended = parse_pattern(report.mended_text, "p.json");
  ASSERT_EQ(mended.panels[0].edges.size(), 4U);
  for (const PanelEdge& edge : mended.panels[0].edges) EXPECT_EQ(edge.finish.hem_m, edge.start == 2 ? 0.02 : 0);
}

TEST(Lint, APanelKeepsItsPlaceWhenItsCornersAreCentred) {
  // normalize_panel_translation turns a panel about the mean of its corners, which a corner too many has moved.
  const std::string panels = R"({"a": {"translation": [3, 80, 20], "rotation": [10, 40, 20],
      "vertices": [[0, 0], [50, 0], [50, 50], [0, 50], [9, 90]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}})";
  const std::string text =
      "{\"pattern\": {\"panels\": " + panels +
      ", \"stitches\": []}, \"properties\": {\"units_in_meter\": 100, \"normalize_panel_translation\": true}}";
  const LintReport report = lint_pattern(text, "p.json");
  ASSERT_FALSE(report.mended_text.empty()) << list(report);
  const Pattern mended = parse_pattern(report.mended_text, "p.json");
  for (int c = 0; c < 4; ++c) {
    const auto k = static_cast<std::size_t>(c);
    EXPECT_LT((mended.panels[0].place(mended.panels[0].corners[k]) -
               report.drawing.panels[0].place(report.drawing.panels[0].corners[k]))
                  .norm(),
              1e-12);
  }
}

// A band around the waist with a knife pleat of three layers in its front: an edge sewn three times, one of them "right_wrong".
TEST(Lint, FindsNothingInAPleat) {
  const auto panel = [](const std::string& corners, const std::string& edges, const std::string& place) {
    return pattern_text::panel(corners, edges, place);
  };
  const std::string ring =
      R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}])";
  const std::string back_ring =
      R"([{"endpoints": [0, 3]}, {"endpoints": [3, 2]}, {"endpoints": [2, 1]}, {"endpoints": [1, 0]}])";
  const std::string sheet_ring =
      R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 4]},
          {"endpoints": [4, 5]}, {"endpoints": [5, 0]}])";
  // Fronts face +z, backs are drawn the other way round.
  const std::string panels =
      "{\"band_front\": " + panel("[[0, 0], [45, 0], [45, 4], [0, 4]]", ring, "[-22.5, 100, 20]") +
      ", \"band_back\": " + panel("[[0, 0], [45, 0], [45, 4], [0, 4]]", back_ring, "[-22.5, 100, -20]") +
      ", \"sheet\": " +
      panel("[[0, 0], [135, 0], [135, 60], [90, 60], [45, 60], [0, 60]]", sheet_ring, "[-67.5, 38, 20]") +
      ", \"back\": " + panel("[[0, 0], [45, 0], [45, 60], [0, 60]]", back_ring, "[-22.5, 38, -20]") + "}";
  const auto seams = [](const std::string& under) {
    using pattern_text::stitch;
    return "[" + stitch("band_front", 0, "sheet", 4) + ", " + stitch("band_front", 0, "sheet", 3, under) + ", " +
           stitch("band_front", 0, "sheet", 2) + ", " + stitch("band_back", 3, "back", 1) + ", " +
           stitch("band_front", 1, "band_back", 2) + ", " + stitch("band_front", 3, "band_back", 0) + ", " +
           stitch("sheet", 1, "back", 2) + ", " + stitch("sheet", 5, "back", 0) + "]";
  };
  const LintReport report = lint_pattern(pattern_text::file(panels, seams(", \"right_wrong\"")), "p.json");
  EXPECT_TRUE(report.findings.empty()) << list(report);
  EXPECT_TRUE(report.usable);
  const LintReport flat = lint_pattern(pattern_text::file(panels, seams("")), "p.json");
  ASSERT_FALSE(flat.findings.empty()) << "three layers of which none goes back";
  EXPECT_EQ(flat.findings.front().code, reason::seam_twice);
}

TEST(Boundary, OfATubeIsTwoRingsAndOfABagOne) {
  Pattern tube = test::tube_pattern(0.4, 0.6, 0.2);
  const Boundary open = find_boundary(tube);
  ASSERT_EQ(open.openings.size(), 2U);
  EXPECT_NEAR(open.openings[0].girth_m, 0.8, 1e-12);
  EXPECT_NEAR(open.openings[0].middle_m.y(), -0.3, 1e-12);
  EXPECT_NEAR(open.pieces[0].area_m2, 0.48, 1e-12);
  tube.stitches.push_back(test::stitch(0, 0, 1, 0));
  EXPECT_EQ(find_boundary(tube).openings.size(), 1U);
  tube.stitches.push_back(test::stitch(0, 2, 1, 2));
  EXPECT_TRUE(find_boundary(tube).openings.empty());
}

TEST(Boundary, GoesOnAcrossASeamThatIsRightToWrong) {
  Pattern pattern;  // a sheet with a strip laid upon its upper edge: one boundary around both
  pattern.panels = {test::front_rectangle(0.4, 0.6, Vec3::Zero()), test::front_rectangle(0.4, 0.1, Vec3(0, 0.3, 0.01))};
  pattern.stitches = {test::stitch(0, 2, 1, 2, true)};
  const Boundary boundary = find_boundary(pattern);
  ASSERT_EQ(boundary.openings.size(), 1U);
  EXPECT_EQ(boundary.openings[0].edges.size(), 6U);
  EXPECT_NEAR(boundary.openings[0].girth_m, 0.4 + 1.2 + 0.4 + 0.2, 1e-12);
}

// Without entities and tags everything must be text, and every tag closed: enough of XML to see that it is.
void expect_well_formed(const std::string& svg) {
  std::vector<std::string> open;
  ASSERT_EQ(svg.rfind("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"", 0), 0U);
  for (std::size_t at = svg.find("<svg"); at != std::string::npos; at = svg.find('<', at + 1)) {
    const std::size_t end = svg.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = svg.substr(at + 1, end - at - 1);
    EXPECT_EQ(std::count(tag.begin(), tag.end(), '"') % 2, 0) << tag;
    if (tag[0] == '/') {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(tag.substr(1), open.back());
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
  }
  EXPECT_TRUE(open.empty());
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(PatternSvg, DrawsEveryBrokenPattern) {
  for (const test::BrokenPattern& broken : test::broken_patterns()) {
    test::PatternFile file(broken.garment);
    broken.break_it(file);
    const LintReport report = lint_pattern(to_text(file.root), "p.json", broken.body);
    const std::string svg = draw_pattern(report.drawing, report.findings);
    expect_well_formed(svg);
    EXPECT_NE(svg.find(std::string(broken.code) + " ("), std::string::npos) << broken.name;
  }
}

TEST(PatternSvg, CurvesBulgeAsInThePattern) {
  // From left to right, sweep 1 passes below the straight line (docs/pattern-format.md): in SVG, with y down, that is sweep 0.
  const auto with_edge = [](const std::string& curvature) {
    return parse_pattern(
        pattern_text::one_panel("[[0, 0], [40, 0], [40, 60], [0, 60]]",
                                R"([{"endpoints": [0, 1], "curvature": )" + curvature +
                                    R"(}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}])"),
        "p.json");
  };
  const std::string arc = draw_pattern(with_edge(R"({"type": "circle", "params": [30, 0, 1]})"), {});
  EXPECT_NE(arc.find("A30 30 0 0 0 "), std::string::npos);
  const std::string cubic = draw_pattern(with_edge(R"({"type": "cubic", "params": [[0.25, 0.5], [0.75, 0.5]]})"), {});
  const std::size_t curve = cubic.find('C', cubic.find("<path"));
  ASSERT_NE(curve, std::string::npos);
  EXPECT_NE(draw_pattern(with_edge("[0.5, 0.3]"), {}).find('Q'), std::string::npos);
}

TEST(PatternSvg, NamesAreTextAndNumbersHaveAPointInEveryLocale) {
  Pattern pattern = test::tube_pattern(0.4, 0.6, 0.2);
  pattern.panels[0].name = "<script>&\"'";
  const std::string svg = draw_pattern(pattern, {});
  expect_well_formed(svg);
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  const std::string before = std::setlocale(LC_ALL, nullptr);
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr) {
    EXPECT_EQ(draw_pattern(pattern, {}), svg);
  }
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_NE(svg.find("width=\""), std::string::npos);
}

}  // namespace
}  // namespace toile::internal
