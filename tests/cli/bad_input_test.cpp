// Whatever is wrong with an input: the right exit code, one line on stderr that names file, place, what was expected and what is
// there, and no directory that looks like a finished run.
#include "body/solid_shapes.hpp"
#include "cli/program.hpp"
#include "io/json.hpp"
#include "io/obj.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

void expect_refused(const Scratch& scratch, const Ended& ended, int exit_code,
                    std::initializer_list<std::string_view> words) {
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.exit_code, exit_code) << ended.err;
  EXPECT_EQ(ended.err_lines(), 1) << ended.err;
  for (const std::string_view word : words)
    EXPECT_NE(ended.err.find(word), std::string::npos) << '"' << word << "\" is not in: " << ended.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/report.json"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/cloth.pc2"));
}

std::string put_body(const Scratch& scratch, double scale = 1, std::string_view name = "body.obj") {
  SolidMesh solid = rounded_cylinder(0.2 * scale, 1.0 * scale, Vec3(0, scale, 0));
  SurfaceMesh obj;
  obj.positions = solid.positions;
  obj.triangles = solid.triangles;
  write_obj(scratch / name, obj);
  return std::string(name);
}

// Two rectangles in front of and behind the body, sewn at both sides.
std::string pattern(std::string_view front_edges, std::string_view stitches,
                    std::string_view front_vertices = "[[-30,0],[30,0],[30,40],[-30,40]]") {
  return R"({"pattern": {"panels": {
    "front": {"translation": [0, 40, 30], "rotation": [0, 0, 0], "vertices": )" +
         std::string(front_vertices) + R"(, "edges": [)" + std::string(front_edges) + R"(]},
    "back": {"translation": [0, 40, -30], "rotation": [0, 0, 0], "vertices": [[-30,0],[-30,40],[30,40],[30,0]],
      "edges": [{"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,3]}, {"endpoints": [3,0]}]}},
    "stitches": [)" +
         std::string(stitches) + R"(]}, "properties": {"units_in_meter": 100}})";
}
const std::string good_edges =
    R"({"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,3]}, {"endpoints": [3,0]})";
const std::string good_stitches =
    R"([{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}], [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}])";

void expect_pattern_refused(const std::string& text, std::initializer_list<std::string_view> words) {
  const Scratch scratch;
  scratch.put("p.json", text);
  put_body(scratch);
  expect_refused(scratch, run_toile(scratch, {"dress", "p.json", "--body", "body.obj", "--out", "out", "--quiet"}), 3,
                 words);
  const Ended check = run_toile(scratch, {"check", "p.json"});
  EXPECT_EQ(check.exit_code, 3) << "toile check finds the same";
}

void expect_body_refused(const std::string& text, int code, std::initializer_list<std::string_view> words) {
  const Scratch scratch;
  scratch.put("p.json", pattern(good_edges, good_stitches));
  scratch.put("body.obj", text);
  expect_refused(scratch, run_toile(scratch, {"dress", "p.json", "--body", "body.obj", "--out", "out", "--quiet"}),
                 code, words);
}

void expect_scene_refused(const std::string& text, std::initializer_list<std::string_view> words) {
  const Scratch scratch;
  scratch.put("s.json", text);
  expect_refused(scratch, run_toile(scratch, {"run", "s.json", "--out", "out", "--quiet"}), 3, words);
}

TEST(BadInput, AMissingFileIsAnOutputError) {
  const Scratch scratch;
  put_body(scratch);
  expect_refused(scratch, run_toile(scratch, {"dress", "none.json", "--body", "body.obj", "--out", "out"}), 6,
                 {"none.json"});
  expect_refused(scratch, run_toile(scratch, {"run", "none.json", "--out", "out"}), 6, {"none.json"});
  expect_refused(scratch, run_toile(scratch, {"check", "none.obj"}), 6, {"none.obj"});
  scratch.put("p.json", pattern(good_edges, good_stitches));
  expect_refused(scratch, run_toile(scratch, {"dress", "p.json", "--body", "none.obj", "--out", "out"}), 6,
                 {"none.obj"});
}

TEST(BadInput, ATruncatedFileIsNamedWithItsLine) {
  const std::string whole = pattern(good_edges, good_stitches);
  expect_pattern_refused(whole.substr(0, whole.size() / 2), {"p.json:", "expected", "got"});
}

