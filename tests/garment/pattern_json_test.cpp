// Reading sound pattern files: what each key does.
#include "garment/pattern_check.hpp"
#include "pattern_text.hpp"

#include <cmath>

namespace toile::internal {
namespace {

using namespace pattern_text;

Vec2 middle_of(const Panel& panel, std::size_t edge) { return sample_edge(panel, panel.edges[edge], 2)[1]; }

std::string with_curvature(const std::string& curvature, const std::string& properties = R"({"units_in_meter": 100})") {
  return file("{\"front\": " + panel(square_corners, R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]},
      {"endpoints": [2, 3], "curvature": )" + curvature + "}, {\"endpoints\": [3, 0]}]") +
                  "}",
              "[]", properties);
}

TEST(PatternFile, ReadsPanelsInMetres) {
  const Pattern pattern = parse(two_squares("[" + stitch("front", 1, "back", 3) + "]"));
  EXPECT_EQ(pattern.name, "p");
  ASSERT_EQ(pattern.panels.size(), 2U);
  EXPECT_EQ(pattern.panels[0].name, "front");
  EXPECT_EQ(pattern.panels[0].corners[2], Vec2(0.4, 0.6));
  EXPECT_EQ(pattern.panels[1].place({0.4, 0.6}), Vec3(0.4, 1.4, -0.2));
  ASSERT_EQ(pattern.stitches.size(), 1U);
  EXPECT_EQ(pattern.stitches[0].a.panel, 0);
  EXPECT_EQ(pattern.stitches[0].a.edge, 1);
  EXPECT_EQ(pattern.stitches[0].b.panel, 1);
  EXPECT_EQ(pattern.stitches[0].b.edge, 3);
  EXPECT_FALSE(pattern.stitches[0].right_wrong);
  EXPECT_FALSE(pattern.legacy_frame);
  EXPECT_FALSE(pattern.units_assumed);
}

TEST(PatternFile, NamesThePatternAfterItsFileOrFolder) {
  const std::string text = two_squares("[]");
  EXPECT_EQ(parse_pattern(text, "a/shirt_mean_specification.json").name, "shirt_mean");
  EXPECT_EQ(parse_pattern(text, "tee.json").name, "tee");
  EXPECT_EQ(parse_pattern(text, "data/tee_XY12/specification.json").name, "tee_XY12");
  EXPECT_EQ(parse_pattern(text, "specification.json").name, "specification");
}

TEST(PatternFile, ReadsLabelsAndTheThirdElementOfAStitch) {
  const Pattern pattern = parse(file(R"({"front": {"translation": [0, 80, 20], "rotation": [0, 0, 0], "label": "body",
      "vertices": [[0, 0], [40, 0], [40, 60], [0, 60]],
      "edges": [{"endpoints": [0, 1], "label": "lower_interface"}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
                {"endpoints": [3, 0]}]}})",
                                     "[" + stitch("front", 1, "front", 3, R"(, "right_wrong")") + "]"));
  EXPECT_EQ(pattern.panels[0].label, "body");
  EXPECT_EQ(pattern.panels[0].edges[0].label, "lower_interface");
  EXPECT_EQ(pattern.panels[0].edges[1].label, "");
  EXPECT_TRUE(pattern.stitches[0].right_wrong);
}

TEST(PatternFile, RelativeCurvatureLiesToTheLeftOfTheEdge) {
  // Edge 2 runs from (0.4, 0.6) to (0, 0.6); its left is -y.  Control: (0.4 - 0.25 * 0.4, 0.6 - 0.5 * 0.4).
  for (const char* curvature : {"[0.25, 0.5]", R"({"type": "quadratic", "params": [[0.25, 0.5]]})"}) {
    const Pattern pattern = parse(with_curvature(curvature));
    const PanelEdge& edge = pattern.panels[0].edges[2];
    EXPECT_EQ(edge.kind, CurveKind::quadratic);
    EXPECT_LT((edge.control[0] - Vec2(0.3, 0.4)).norm(), 1e-15);
  }
}

