// Pattern files and patterns that cannot be meant: each error names the place, what was expected and what was found.
#include "garment/pattern_check.hpp"
#include "pattern_text.hpp"

#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

using namespace pattern_text;

std::string edges_of(const std::string& first_edge) {
  return "[" + first_edge + R"(, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}])";
}

std::string with_first_edge(const std::string& edge) { return one_panel(square_corners, edges_of(edge)); }

std::string with_units(const std::string& units) {
  return file("{\"front\": " + panel() + "}", "[]", "{\"units_in_meter\": " + units + "}");
}

TEST(PatternFaults, RefusesFilesThatAreNoPattern) {
  expect_error("", {"expected"});
  expect_error("[]", {"1:1", "an object with the key \"pattern\"", "array"});
  expect_error("{}", {"\"pattern\""});
  expect_error(R"({"pattern": {"stitches": []}})", {"/pattern", "\"panels\""});
  expect_error(R"({"pattern": {"panels": {}, "stitches": []}})", {"/pattern/panels", "at least one panel"});
  expect_error(R"({"pattern": {"panels": [], "stitches": []}})", {"/pattern/panels", "an object"});
  expect_error(R"({"pattern": {"panels": {"a": )" + panel() + "}}}", {"/pattern", "\"stitches\""});
  expect_error("// a comment\n{}", {":1:", "expected"});
  EXPECT_THROW(load_pattern("/nonexistent/p.json"), IoError);
}

TEST(PatternFaults, RefusesTruncatedFilesAtEveryByte) {
  const std::string text = two_squares("[" + stitch("front", 1, "back", 3) + "]");
  for (std::size_t size = 0; size + 1 < text.size(); ++size) {
    EXPECT_THROW(parse(text.substr(0, size)), InputError) << size;
  }
}

TEST(PatternFaults, RefusesNumbersThatAreNone) {
  expect_error(one_panel("[[NaN, 0], [40, 0], [40, 60], [0, 60]]", square_edges), {"expected"});
  expect_error(one_panel("[[1e999, 0], [40, 0], [40, 60], [0, 60]]", square_edges), {"expected"});
  expect_error(one_panel("[[\"0\", 0], [40, 0], [40, 60], [0, 60]]", square_edges),
               {"/pattern/panels/front/vertices/0/0", "a number"});
  expect_error(one_panel("[[0, 0, 0], [40, 0], [40, 60], [0, 60]]", square_edges),
               {"/pattern/panels/front/vertices/0", "an array of 2 numbers", "an array of 3"});
  expect_error(one_panel("[[0, 0], [1e300, 0], [40, 60], [0, 60]]", square_edges),
               {"/pattern/panels/front/vertices/1", "within 1000 m"});
}

TEST(PatternFaults, NamesLineAndColumn) {
  // The second line of the file holds the panels.
  EXPECT_NE(message_of(with_first_edge(R"({"endpoints": [0, 9]})")).find("p_specification.json:2:"), std::string::npos);
}

TEST(PatternFaults, RefusesMisspeltKeysWithTheNearest) {
  expect_error(with_first_edge(R"({"endpoint": [0, 1]})"), {"/pattern/panels/front/edges/0", "\"endpoints\""});
  expect_error(with_first_edge(R"({"endpoints": [0, 1], "curvatur": [0, 1]})"), {"\"curvature\"", "\"curvatur\""});
  expect_error(with_first_edge(R"({"endpoints": [0, 1], "curvature": {"type": "circle", "param": [1, 2, 3]}})"),
               {"\"params\""});
  expect_error(file(R"({"front": {"translation": [0, 0, 0], "rotations": [0, 0, 0], "vertices": [], "edges": []}})"),
               {"\"rotation\"", "\"rotations\""});
  expect_error(two_squares(R"([[{"panel": "front", "edges": 1}, {"panel": "back", "edge": 3}]])"),
               {"/pattern/stitches/0/0", "\"edge\""});
}