TEST(BadInput, NotANumberInABody) {
  expect_body_refused("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", 3, {"body.obj:3", "expected", "nan"});
}
TEST(BadInput, AnEmptyMesh) { expect_body_refused("v 0 0 0\n", 3, {"body.obj", "expected", "got"}); }
TEST(BadInput, AnIndexOutOfRange) {
  expect_body_refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", 3, {"body.obj:4", "expected an index in 1..3", "got 9"});
}

TEST(BadInput, ABodyThatIsNotClosed) {
  expect_body_refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n", 3,
                      {"body.obj", "1 hole (3.41 m round", "expected", "got"});
}

TEST(BadInput, ATriangleWithoutArea) {
  const Scratch scratch;
  scratch.put("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  expect_refused(scratch, run_toile(scratch, {"check", "flat.obj"}), 3,
                 {"flat.obj", "triangle 0", "expected an area above zero", "got 0"});
  // In a closed body it is mended: one edge of the tetrahedron has a corner in its middle.
  scratch.put("body.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.5 0 0\nf 1 3 2\nf 1 2 5\nf 1 5 4\nf 5 2 4\nf 2 3 4\nf 1 4 3\n");
  const Ended body = run_toile(scratch, {"check", "body.obj"});
  EXPECT_EQ(body.exit_code, 0) << body.err;
  EXPECT_NE(body.out.find("mended: 1 flat triangles have another diagonal"), std::string::npos) << body.out;
}

TEST(BadInput, ABodyInTheWrongUnitIsAskedFor) {
  const Scratch scratch;
  scratch.put("p.json", pattern(good_edges, good_stitches));
  put_body(scratch, 100);
  expect_refused(scratch, run_toile(scratch, {"dress", "p.json", "--body", "body.obj", "--out", "out"}), 3,
                 {"body.obj", "--body-unit", "cm"});
}

TEST(BadInput, APatternWithAnOpenLoop) {
  expect_pattern_refused(pattern(R"({"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,3]})", good_stitches),
                         {"p.json:", "front", "expected", "got"});
}
TEST(BadInput, APanelThatCrossesItself) {
  expect_pattern_refused(pattern(good_edges, good_stitches, "[[-30,0],[30,40],[30,0],[-30,40]]"),
                         {"p.json", "front", "expected", "got"});
}
TEST(BadInput, AStitchToAMissingEdge) {
  expect_pattern_refused(pattern(good_edges, R"([{"panel": "front", "edge": 7}, {"panel": "back", "edge": 2}])"),
                         {"p.json:", "stitches/0", "expected", "got 7"});
}
TEST(BadInput, AnEdgeStitchedTwice) {
  expect_pattern_refused(
      pattern(
          good_edges,
          R"([{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}], [{"panel": "front", "edge": 1}, {"panel": "back", "edge": 0}])"),
      {"p.json:", "stitches/1", "expected", "got"});
}
TEST(BadInput, ATwistedSeam) {
  expect_pattern_refused(
      pattern(
          good_edges,
          R"([{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}, "right_wrong"], [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}])"),
      {"p.json", "seam front.3 - back.0", "twisted"});
}
TEST(BadInput, AnUnknownCurve) {
  expect_pattern_refused(
      pattern(
          R"({"endpoints": [0,1], "curvature": {"type": "spline", "params": [[0.5, 0.1]]}}, {"endpoints": [1,2]}, {"endpoints": [2,3]}, {"endpoints": [3,0]})",
          good_stitches),
      {"p.json:", "curvature", "expected", "spline"});
}