TEST(PatternFile, ReadsCubicCurves) {
  const Pattern pattern = parse(with_curvature(R"({"type": "cubic", "params": [[0.25, 0.1], [0.75, -0.1]]})"));
  const PanelEdge& edge = pattern.panels[0].edges[2];
  EXPECT_EQ(edge.kind, CurveKind::cubic);
  EXPECT_LT((edge.control[0] - Vec2(0.3, 0.56)).norm(), 1e-15);
  EXPECT_LT((edge.control[1] - Vec2(0.1, 0.64)).norm(), 1e-15);
}

TEST(PatternFile, ReadsCirclesWithTheirRadiusInFileUnits) {
  for (const char* flags : {"0, 1", "0.0, 1.0", "false, true"}) {
    const Pattern pattern = parse(with_curvature(R"({"type": "circle", "params": [25, )" + std::string(flags) + "]}"));
    const PanelEdge& edge = pattern.panels[0].edges[2];
    EXPECT_EQ(edge.kind, CurveKind::circle);
    EXPECT_EQ(edge.radius_m, 0.25);
    EXPECT_FALSE(edge.large_arc);
    EXPECT_TRUE(edge.sweep);
    // Counter-clockwise from right to left: over the top.  Sagitta 25 - sqrt(25^2 - 20^2) = 10 cm.
    EXPECT_LT((middle_of(pattern.panels[0], 2) - Vec2(0.2, 0.7)).norm(), 1e-15);
  }
}

TEST(PatternFile, AbsoluteCurvatureIsInPanelCoordinates) {
  const Pattern pattern =
      parse(with_curvature("[30, 40]", R"({"units_in_meter": 100, "curvature_coords": "absolute"})"));
  EXPECT_LT((pattern.panels[0].edges[2].control[0] - Vec2(0.3, 0.4)).norm(), 1e-15);
}

TEST(PatternFile, ScalesEveryLengthByTheUnit) {
  const std::string circle = R"({"type": "circle", "params": [25, 0, 1]})";
  const Pattern cm = parse(with_curvature(circle)), third = parse(with_curvature(circle, R"({"units_in_meter": 300})"));
  EXPECT_LT((third.panels[0].corners[2] - cm.panels[0].corners[2] / 3).norm(), 1e-15);
  EXPECT_LT((third.panels[0].translation_m - cm.panels[0].translation_m / 3).norm(), 1e-15);
  EXPECT_NEAR(third.panels[0].edges[2].radius_m, 0.25 / 3, 1e-15);
  const Pattern relative = parse(with_curvature("[0.25, 0.5]", R"({"units_in_meter": 300})"));
  EXPECT_LT((relative.panels[0].edges[2].control[0] - Vec2(0.1, 0.4 / 3)).norm(), 1e-15);
  const Pattern absolute =
      parse(with_curvature("[30, 40]", R"({"units_in_meter": 300, "curvature_coords": "absolute"})"));
  EXPECT_LT((absolute.panels[0].edges[2].control[0] - Vec2(0.1, 0.4 / 3)).norm(), 1e-15);
}

TEST(PatternFile, AssumesCentimetresWhenTheUnitIsMissingAndSaysSo) {
  const Pattern pattern = parse(file("{\"front\": " + panel() + "}", "[]", "{}"));
  EXPECT_TRUE(pattern.units_assumed);
  EXPECT_EQ(pattern.panels[0].corners[2], Vec2(0.4, 0.6));
  const PatternSummary summary = summarize(pattern);
  ASSERT_FALSE(summary.notes.empty());
  EXPECT_NE(summary.notes[0].find("units_in_meter"), std::string::npos);
}