TEST(PatternFaults, RefusesMissingKeys) {
  expect_error(file(R"({"front": {"rotation": [0, 0, 0], "vertices": [], "edges": []}})"),
               {"/pattern/panels/front", "\"translation\""});
  expect_error(file(R"({"front": {"translation": [0, 0, 0], "vertices": [], "edges": []}})"), {"\"rotation\""});
  expect_error(file(R"({"front": {"translation": [0, 0, 0], "rotation": [0, 0, 0], "edges": []}})"), {"\"vertices\""});
  expect_error(file(R"({"front": {"translation": [0, 0, 0], "rotation": [0, 0, 0], "vertices": []}})"), {"\"edges\""});
  expect_error(file(R"({"front": {"translation": [0, 0], "rotation": [0, 0, 0], "vertices": [], "edges": []}})"),
               {"/pattern/panels/front/translation", "an array of 3 numbers"});
  expect_error(with_first_edge("{}"), {"\"endpoints\""});
}

TEST(PatternFaults, RefusesCurvesItDoesNotKnow) {
  const auto curved = [](const std::string& c) {
    return with_first_edge(R"({"endpoints": [0, 1], "curvature": )" + c + "}");
  };
  const std::string place = "/pattern/panels/front/edges/0/curvature";
  expect_error(curved(R"({"type": "qubic", "params": [[0, 1]]})"),
               {place + "/type", "\"quadratic\", \"cubic\" or \"circle\"", "qubic", "did you mean \"cubic\""});
  expect_error(curved(R"({"type": "cubic", "params": [[0, 1]]})"), {place + "/params", "two control points"});
  expect_error(curved(R"({"type": "quadratic", "params": [0, 1]})"), {place + "/params", "one control point"});
  expect_error(curved(R"({"type": "circle", "params": [30, 0, 2]})"), {place + "/params/2", "0 or 1", "got 2"});
  expect_error(curved(R"({"type": "circle", "params": [-30, 0, 1]})"), {place + "/params/0", "> 0", "-30"});
  expect_error(curved("[0, 1, 2]"), {place, "an array of 2 numbers"});
  expect_error(curved("0.5"), {place, "a curvature"});
  expect_error(curved("[0, 1e9]"), {"/pattern/panels/front/edges/0", "control points within 1000 m"});
}

TEST(PatternFaults, RefusesACircleThatCannotReach) {
  expect_error(with_first_edge(R"({"endpoints": [0, 1], "curvature": {"type": "circle", "params": [19, 0, 1]}})"),
               {"/pattern/panels/front/edges/0:", "at least half", "0.2 m", "0.19 m"});
}

TEST(PatternFaults, RefusesIndicesOutOfRange) {
  expect_error(with_first_edge(R"({"endpoints": [0, 4]})"), {"/edges/0/endpoints/1", "0 to 3", "got 4"});
  expect_error(with_first_edge(R"({"endpoints": [-1, 1]})"), {"/edges/0/endpoints/0", "0 to 3", "-1"});
  expect_error(with_first_edge(R"({"endpoints": [0.5, 1]})"), {"/edges/0/endpoints/0", "0.5"});
  expect_error(with_first_edge(R"({"endpoints": [4294967296, 1]})"), {"/edges/0/endpoints/0", "4294967296"});
  expect_error(with_first_edge(R"({"endpoints": [0, 1, 2]})"), {"/edges/0/endpoints", "two corners"});
  expect_error(with_first_edge(R"({"endpoints": "01"})"), {"/edges/0/endpoints", "two corners"});
}

TEST(PatternFaults, NamesTheEdgeWhereALoopIsOpen) {
  expect_error(one_panel(square_corners, R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}])"),
               {"/pattern/panels/front/edges/2", "a closed loop", "edge 2 ending at corner 3"});
  // Edge 2 the other way round.
  expect_error(one_panel(square_corners, R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [3, 2]},
                                             {"endpoints": [3, 0]}])"),
               {"/pattern/panels/front/edges/3", "edge 3 leaving corner 3 as edge 2 does"});
  // Two triangles.
  expect_error(one_panel("[[0, 0], [9, 0], [0, 9], [20, 0], [29, 0], [20, 9]]",
                         R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 0]},
                             {"endpoints": [3, 4]}, {"endpoints": [4, 5]}, {"endpoints": [5, 3]}])"),
               {"/pattern/panels/front/edges/3", "one closed loop", "edge 3 outside"});
  // Edge 0 runs into a loop that it does not belong to.
  expect_error(
      one_panel("[[0, 0], [9, 0], [0, 9], [20, 0]]",
                R"([{"endpoints": [3, 0]}, {"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 0]}])"),
      {"edges/", "loop"});
}