TEST(BadInput, ANegativeStiffnessOrDensity) {
  expect_scene_refused("{\"cloth\": [{\"grid\": {},\n \"fabric\": {\"density_kg_per_m2\": -0.2}}]}",
                       {"s.json:2", "/cloth/0/fabric/density_kg_per_m2", "expected a number above zero", "got -0.2"});
  expect_scene_refused("{\"cloth\": [{\"grid\": {}, \"fabric\": {\"stretch_u_N_per_m\": -1}}]}",
                       {"s.json:1", "stretch_u_N_per_m", "got -1"});
}
TEST(BadInput, AnUnknownKeyIsAnsweredWithTheNearest) {
  expect_scene_refused("{\"cloth\": [{\"grid\": {\"widht_m\": 2}}]}",
                       {"s.json:1", "/cloth/0/grid", "width_m", "widht_m"});
  expect_scene_refused("{\"cloth\": [{\"grid\": {}}], \"wrold\": {}}", {"world", "wrold"});
}
TEST(BadInput, AFabricThatDoesNotExistIsAnsweredWithTheNearest) {
  expect_scene_refused("{\"cloth\": [{\"grid\": {}, \"fabric\": \"coton\"}]}",
                       {"/cloth/0/fabric", "nearest is \"cotton\"", "coton"});
}
TEST(BadInput, GridsAndPatternsDoNotMix) {
  expect_scene_refused("{\"cloth\": [{\"grid\": {}}, {\"pattern\": \"p.json\"}]}", {"/cloth/1", "the other kind"});
}
TEST(BadInput, TwoGarmentsOfOneNameAreRefused) {
  expect_scene_refused("{\"cloth\": [{\"name\": \"a\", \"grid\": {}}, {\"name\": \"a\", \"grid\": {}}]}",
                       {"/cloth/1", "no other cloth has", "\"a\""});
}
TEST(BadInput, AMotionThatNoMannequinHasIsAnsweredWithTheNearest) {
  expect_scene_refused("{\"cloth\": [{\"grid\": {}}], \"body\": {\"mannequin\": \"man\", \"motion\": \"wlak\"}}",
                       {"/body/motion", "nearest is \"walk\"", "wlak"});
  expect_scene_refused("{\"cloth\": [{\"grid\": {}}], \"body\": {\"cylinder\": {}, \"motion\": \"walk\"}}",
                       {"/body/motion", "body that can move"});
}
TEST(BadInput, AMotionThatNeedsASkeletonIsRefusedForAMesh) {
  expect_scene_refused("{\"cloth\": [{\"grid\": {}}], \"body\": {\"mesh\": \"b.obj\", \"motion\": \"walk\"}}",
                       {"/body/motion", "stand, sway or twist", "no skeleton", "\"walk\""});
  expect_scene_refused(
      "{\"cloth\": [{\"grid\": {}}], \"body\": {\"mesh\": \"b.obj\", \"motion\": {\"name\": \"dance\"}}}",
      {"/body/motion/name", "stand, sway or twist", "\"dance\""});
  const Scratch scratch;
  scratch.put("p.json", "{}");
  scratch.put("b.obj", "v 0 0 0\n");
  for (const char* motion : {"walk", "swey"}) {
    const Ended ended = run_toile(scratch, {"dress", "p.json", "--body", "b.obj", "--motion", motion});
    EXPECT_EQ(ended.exit_code, 2) << ended.err;
    EXPECT_NE(ended.err.find("stand, sway or twist"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find(motion), std::string::npos) << ended.err;
  }
}

TEST(BadInput, AnOutputThatCannotBeWritten) {
  const Scratch scratch;
  scratch.put("s.json", "{\"cloth\": [{\"grid\": {\"edge_m\": 0.2}}], \"time\": {\"seconds\": 0.1}}");
  scratch.put("file", "not a directory");
  const Ended ended = run_toile(scratch, {"run", "s.json", "--out", "file/out"});
  EXPECT_EQ(ended.exit_code, 6) << ended.err;
  EXPECT_EQ(ended.err_lines(), 1) << ended.err;
  EXPECT_NE(ended.err.find("file"), std::string::npos);
}

TEST(Usage, EndsWithTwoAndOneLine) {
  const Scratch scratch;
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"fly"},
                                             {"run"},
                                             {"dress", "p.json"},
                                             {"demo", "tshrit"},
                                             {"demo", "--threads", "-3"},
                                             {"demo", "--seconds", "nan"},
                                             {"run", "s.json", "--nonsense"},
                                             {"dress", "p.json", "--body", "mannequin", "--body-unit", "inch"},
                                             {"dress", "p.json", "--body", "mannequin", "--motion", "walk.bvh"}}) {
    const Ended ended = run_toile(scratch, words);
    EXPECT_EQ(ended.exit_code, 2) << (words.empty() ? "" : words.front()) << ": " << ended.err;
    EXPECT_EQ(ended.err_lines(), 1) << ended.err;
    EXPECT_EQ(ended.out, "");
  }
}

TEST(Usage, AnErrorWithJsonIsOneObjectOnStdout) {
  const Scratch scratch;
  const Ended ended = run_toile(scratch, {"run", "none.json", "--json"});
  EXPECT_EQ(ended.exit_code, 6);
  EXPECT_NO_THROW({
    const Json json = Json::parse(ended.out, "stdout");
    EXPECT_EQ(json.at("exit_code").integer(), 6);
  }) << ended.out;
}

// ---- check and dress agree --------------------------------------------------------------------------------------------

// Both refuse it, in the same words.
void expect_both_refuse(const Scratch& scratch, const std::vector<std::string>& run,
                        const std::vector<std::string>& check, std::initializer_list<std::string_view> words) {
  const Ended ran = run_toile(scratch, run), checked = run_toile(scratch, check);
  expect_refused(scratch, ran, 3, words);
  EXPECT_EQ(checked.exit_code, 3) << checked.out;
  EXPECT_EQ(checked.err, ran.err);
}