TEST(PatternFile, NormalisedPanelsTurnAboutTheirMiddle) {
  const std::string edges = R"([{"endpoints": [0, 1], "curvature": [0.5, -0.5]}, {"endpoints": [1, 2]},
                                {"endpoints": [2, 3]}, {"endpoints": [3, 0]}])";
  const Pattern pattern = parse(file("{\"front\": " + panel(square_corners, edges, "[0, 80, 20]", "[0, 0, 90]") + "}",
                                     "[]", R"({"units_in_meter": 100, "normalize_panel_translation": true})"));
  const Panel& front = pattern.panels[0];
  EXPECT_LT((front.place({0, 0}) - Vec3(0.2, 1.1, 0.2)).norm(), 1e-15);
  // Corner 0 was at (-20, -30) from the middle; a quarter turn brings it to (30, -20).
  EXPECT_LT((front.place(front.corners[0]) - Vec3(0.5, 0.9, 0.2)).norm(), 1e-15);
  // The control point was at (0, -50) from the middle.
  EXPECT_LT((front.place(front.edges[0].control[0]) - Vec3(0.7, 1.1, 0.2)).norm(), 1e-15);
}

TEST(PatternFile, ReordersTheEdgesOfALoopAndKeepsTheStitchesOnThem) {
  const std::string shuffled =
      R"([{"endpoints": [1, 2]}, {"endpoints": [3, 0], "label": "left"}, {"endpoints": [0, 1]}, {"endpoints": [2, 3]}])";
  const Pattern pattern = parse(file("{\"a\": " + panel(square_corners, shuffled) + ", \"b\": " + panel() + "}",
                                     "[" + stitch("a", 1, "b", 1) + "]"));
  const Panel& a = pattern.panels[0];
  EXPECT_EQ(a.edges[0].start, 1);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(a.edges[k].end, a.edges[(k + 1) % 4].start);
  EXPECT_EQ(pattern.stitches[0].a.edge, 2);
  EXPECT_EQ(a.edges[2].label, "left");
  EXPECT_EQ(a.file_number(2), 1);
}

TEST(PatternFile, KeepsClockwiseLoops) {
  const std::string clockwise =
      R"([{"endpoints": [0, 3]}, {"endpoints": [3, 2]}, {"endpoints": [2, 1]}, {"endpoints": [1, 0]}])";
  const Pattern pattern = parse(one_panel(square_corners, clockwise));
  EXPECT_EQ(pattern.panels[0].edges[0].end, 3);
  EXPECT_TRUE(summarize(pattern).panels[0].clockwise);
  EXPECT_NEAR(summarize(pattern).panels[0].area_m2, 0.24, 1e-15);
  EXPECT_FALSE(summarize(parse(two_squares("[]"))).panels[0].clockwise);
}

TEST(PatternFile, TwoEdgesMakeAPanelWhenOneIsCurved) {
  const Pattern pattern = parse(one_panel(
      "[[0, 0], [40, 0]]",
      R"([{"endpoints": [0, 1]}, {"endpoints": [1, 0], "curvature": {"type": "circle", "params": [20, 0, 1]}}])"));
  EXPECT_NEAR(summarize(pattern).panels[0].area_m2, 0.5 * 3.14159265 * 0.04, 1e-6);
}

TEST(PatternFile, PanelOrderDecidesTheOrder) {
  const std::string panels = "{\"front\": " + panel() + ", \"back\": " + panel() + "}";
  const Pattern pattern = parse(file(panels, "[" + stitch("front", 1, "back", 3) + "]", R"({"units_in_meter": 100})",
                                     R"(, "panel_order": ["back", "front"])"));
  EXPECT_EQ(pattern.panels[0].name, "back");
  EXPECT_EQ(pattern.stitches[0].a.panel, 1);
  EXPECT_EQ(pattern.stitches[0].b.panel, 0);
}

