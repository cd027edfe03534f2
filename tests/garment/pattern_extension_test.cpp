// What the format has no words for: the key "toile" of a pattern file.
#include "material/fabric.hpp"
#include "pattern_text.hpp"

#include <cmath>

namespace toile::internal {
namespace {

using namespace pattern_text;

constexpr double degree = 3.14159265358979323846 / 180;

std::string with(const std::string& extension, const std::string& stitches = "[]") {
  return file("{\"front\": " + panel() + ", \"back\": " + panel(square_corners, square_edges, "[0, 80, -20]") + "}",
              stitches, R"({"units_in_meter": 100})", "", ", \"toile\": " + extension);
}

TEST(PatternExtension, GivesPanelsTheirFabricAndRestStretch) {
  const Pattern pattern = parse(with(R"({"panels": {"back": {"fabric": "denim", "rest_stretch_v": 0.85}}})"));
  EXPECT_EQ(pattern.panels[0].fabric, "");
  EXPECT_EQ(pattern.panels[0].rest_stretch, Vec2(1, 1));
  EXPECT_EQ(pattern.panels[1].fabric, "denim");
  EXPECT_EQ(pattern.panels[1].rest_stretch, Vec2(1, 0.85));
}

TEST(PatternExtension, DrawsFoldsFromCornerToCorner) {
  const Pattern pattern = parse(with(R"({"panels": {"front": {"folds": [
      {"endpoints": [0, 2], "angle_deg": -120},
      {"endpoints": [2, 0], "angle_deg": 30, "curvature": {"type": "quadratic", "params": [[0.5, 0.1]]}}]}}})"));
  ASSERT_EQ(pattern.panels[0].folds.size(), 2U);
  const PanelFold &straight = pattern.panels[0].folds[0], &curved = pattern.panels[0].folds[1];
  EXPECT_EQ(straight.line.start, 0);
  EXPECT_EQ(straight.line.end, 2);
  EXPECT_EQ(straight.line.kind, CurveKind::line);
  EXPECT_NEAR(straight.angle_rad, -120 * degree, 1e-15);
  EXPECT_EQ(curved.line.kind, CurveKind::quadratic);
  // Half way from (0.4, 0.6) to (0, 0), and a tenth of the length to the left.
  EXPECT_LT((curved.line.control[0] - Vec2(0.2 + 0.06, 0.3 - 0.04)).norm(), 1e-12);
}

TEST(PatternExtension, PressesSeams) {
  const Pattern pattern =
      parse(with(R"({"stitches": [{"stitch": 1, "angle_deg": 90}]})",
                 std::string("[").append(stitch("front", 1, "back", 3)) + ", " + stitch("front", 3, "back", 1) + "]"));
  EXPECT_EQ(pattern.stitches[0].angle_rad, 0);
  EXPECT_NEAR(pattern.stitches[1].angle_rad, 90 * degree, 1e-15);
}

TEST(PatternExtension, FinishesEdgesByTheirNumberInTheFile) {
  Pattern pattern = parse(with(R"({"panels": {"front": {"edges": [{"edge": 2, "hem_mm": 20}, {"edge": 0}]}}})",
                               std::string("[").append(stitch("front", 1, "back", 3)) + "]"));
  EXPECT_EQ(pattern.panels[0].edges[2].finish, (EdgeFinish{0.02, 0}));
  // What the file says nothing of: a hem on open edges, a tape on those with a label.
  pattern.panels[0].edges[3].label = pattern.panels[0].edges[0].label = pattern.panels[1].edges[3].label = "waist";
  finish_other_edges(pattern, {0.015, 0.01});
  EXPECT_EQ(pattern.panels[0].edges[0].finish, (EdgeFinish{0, 0})) << "the file says that it has none";
  EXPECT_EQ(pattern.panels[0].edges[1].finish, (EdgeFinish{0, 0})) << "sewn";
  EXPECT_EQ(pattern.panels[0].edges[2].finish, (EdgeFinish{0.02, 0}));
  EXPECT_EQ(pattern.panels[0].edges[3].finish, (EdgeFinish{0.015, 0.01}));
  EXPECT_EQ(pattern.panels[1].edges[3].finish, (EdgeFinish{0, 0})) << "sewn, with a label";
  EXPECT_EQ(pattern.panels[1].edges[0].finish, (EdgeFinish{0.015, 0}));
}