void expect_pattern_refused_by_both(const std::string& text, const std::string& resolution_cm,
                                    std::initializer_list<std::string_view> words) {
  const Scratch scratch;
  scratch.put("p.json", text);
  put_body(scratch);
  expect_both_refuse(
      scratch, {"dress", "p.json", "--body", "body.obj", "--resolution", resolution_cm, "--out", "out", "--quiet"},
      {"check", "p.json", "--resolution", resolution_cm, "--quiet"}, words);
}

TEST(CheckAndDress, RefuseAFoldThatLeavesItsPanelByItsPlaceInTheFile) {
  std::string text = pattern(good_edges, good_stitches);
  text.pop_back();
  text += R"(,
    "toile": {"panels": {"front": {"folds": [
      {"endpoints": [0, 1], "curvature": {"type": "quadratic", "params": [[0.5, -0.3]]}, "angle_deg": 90}]}}}})";
  expect_pattern_refused_by_both(text, "2",
                                 {"p.json:7:7: /toile/panels/front/folds/0", "panel front, fold 0",
                                  "expected a line inside the panel, got one that leaves it"});
}

// Two sides of the tip of a tent: whatever the resolution, the triangle at the tip would fold shut.
TEST(CheckAndDress, RefuseSeamsThatWouldWeldCornersOfOneTriangle) {
  const std::string tent = R"({"pattern": {"panels": {"tent": {"translation": [0, 40, 30], "rotation": [0, 0, 0],
      "vertices": [[-6,0],[6,0],[0,8]], "edges": [{"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,0]}]}},
    "stitches": [[{"panel": "tent", "edge": 1}, {"panel": "tent", "edge": 2}]]}, "properties": {"units_in_meter": 100}})";
  expect_pattern_refused_by_both(tent, "20", {"p.json: panel \"tent\"", "three corners", "sewn together"});
}

void expect_scene_refused_by_both(const std::string& text, std::initializer_list<std::string_view> words) {
  const Scratch scratch;
  scratch.put("s.json", text);
  expect_both_refuse(scratch, {"run", "s.json", "--out", "out", "--quiet"}, {"check", "s.json", "--quiet"}, words);
}

TEST(CheckAndDress, RefuseShapesByTheirPlaceInTheFile) {
  expect_scene_refused_by_both(
      R"({"cloth": [
      {"ribbon": {"width_m": 0.05, "edge_m": 0.01, "path_m": [[0, 0, 0], [1e-300, 0, 0], [0.3, 0, 0]]}}], "time": {"seconds": 0.1}})",
      {"s.json:2", "/cloth/0/ribbon/path_m/1", "another place than the point before, by at least 2e-06 m", "got 0 m"});
  std::string path;
  for (int k = 0; k < 45; ++k) path += (k == 0 ? "[" : ", [") + std::to_string(k) + ", 0, 0]";
  expect_scene_refused_by_both(R"({"cloth": [{"grid": {}},
      {"ribbon": {"width_m": 0.05, "edge_m": 0.02, "path_m": [)" +
                                   path + R"(]}}], "time": {"seconds": 0.1}})",
                               {"s.json:2", "/cloth/1/ribbon/path_m", "at most 32 m along it", "got 44 m"});
}

TEST(CheckAndDress, RefuseALabelThatNoEdgeCarries) {
  const Scratch scratch;
  scratch.put("p.json", pattern(good_edges, good_stitches));
  scratch.put("s.json", R"({"cloth": [{"pattern": "p.json", "resolution_cm": 5,
      "label_heights_m": {"waist": 1}}], "body": {"cylinder": {"radius_m": 0.1, "height_m": 1, "top_m": [0, 1, 0]}}})");
  expect_both_refuse(scratch, {"run", "s.json", "--out", "out", "--quiet"}, {"check", "s.json", "--quiet"},
                     {"s.json:1", "/cloth/0/label_heights_m", "got \"waist\""});
}

TEST(CheckAndDress, RefuseAStartFromARunOfAnotherPattern) {
  const Scratch scratch;
  scratch.put("p.json", pattern(good_edges, good_stitches));
  scratch.put("s.json", R"({"cloth": [{"pattern": "p.json", "resolution_cm": 5}], "start": "none"})");
  const Ended ran = run_toile(scratch, {"run", "s.json", "--out", "out", "--quiet"}),
              checked = run_toile(scratch, {"check", "s.json", "--quiet"});
  EXPECT_EQ(ran.exit_code, 6);
  EXPECT_EQ(checked.exit_code, 6);
  EXPECT_EQ(checked.err, ran.err);
}