TEST(PatternFile, IgnoresWhatOtherToolsAddAroundThePanels) {
  EXPECT_EQ(message_of(file("{\"front\": " + panel() + "}", "[]", R"({"units_in_meter": 100, "garment": "x"})",
                            R"(, "made_by": "someone")", R"(, "parameters": {}, "constraints": {"a": 1})")),
            "(no error)");
}

TEST(PatternFile, GarmentBelowTheFloorIsInTheOldFrame) {
  const auto legacy = [](const std::string& translation, const std::string& more) {
    const std::string panels = "{\"front\": " + panel(square_corners, square_edges, translation) + "}";
    return parse(file(panels, "[]", R"({"units_in_meter": 100})", "", more)).legacy_frame;
  };
  const std::string parameters = R"(, "parameters": {"length": {"value": 1}})";
  EXPECT_TRUE(legacy("[0, -40, 0]", ""));          // -0.4 ... 0.2 m
  EXPECT_FALSE(legacy("[0, -20, 0]", ""));         // -0.2 ... 0.4 m: a train on the floor
  EXPECT_TRUE(legacy("[0, -20, 0]", parameters));  // a template: the same height is above its pelvis
  EXPECT_FALSE(legacy("[0, 80, 0]", parameters));  // a template that somebody raised
  EXPECT_TRUE(legacy("[0, 5, 0]", parameters));    // 0.05 ... 0.65 m
  EXPECT_FALSE(legacy("[0, 15, 0]", parameters));  // 0.15 ... 0.75 m: trousers of a child on the floor
  EXPECT_FALSE(legacy("[0, -20, 0]", R"(, "parameters": {})"));
}

TEST(PatternSummary, CountsDartsAndEase) {
  // A square whose bottom has a dart: edges 1 and 2, 10 and 10.44 cm long.
  const std::string corners = "[[0, 0], [15, 0], [20, 10], [26, 0], [40, 0], [40, 60], [0, 60]]";
  const std::string edges =
      R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 4]},
      {"endpoints": [4, 5]}, {"endpoints": [5, 6]}, {"endpoints": [6, 0]}])";
  const Pattern pattern =
      parse(file("{\"skirt\": " + panel(corners, edges) + ", \"band\": " + panel() + ", \"loose\": " + panel() + "}",
                 "[" + stitch("skirt", 1, "skirt", 2) + "," + stitch("skirt", 4, "skirt", 6) + "," +
                     stitch("skirt", 0, "band", 0) + "]"));
  const PatternSummary summary = summarize(pattern);
  EXPECT_EQ(summary.stitches, 3);
  EXPECT_EQ(summary.darts, 1) << "the side seam of a tube is no dart";
  EXPECT_EQ(summary.eased_stitches, 2);
  EXPECT_NEAR(summary.longest_ratio, 40.0 / 15.0, 1e-12);
  EXPECT_EQ(summary.longest_ratio_stitch, 2);
  EXPECT_NEAR(summary.panels[0].outline_m, 0.15 + std::sqrt(0.0125) + std::sqrt(0.0136) + 0.14 + 1.6, 1e-12);
  EXPECT_NEAR(summary.panels[0].area_m2, 0.24 - 0.5 * 0.11 * 0.1, 1e-12);
  EXPECT_EQ(summary.panels[0].stitched_edges, 5);
  EXPECT_NE(summary.notes.back().find("2 seams"), std::string::npos);
  EXPECT_NE(summary.notes.front().find("1 panel is sewn to nothing"), std::string::npos);
}

TEST(PatternSummary, BoxHoldsThePlacedPanelsWithTheirCurves) {
  const PatternSummary summary = summarize(parse(with_curvature(R"({"type": "circle", "params": [25, 0, 1]})")));
  EXPECT_LT((summary.box_min_m - Vec3(0, 0.8, 0.2)).norm(), 1e-12);
  EXPECT_LT((summary.box_max_m - Vec3(0.4, 1.5, 0.2)).norm(), 1e-5);
}

}  // namespace
}  // namespace toile::internal