TEST(PatternFaults, RefusesTooFewEdges) {
  expect_error(one_panel("[[0, 0], [9, 0]]", R"([{"endpoints": [0, 1]}, {"endpoints": [1, 0]}])"),
               {"/pattern/panels/front", "at least 3 edges", "got 2"});
  expect_error(one_panel("[]", "[]"), {"/pattern/panels/front", "at least 3 edges", "got 0"});
}

TEST(PatternFaults, RefusesRepeatedAndUnusedCorners) {
  expect_error(with_first_edge(R"({"endpoints": [1, 1]})"), {"/edges/0/endpoints", "two different corners"});
  expect_error(one_panel("[[0, 0], [40, 0], [40, 60], [0, 60], [1, 1]]", square_edges),
               {"/pattern/panels/front/vertices/4", "a corner that an edge uses"});
  expect_error(one_panel("[[0, 0], [40, 0], [40, 0], [0, 60]]", square_edges),
               {"/pattern/panels/front/vertices/2", "corner 1 again: edge 1 has no length"});
  // An eight that passes through one point with two corners.
  expect_error(one_panel("[[0, 0], [10, 10], [20, 0], [20, 20], [10, 10.0000001], [0, 20]]",
                         R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 4]},
                             {"endpoints": [4, 5]}, {"endpoints": [5, 0]}])"),
               {"/pattern/panels/front/vertices/4", "corner 1 again"});
}

TEST(PatternFaults, NamesBothEdgesOfASelfCrossing) {
  expect_error(one_panel("[[0, 0], [40, 60], [40, 0], [0, 60]]", square_edges),
               {"/pattern/panels/front/edges/0", "edge 0 crosses or touches edge 2", "near"});
  // Straight edges do not cross, but the curved bottom reaches the top.
  expect_error(with_first_edge(R"({"endpoints": [0, 1], "curvature": [0.5, 3.1]})"),
               {"edge 0 crosses or touches edge 2"});
  EXPECT_EQ(message_of(with_first_edge(R"({"endpoints": [0, 1], "curvature": [0.5, 2.9]})")), "(no error)");
  expect_error(
      with_first_edge(R"({"endpoints": [0, 1], "curvature": {"type": "cubic", "params": [[1.6, 1], [-0.6, 1]]}})"),
      {"/pattern/panels/front/edges/0", "edge 0 crosses itself"});
  // A corner that lies on another edge.
  expect_error(one_panel("[[0, 0], [40, 0], [40, 60], [20, 0], [0, 60]]",
                         R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 4]},
                             {"endpoints": [4, 0]}])"),
               {"edge 0 crosses or touches edge 2"});
  // A spike without width.
  expect_error(one_panel("[[0, 0], [40, 0], [20, 0], [20, 60]]", square_edges), {"edge 0 crosses or touches edge 1"});
  // Edges that are given out of order keep their numbers in messages.
  expect_error(
      one_panel("[[0, 0], [40, 60], [40, 0], [0, 60]]",
                R"([{"endpoints": [0, 1]}, {"endpoints": [3, 0]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}])"),
      {"/pattern/panels/front/edges/0", "edge 0 crosses or touches edge 3"});
}

TEST(PatternFaults, AcceptsNarrowDartsAndTangentCurves) {
  EXPECT_EQ(message_of(one_panel("[[0, 0], [19.99, 0], [20, 50], [20.01, 0], [40, 0], [40, 60], [0, 60]]",
                                 R"([{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
                                     {"endpoints": [3, 4]}, {"endpoints": [4, 5]}, {"endpoints": [5, 6]},
                                     {"endpoints": [6, 0]}])")),
            "(no error)");
  EXPECT_EQ(message_of(with_first_edge(R"({"endpoints": [0, 1], "curvature": [0.5, -0.5]})")), "(no error)");
}

TEST(PatternFaults, AsksAboutTheUnitWhenAPanelHasAStrangeSize) {
  expect_error(with_units("1"), {"/pattern/panels/front", "between 1 mm and 10 m", "40 m x 60 m", "units_in_meter"});
  expect_error(with_units("100000"), {"between 1 mm and 10 m", "units_in_meter"});
  expect_error(with_units("0"), {"/properties/units_in_meter", "> 0", "got 0"});
  expect_error(with_units("-100"), {"/properties/units_in_meter", "> 0"});
  expect_error(with_units("\"100\""), {"/properties/units_in_meter", "a number"});
  expect_error(with_units("1e-300"), {"/pattern/panels/front/vertices/1", "within 1000 m"});
  expect_error(file("{\"front\": " + panel() + "}", "[]", R"({"curvature_coords": "relativ"})"),
               {"/properties/curvature_coords", "did you mean \"relative\""});
}