// A closed cylinder in two groups, cut at half its height, and other things beside it.
std::string grouped_body(std::string_view lower, std::string_view upper, std::string_view more = "") {
  const SolidMesh solid = rounded_cylinder(0.2, 1.0, Vec3(0, 1.0, 0));
  std::string text, faces[2];
  const auto add = [&](const Vec3& p) {
    text += "v " + std::to_string(p.x()) + ' ' + std::to_string(p.y()) + ' ' + std::to_string(p.z()) + '\n';
  };
  for (const Vec3& p : solid.positions) add(p);
  for (const Triangle& t : solid.triangles) {
    double middle = 0;
    for (const Index i : t) middle += solid.positions[static_cast<std::size_t>(i)].y() / 3;
    faces[middle < 0.5 ? 0 : 1] +=
        "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' ' + std::to_string(t[2] + 1) + '\n';
  }
  return text + std::string(lower) + '\n' + faces[0] + std::string(upper) + '\n' + faces[1] + std::string(more);
}
const char* const box_beside = R"(v 1 0 0
v 1.5 0 0
v 1 0.5 0
v 1 0 0.5
o legs
f -4 -2 -3
f -4 -1 -2
f -4 -3 -1
f -3 -2 -1
)";

Json checked_mesh(const std::string& text, std::string& said) {
  const Scratch scratch;
  scratch.put("body.obj", text);
  const Ended ended = run_toile(scratch, {"check", "body.obj", "--json"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  said = run_toile(scratch, {"check", "body.obj"}).out;
  return Json::parse(ended.out, "stdout").at("files").array().front();
}

TEST(CheckAndDress, TakeTheSameBodyOutOfAFile) {
  std::string said;
  const std::string whole = grouped_body("g trunk", "g head");
  const std::int64_t triangles = checked_mesh(whole, said).at("body").at("triangles").integer();
  EXPECT_GT(triangles, 100);

  const Json parts = checked_mesh(grouped_body("g Body", "g Head"), said);
  EXPECT_EQ(parts.at("body").at("triangles").integer(), triangles) << "what is called body is open without its head";
  EXPECT_NE(
      said.find("body.obj: what the file calls body is open: taken with what it hangs together with (Body, Head)"),
      std::string::npos)
      << said;

  const Json beside = checked_mesh(grouped_body("o body", "g x", box_beside), said);
  EXPECT_EQ(beside.at("body").at("triangles").integer(), triangles);
  EXPECT_NE(said.find("legs (4 vertices, "), std::string::npos) << said;
  EXPECT_NE(said.find("left out"), std::string::npos) << said;

  // Vertices that no face uses, before and behind those of the body.
  const Json unused = checked_mesh(whole + "v 7 7 7\nv 8 8 8\n", said);
  EXPECT_EQ(unused.at("unused_vertices").integer(), 2);
  EXPECT_EQ(unused.at("body").at("triangles").integer(), triangles);
  EXPECT_NE(said.find("2 vertices are in no triangle"), std::string::npos) << said;
}

TEST(CheckAndDress, SayWhyAMeshIsNoBodyInTheSameWords) {
  const Scratch scratch;
  scratch.put("p.json", pattern(good_edges, good_stitches));
  std::string open = grouped_body("g a", "g a");
  for (int triangle = 0; triangle < 6; ++triangle) open.erase(open.rfind("f "));
  scratch.put("open.obj", open + "v 9 9 9\n");
  put_body(scratch, 100, "cm.obj");
  for (const char* body : {"open.obj", "cm.obj"}) {
    const Ended dressed = run_toile(scratch, {"dress", "p.json", "--body", body, "--out", "out", "--quiet"});
    expect_refused(scratch, dressed, 3, {body});
    const Ended checked = run_toile(scratch, {"check", body});
    EXPECT_EQ(checked.exit_code, 0) << "it may be a cloth";
    EXPECT_NE(checked.out.find("not a body: " + dressed.err.substr(std::string("toile: ").size())), std::string::npos)
        << checked.out << dressed.err;
  }
  const Ended in_cm = run_toile(scratch, {"check", "cm.obj", "--body-unit", "cm"});
  EXPECT_NE(in_cm.out.find("1.000 m high"), std::string::npos) << in_cm.out;
}

}  // namespace
}  // namespace toile::internal