TEST(PatternExtension, GivesSewnEdgesAllowances) {
  const std::string seams =
      std::string("[").append(stitch("front", 1, "back", 3)) + ", " + stitch("front", 3, "back", 1) + "]";
  Pattern pattern = parse(with(
      R"({"panels": {"front": {"edges": [{"edge": 1, "allowance_mm": 12, "topstitched": true}]},
                     "back": {"edges": [{"edge": 1, "tape_mm": 6}]}}})",
      seams));
  EXPECT_EQ(pattern.panels[0].edges[1].finish, (EdgeFinish{0, 0, 0.012, true}));
  EXPECT_EQ(pattern.panels[1].edges[3].finish, EdgeFinish()) << "each side by itself";
  finish_other_edges(pattern, {0.02, 0.01, 0.01, false});
  EXPECT_EQ(pattern.panels[0].edges[1].finish, (EdgeFinish{0, 0, 0.012, true})) << "the file's";
  EXPECT_EQ(pattern.panels[1].edges[1].finish, (EdgeFinish{0, 0.006})) << "the file's: a tape and no allowance";
  EXPECT_EQ(pattern.panels[0].edges[3].finish, (EdgeFinish{0, 0, 0.01, false}));
  EXPECT_EQ(pattern.panels[1].edges[3].finish, (EdgeFinish{0, 0, 0.01, false}));
  EXPECT_EQ(pattern.panels[0].edges[0].finish, (EdgeFinish{0.02, 0})) << "open";
}

TEST(PatternExtension, AbsoluteFoldsMoveWithTheirPanel) {
  std::string text =
      with(R"({"panels": {"front": {"folds": [{"endpoints": [0, 2], "angle_deg": 9, "curvature": [20, 30]}]}}})");
  text.replace(text.find("\"units_in_meter\": 100"), 21,
               "\"units_in_meter\": 100, \"curvature_coords\": \"absolute\", \"normalize_panel_translation\": true");
  const Pattern pattern = parse(text);
  EXPECT_LT(pattern.panels[0].folds[0].line.control[0].norm(), 1e-12) << "the middle of the panel is its origin now";
}

TEST(PatternExtension, IsRefusedWhereItCannotBeMeant) {
  expect_error(with("3"), {"/toile", "an object"});
  expect_error(with(R"({"panel": {}})"), {"/toile", "panels"});
  expect_error(with(R"({"panels": {"frnt": {}}})"), {"/toile/panels/frnt", "did you mean \"front\""});
  expect_error(with(R"({"panels": {"front": {"rest_stretch": 0.9}}})"), {"rest_stretch_u"});
  expect_error(with(R"({"panels": {"front": {"rest_stretch_u": 0.1}}})"), {"rest_stretch_u", "0.2 to 5", "0.1"});
  expect_error(with(R"({"panels": {"front": {"fabric": "denin"}}})"), {"fabric", "denim"});
  expect_error(with(R"({"panels": {"front": {"interfacing": "cottn"}}})"), {"interfacing", "cotton"});
  expect_error(with(R"({"panels": {"front": {"interfacing": "silk", "interfacing_mm": -1}}})"),
               {"interfacing_mm", "0 to 10", "-1"});
  expect_error(with(R"({"panels": {"front": {"interfacing_mm": 1}}})"), {"interfacing_mm", "`interfacing` beside it"});
  const auto folds = [](const std::string& fold) {
    return with(R"({"panels": {"front": {"folds": [)" + fold + "]}}}");
  };
  expect_error(folds(R"({"endpoints": [0, 2]})"), {"angle_deg"});
  expect_error(folds(R"({"endpoints": [0, 2], "angle_deg": 171})"), {"angle_deg", "-170 and 170"});
  expect_error(folds(R"({"endpoints": [0, 4], "angle_deg": 10})"), {"endpoints", "0 to 3"});
  expect_error(folds(R"({"endpoints": [1, 0], "angle_deg": 10})"), {"/folds/0", "a side of its outline"});
  const auto edges = [](const std::string& list) { return with(R"({"panels": {"front": {"edges": )" + list + "}}}"); };
  expect_error(edges("3"), {"/toile/panels/front/edges", "an array"});
  expect_error(edges(R"([{"hem_mm": 20}])"), {"edges/0", "edge"});
  expect_error(edges(R"([{"edge": 4}])"), {"edges/0/edge", "0 to 3"});
  expect_error(edges(R"([{"edge": 0, "hem": 20}])"), {"edges/0", "hem_mm"});
  expect_error(edges(R"([{"edge": 0, "tape_mm": -1}])"), {"tape_mm", "0 to 200", "-1"});
  expect_error(edges(R"([{"edge": 0, "allowance_mm": 201}])"), {"allowance_mm", "0 to 200", "201"});
  expect_error(edges(R"([{"edge": 0, "allowance_mm": 12}])"),
               {"/toile/panels/front/edges/0/allowance_mm", "none on an open edge", "12"});
  expect_error(edges(R"([{"edge": 0, "topstitched": true}])"), {"edges/0/topstitched", "`allowance_mm`"});
  expect_error(edges(R"([{"edge": 0, "topstitched": 1}])"), {"edges/0/topstitched"});
  expect_error(edges(R"([{"edge": 1}, {"edge": 1}])"), {"edges/1/edge", "each edge once"});
  expect_error(with(R"({"stitches": [{"stitch": 0, "angle_deg": 10}]})"), {"/toile/stitches/0/stitch"});
}

}  // namespace
}  // namespace toile::internal