TEST(PatternFaults, SuggestsTheNearestPanelOfAStitch) {
  expect_error(two_squares("[" + stitch("front", 1, "bcak", 3) + "]"),
               {"/pattern/stitches/0/1/panel", "bcak", "did you mean \"back\""});
  expect_error(two_squares("[" + stitch("front", 4, "back", 3) + "]"),
               {"/pattern/stitches/0/0/edge", "an edge of panel \"front\", 0 to 3", "got 4"});
  expect_error(two_squares("[" + stitch("front", -1, "back", 3) + "]"), {"/pattern/stitches/0/0/edge", "-1"});
  expect_error(two_squares(R"([[{"panel": 0, "edge": 1}, {"panel": "back", "edge": 3}]])"),
               {"/pattern/stitches/0/0/panel", "the name of a panel"});
  expect_error(two_squares(R"([[{"panel": "front", "edge": 1}]])"), {"/pattern/stitches/0", "two sides"});
  expect_error(two_squares("[" + stitch("front", 1, "back", 3, R"(, "right_worng")") + "]"),
               {"/pattern/stitches/0/2", "did you mean \"right_wrong\""});
  expect_error(two_squares(R"({"a": 1})"), {"/pattern/stitches", "an array"});
}

TEST(PatternFaults, NamesBothStitchesOfAnEdge) {
  expect_error(two_squares("[" + stitch("front", 1, "back", 3) + ", " + stitch("back", 1, "front", 1) + "]"),
               {"/pattern/stitches/1/1:", "edge 1 of panel \"front\", sewn by stitch 0 already"});
  expect_error(two_squares("[" + stitch("front", 1, "front", 1) + "]"),
               {"/pattern/stitches/0:", "two different edges", "edge 1 of panel \"front\" with itself"});
}

TEST(PatternFaults, RefusesADartWhoseTipIsSewnToItsMouth) {
  expect_error(two_squares("[" + stitch("front", 1, "front", 2, R"(, "right_wrong")") + "]"),
               {"/pattern/stitches/0:", "a dart"});
}

TEST(PatternFaults, RefusesSeamsOfVeryDifferentLength) {
  const auto with_sleeve = [](const std::string& width) {
    return file(
        "{\"a\": " + panel() + ", \"b\": " + panel("[[0, 0], [" + width + ", 0], [" + width + ", 60], [0, 60]]") + "}",
        "[" + stitch("a", 0, "b", 0) + "]");
  };
  EXPECT_EQ(message_of(with_sleeve("8")), "(no error)") << "gathers of 5:1";
  expect_error(with_sleeve("6.6"), {"/pattern/stitches/0:", "a factor of 6", "0.4 m", "0.066 m"});
}

TEST(PatternFaults, RefusesAPanelOrderThatIsNone) {
  const auto ordered = [](const std::string& order) {
    return file("{\"front\": " + panel() + ", \"back\": " + panel() + "}", "[]", R"({"units_in_meter": 100})",
                ", \"panel_order\": " + order);
  };
  expect_error(ordered(R"(["front"])"), {"/pattern/panel_order", "none called \"back\""});
  expect_error(ordered(R"(["front", "front"])"), {"/pattern/panel_order/1", "each panel once"});
  expect_error(ordered(R"(["front", "bakc"])"), {"/pattern/panel_order/1", "did you mean \"back\""});
}

TEST(PatternFaults, LimitsTheNumberOfEdges) {
  const auto polygon = [](int n) {
    std::string corners, edges;
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * 3.14159265358979 * k / n;
      corners += (k > 0 ? ",[" : "[") + std::to_string(100 * std::cos(angle)) + "," +
                 std::to_string(100 * std::sin(angle)) + "]";
      edges += (k > 0 ? ",{\"endpoints\":[" : "{\"endpoints\":[") + std::to_string(k) + "," +
               std::to_string((k + 1) % n) + "]}";
    }
    return panel("[" + corners + "]", "[" + edges + "]");
  };
  EXPECT_EQ(message_of(file("{\"a\": " + polygon(1000) + "}")), "(no error)");
  expect_error(file("{\"a\": " + polygon(1001) + "}"), {"/pattern/panels/a", "at most 1000 edges", "1001"});
  std::string panels;
  for (int p = 0; p < 6; ++p) panels += (p > 0 ? ", \"p" : "{\"p") + std::to_string(p) + "\": " + polygon(900);
  expect_error(file(panels + "}"), {"/pattern:", "at most 5000 edges", "5400"});
}

TEST(PatternFaults, HostileNamesStayOnOneLine) {
  const std::string message =
      message_of(file(R"({"a\nb\u001b[31m": )" + panel("[[0, 0], [40, 60], [40, 0], [0, 60]]") + "}"));
  EXPECT_NE(message.find("crosses"), std::string::npos) << message;
  for (const char c : message) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
  const std::string long_name(100'000, 'x');
  expect_error(two_squares("[" + stitch(long_name, 1, "back", 3) + "]"), {"/pattern/stitches/0/0/panel"});
}

// ---- patterns made in memory ----------------------------------------------------------------------------------------

TEST(PatternInMemory, ListsAllFaults) {
  Pattern pattern = parse(two_squares("[" + stitch("front", 1, "back", 3) + "]"));
  EXPECT_TRUE(find_faults(pattern).empty());
  EXPECT_NO_THROW(check_pattern(pattern));
  pattern.panels[0].edges[1].end = 7;
  pattern.panels[1].corners[2].x() = std::numeric_limits<double>::quiet_NaN();
  pattern.stitches.push_back({{0, 9}, {1, 0}, false});
  const auto faults = find_faults(pattern);
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_EQ(place_of(pattern, faults[0]), "panel \"front\", edge 1");
  EXPECT_EQ(place_of(pattern, faults[1]), "panel \"back\", corner 2");
  EXPECT_EQ(place_of(pattern, faults[2]), "stitch 1");
  try {
    check_pattern(pattern);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "p: panel \"front\", edge 1: expected corners 0 to 3, got 1 and 7");
  }
}

TEST(PatternInMemory, SurvivesEveryBadIndex) {
  const Pattern sound = parse(two_squares("[" + stitch("front", 1, "back", 3) + "]"));
  for (const Index bad : {-1, 4, 1 << 30, std::numeric_limits<Index>::min()}) {
    for (int field = 0; field < 6; ++field) {
      Pattern pattern = sound;
      if (field == 0) pattern.panels[0].edges[0].start = bad;
      if (field == 1) pattern.panels[0].edges[3].end = bad;
      if (field == 2) pattern.stitches[0].a.panel = bad;
      if (field == 3) pattern.stitches[0].a.edge = bad;
      if (field == 4) pattern.stitches[0].b.panel = bad;
      if (field == 5) pattern.stitches[0].b.edge = bad;
      EXPECT_EQ(find_faults(pattern).size(), 1U) << field << " " << bad;
    }
  }
  EXPECT_EQ(find_faults(Pattern{}).size(), 1U);
}

TEST(PatternInMemory, RefusesNumbersThatAreNotFinite) {
  const Pattern sound = parse(two_squares("[]"));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (int field = 0; field < 4; ++field) {
      Pattern pattern = sound;
      PanelEdge& edge = pattern.panels[0].edges[1];
      if (field == 0) pattern.panels[0].translation_m.z() = bad;
      if (field == 1) pattern.panels[0].rotation_deg.x() = bad;
      if (field == 2) edge.kind = CurveKind::cubic, edge.control[1].x() = bad;
      if (field == 3) edge.kind = CurveKind::circle, edge.radius_m = bad;
      EXPECT_EQ(find_faults(pattern).size(), 1U) << field;
    }
  }
}

TEST(PatternInMemory, ListsAtMostAHundredFaults) {
  Pattern pattern = parse(two_squares("[]"));
  for (int k = 0; k < 5000; ++k) pattern.stitches.push_back({{0, 1}, {1, 3}, false});
  EXPECT_EQ(find_faults(pattern).size(), PatternLimits::max_faults);
}

}  // namespace
}  // namespace toile::internal
