// A run from scene to files and back, without the program.
#include "body/solid_shapes.hpp"
#include "core/parallel.hpp"
#include "io/json.hpp"
#include "io/json_text.hpp"
#include "io/json_value.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "mesh/check.hpp"
#include "sim/body_figures.hpp"
#include "sim/run_writer.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"
#include "support/paths.hpp"
#include "support/sheets.hpp"
#include "support/tube_pattern.hpp"
#include "verify/crossings.hpp"
#include "verify/verify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace toile::internal {
namespace {

Report run(const Scratch& scratch, const Scene& scene, const std::function<bool()>& stop = {}) {
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  options.stop = stop;
  return simulate(scene, options);
}

Scene falling_cloth(const std::string& more = "") {
  return parse_scene(R"({"cloth": [{"name": "cloth", "grid": {"width_m": 0.4, "height_m": 0.3, "edge_m": 0.04},
    "placement": {"translation_m": [0, 0.01, 0], "rotation_deg": [-90, 0, 0]})" +
                         more + R"(}],
    "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.5}}, "time": {"seconds": 0.3}})",
                     "s.json");
}

// The program takes no more threads than there are cores; the library takes as many as it is told.
TEST(Run, GivesTheSameBitsForMoreThreadsThanCores) {
  const Scratch scratch;
  std::string hash;
  for (const int threads : {1, 5, 7}) {
    Report report;
    with_threads(threads, [&] { report = run(scratch, falling_cloth()); });
    EXPECT_EQ(report.threads, threads);
    if (hash.empty()) hash = report.state_hash;
    EXPECT_EQ(report.state_hash, hash) << threads << " threads";
  }
}

TEST(JsonText, IsReadBackToTheBit) {
  JsonText text;
  text.begin_object();
  text.member("name", "a \"b\"\\\n\x01 \xc3\xa4");
  text.member("third", 1.0 / 3);
  text.member("nan", std::nan(""));
  text.key("list");
  text.begin_array();
  text.end_array();
  text.key("nested");
  text.begin_array();
  text.value(1);
  text.value(true);
  text.begin_object();
  text.end_object();
  text.end_array();
  text.end_object();
  const Json json = Json::parse(text.str(), "text");
  EXPECT_EQ(json.at("name").string(), "a \"b\"\\\n\x01 \xc3\xa4");
  EXPECT_EQ(json.at("third").number(), 1.0 / 3);
  EXPECT_TRUE(json.at("nan").is_null());
  EXPECT_EQ(json.at("nested").array().size(), 3u);
}

TEST(JsonText, IsJsonWhateverTheBytes) {
  JsonText text;
  text.begin_object();
  text.member("caf\xe9 \xc3\xa9", "\xff\xf0\x9f\x91\x95\xc3");
  text.end_object();
  EXPECT_EQ(Json::parse(text.str(), "text").at("caf\xef\xbf\xbd \xc3\xa9").string(),
            "\xef\xbf\xbd\xf0\x9f\x91\x95\xef\xbf\xbd");
}

TEST(Run, LeavesFilesThatTheJudgeReadsAsTheReportSays) {
  const Scratch scratch;
  const Report report = run(scratch, falling_cloth());
  EXPECT_TRUE(report.verdict.pass) << (report.verdict.reasons.empty() ? "" : report.verdict.reasons.front().detail);
  EXPECT_EQ(outcome(report), Outcome::passed);
  EXPECT_EQ(report.frames, 9);
  const VerifyReport audit = verify_directory(scratch / "out");
  EXPECT_EQ(audit.frames, 9);
  EXPECT_TRUE(judge(audit).pass);
  EXPECT_NEAR(audit.stretch.max, report.audit.stretch.max, 1e-4);
  EXPECT_EQ(audit.gap.nearest_vertex, report.audit.gap.nearest_vertex);
  EXPECT_NEAR(audit.still_mm_per_s_p99, report.audit.still_mm_per_s_p99, 1e-6) << "the audit saw what was written";
  const SurfaceMesh cloth = load_obj(scratch / "out/cloth.obj");
  EXPECT_EQ(cloth.object_names, std::vector<std::string>{"cloth"});
  EXPECT_EQ(cloth.group_names, std::vector<std::string>{"cloth"});
  Vec2 low(1, 1), high(-1, -1);
  for (const Vec2& vt : cloth.texcoords) {
    low = low.cwiseMin(vt);
    high = high.cwiseMax(vt);
  }
  EXPECT_NEAR(high.x() - low.x(), 0.4, 1e-6) << "vt are drawing coordinates: x to the right, y up";
  EXPECT_NEAR(high.y() - low.y(), 0.3, 1e-6);
}

TEST(Run, AnElasticPanelIsJudgedAgainstItsOwnRestLength) {
  const Scratch scratch;
  // The warp (drawn upwards, 0.3 m) wants to be 0.8 of its length.
  Scene scene = falling_cloth(R"(, "panels": {"cloth": {"rest_stretch_u": 0.8}})");
  scene.body.shape = {};
  scene.gravity_m_per_s2.setZero();
  scene.seconds = 2;
  const Report report = run(scratch, scene);
  EXPECT_LT(report.audit.stretch.max, 0.01) << "it has shrunk, and the audit knows which axis of vt is the warp";
  EXPECT_GT(report.audit.stretch.p50, -0.01);
  const VerifyReport audit = verify_directory(scratch / "out");
  EXPECT_NEAR(audit.stretch.p50, report.audit.stretch.p50, 1e-4) << "rest_stretch in report.json has the axes of vt";
  Pc2Reader frames(scratch / "out/cloth.pc2");
  std::vector<Vec3> x;
  frames.read(frames.samples() - 1, x);
  double low = 1, high = -1;
  for (const Vec3& p : x) {
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  EXPECT_NEAR(high - low, 0.24, 0.005);
}

TEST(Run, APinFollowsItsPathAndAnotherStays) {
  const Scratch scratch;
  Scene scene = falling_cloth(
      R"(, "pins": [{"near_m": [-0.2, 0.01, -0.15]}, {"near_m": [0.2, 0.01, -0.15], "hold": "path", "path_m": [[0, 0.2, 0.01, -0.15], [0.2, 0.15, 0.06, -0.15]]}])");
  scene.body.shape = {};
  run(scratch, scene);
  Pc2Reader frames(scratch / "out/cloth.pc2");
  std::vector<Vec3> first, last;
  frames.read(0, first);
  frames.read(frames.samples() - 1, last);
  const std::vector<TimedPin> pins = load_cloth(scene, 0, read_text_file).pins;
  ASSERT_EQ(pins.size(), 2u);
  const auto fixed = static_cast<std::size_t>(pins[0].pin.particle),
             moved = static_cast<std::size_t>(pins[1].pin.particle);
  EXPECT_LT((last[fixed] - first[fixed]).norm(), 1e-6);
  EXPECT_LT((last[moved] - Vec3(0.15, 0.06, -0.15)).norm(), 1e-3);
}

TEST(Run, AStopEndsItWithAReportThatDoesNotPass) {
  const Scratch scratch;
  int asked = 0;
  const Report report = run(scratch, falling_cloth(), [&] { return ++asked > 5; });
  EXPECT_EQ(asked, 6) << "asked before every step, and not again once it said yes";
  EXPECT_EQ(outcome(report), Outcome::interrupted);
  EXPECT_GT(report.frames, 1);
  EXPECT_LE(report.frames, 6) << "a frame that was not finished is not written";
  EXPECT_FALSE(report.verdict.pass);
  EXPECT_EQ(verify_directory(scratch / "out").frames, report.frames);
  EXPECT_FALSE(judge(verify_directory(scratch / "out")).pass);
}

TEST(Run, AStartInsideTheBodyIsWarnedOfOrRefused) {
  const Scratch scratch;
  Scene scene = falling_cloth();
  scene.cloth.front().translation_m = Vec3(0, -0.1, 0);
  scene.seconds = 0.1;
  EXPECT_FALSE(run(scratch, scene).warnings.empty());
  scene.strict_start = true;
  try {
    run(scratch, scene);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_start);
  }
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/report.json"))
      << "neither the run nor the one before it looks finished";
}

// Two sheets through each other at a right angle, and one of them through the body.
Scene tangled() {
  return parse_scene(R"({"cloth": [
    {"name": "lying", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.03},
     "placement": {"translation_m": [0, 0.05, 0], "rotation_deg": [-90, 0, 0]}},
    {"name": "standing", "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.03}, "fabric": "silk",
     "placement": {"translation_m": [0.02, 0.06, 0], "rotation_deg": [0, 20, 0]}}],
    "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.5}}, "time": {"seconds": 0.5}})",
                     "s.json");
}

TEST(Run, ATangledStartIsTakenApartBeforeTheFirstFrame) {
  const Scratch scratch;
  const Report report = run(scratch, tangled());
  EXPECT_GT(report.start.cloth_cloth, 3);
  EXPECT_GT(report.start.cloth_body, 3);
  EXPECT_EQ(report.start.cloth_cloth_left, 0);
  EXPECT_EQ(report.start.cloth_body_left, 0);
  EXPECT_GT(report.start.trials, 0);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("none is left"), std::string::npos) << report.warnings[0];
  EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0) << "in any written frame";
  EXPECT_EQ(report.audit.cloth_body_edges.max, 0);
}

TEST(Run, ACleanStartIsNotTouched) {
  const Scratch scratch;
  const Report report = run(scratch, falling_cloth());
  EXPECT_EQ(report.start.trials, 0);
  EXPECT_EQ(report.start.largest_move_mm, 0);
  EXPECT_TRUE(report.warnings.empty());
}

TEST(Run, APanelThatTheClothDoesNotHaveIsNamed) {
  const Scratch scratch;
  try {
    run(scratch, falling_cloth(R"(, "panels": {"colth": {"fabric": "silk"}})"));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("nearest is \"cloth\""), std::string::npos) << error.what();
  }
}

// Two rectangles sewn at both sides around a cylinder, or around one that is too thick for them.
Scene tube(const Scratch& scratch, double body_radius_m) {
  scratch.put("tube.json", test::tube_pattern_text());
  Scene scene = parse_scene(
      R"({"cloth": [{"pattern": "tube.json", "resolution_cm": 4}], "body": {"cylinder": {"height_m": 1, "top_m": [0, 0.6, 0]}}, "time": {"seconds": 0.8}})",
      scratch / "s.json");
  std::get<SceneCylinder>(scene.body.shape).radius_m = body_radius_m;
  scene.until_still = false;
  return scene;
}

TEST(Run, SewsATubeAndKeepsVtPerPanelAtTheSeams) {
  const Scratch scratch;
  const Report report = run(scratch, tube(scratch, 0.1));
  EXPECT_EQ(report.seams, 2);
  EXPECT_GT(report.sewing.steps, 0);
  ASSERT_GT(report.frames, 2);
  const SurfaceMesh panels = load_obj(scratch / "out/sewing.obj"), cloth = load_obj(scratch / "out/cloth.obj");
  EXPECT_GT(panels.positions.size(), cloth.positions.size()) << "seams are welded in cloth.obj only";
  EXPECT_EQ(panels.triangles.size(), cloth.triangles.size());
  EXPECT_EQ(cloth.group_names, (std::vector<std::string>{"front", "back"}));
  EXPECT_EQ(cloth.texcoords.size(), panels.positions.size()) << "one vt per panel corner";
  Pc2Reader film(scratch / "out/sewing.pc2");
  EXPECT_NEAR(film.samples(), 1 + report.sewing.simulated_s * 30, 1.01);
  EXPECT_LT(std::abs(report.audit.stretch.p50), 0.02);
}

// A ring that falls along a post to the floor.
struct Fall {
  Report report;
  double way_m = 0;  // from the first written frame to the last, downwards
};
Fall ring_around_a_post(const Scratch& scratch, const std::string& more) {
  scratch.put("ring.json", test::tube_pattern_text(24, 6, 9, 8));
  const std::string scene = R"({"cloth": [{"pattern": "ring.json", "resolution_cm": 1)" + more +
                            R"(}], "body": {"cylinder": {"radius_m": 0.055, "height_m": 0.3, "top_m": [0, 0.3, 0]}},
      "solids": [{"box": {"size_m": [0.4, 0.1, 0.4]}, "placement": {"translation_m": [0, -0.05, 0]}}],
      "time": {"seconds": 6, "until_still": true}})";
  Fall fall{run(scratch, parse_scene(scene, scratch / "s.json"))};
  Pc2Reader film(scratch / "out/cloth.pc2");
  const auto height = [&](int frame) {
    std::vector<Vec3> x;
    film.read(frame, x);
    double sum = 0;
    for (const Vec3& p : x) sum += p.y();
    return sum / static_cast<double>(x.size());
  };
  fall.way_m = height(0) - height(film.samples() - 1);
  return fall;
}

// Where only the end is asked for, what falls is the coarse cloth; where something holds it until 0.1 s, the fine cloth does.
TEST(Run, AGarmentFallsBeforeItIsCutFiner) {
  const Scratch scratch;
  const Fall coarse = ring_around_a_post(scratch, ""),
             fine = ring_around_a_post(scratch, R"(, "pins": [{"near_m": [0, 0.14, 0.06], "to_s": 0.1}])");
  EXPECT_EQ(coarse.report.ended, "still");
  EXPECT_EQ(fine.report.ended, "still");
  EXPECT_EQ(coarse.report.vertices, fine.report.vertices) << "cut to the same edges";
  EXPECT_GT(fine.way_m, 0.02);
  EXPECT_LT(std::abs(coarse.way_m), 0.005);
  EXPECT_LT(coarse.report.frames, fine.report.frames);
  EXPECT_EQ(coarse.report.audit.cloth_body_edges.max, 0);
  EXPECT_EQ(coarse.report.audit.cloth_cloth_edges.max, 0);
}

// A ring tips off a ball before any of its frames is written.
TEST(Run, WhatTouchedTheBodyInAnUnwrittenFallFellOff) {
  const Scratch scratch;
  scratch.put("ring.json", test::tube_pattern_text(20, 6, 7, 6));
  const Report report = run(scratch, parse_scene(R"({"cloth": [{"pattern": "ring.json", "resolution_cm": 1}],
      "body": {"sphere": {"radius_m": 0.1}}, "time": {"seconds": 6, "until_still": true}})",
                                                 scratch / "s.json"));
  EXPECT_EQ(report.ended, reason::fell_off);
}

// Every seam of the T-shirt ends in a corner of four panels, at the underarm or at the shoulder.
TEST(Run, TheTShirtIsSewnWithoutACrossingWhereFourPanelsMeet) {
  for (const char* resolution_cm : {"3", "2.4"}) {
    const Scratch scratch;
    const Scene scene =
        parse_scene(R"({"cloth": [{"name": "tshirt", "pattern": ")" + test::source_path("patterns/tshirt.json") +
                        R"(", "resolution_cm": )" + std::string(resolution_cm) +
                        R"(}], "body": {"mannequin": "woman"}, "time": {"seconds": 0.6}})",
                    "s.json");
    const Report report = run(scratch, scene);
    ASSERT_EQ(report.ended, "time") << resolution_cm;
    EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0) << resolution_cm << " cm, in any frame since the weld";
    EXPECT_EQ(report.audit.cloth_body_edges.last, 0) << resolution_cm;
  }
}

// A label for the waist on what hangs from the shoulders holds nothing; here on both hems of the T-shirt, 20 cm below her waist.
TEST(Run, WhatHangsFromTheShouldersIsNotHeldAtTheWaist) {
  std::array<std::string, 2> state;
  for (const bool labelled : {false, true}) {
    const Scratch scratch;
    JsonValue root(Json::load(test::source_path("patterns/tshirt.json")));
    for (const auto& [panel, hem] : {std::pair("front", 0), std::pair("back", 7)})
      if (labelled)
        (*root.member("pattern").member("panels").member(panel).member("edges").array())[at(hem)].member("label") =
            JsonValue(std::string("lower_interface"));
    std::ofstream(scratch / "tshirt.json") << to_text(root);
    const Report report = run(scratch, parse_scene(R"({"cloth": [{"pattern": ")" + (scratch / "tshirt.json") +
                                                       R"(", "resolution_cm": 5, "tape_mm": 0}],
                                                       "body": {"mannequin": "woman"}, "time": {"seconds": 0.1}})",
                                                   "s.json"));
    ASSERT_EQ(report.ended, "time");
    state[labelled ? 1 : 0] = report.state_hash;
  }
  EXPECT_EQ(state[0], state[1]);
}

// The skirt is drawn 24 cm too low, is placed 16 cm higher, as far as garments are shifted, and is at the waist long before its seams are closed.
TEST(Run, WhatHangsFromTheWaistIsHeldThereWhileItIsSewn) {
  const Scratch scratch;
  const Report report =
      run(scratch, parse_scene(R"({"cloth": [{"pattern": ")" + test::source_path("patterns/skirt.json") +
                                   R"(", "resolution_cm": 5, "placement": {"translation_m": [0, -0.24, 0]}}],
                                   "body": {"mannequin": "woman"}, "time": {"seconds": 0.1}})",
                               "s.json"));
  ASSERT_EQ(report.ended, "time");
  EXPECT_NEAR(report.shift_m.y(), 0.16, 1e-9);
  Pc2Reader film(scratch / "out/sewing.pc2");
  const auto top_m = [&](int frame) {
    Vec3s x;
    film.read(frame, x);
    return std::max_element(x.begin(), x.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); })->y();
  };
  EXPECT_GT(top_m(film.samples() / 2), top_m(0) + 0.04);
}

// At this edge length the seams that meet in the crotch close around a fold, of hinges; plates do not make it.
TEST(Run, TrousersWhoseSeamsHaveCaughtAFoldAreSewnAndTakenApart) {
  const Scratch scratch;
  const Report report =
      run(scratch, parse_scene(R"({"cloth": [{"pattern": ")" + test::source_path("patterns/man_pants.json") +
                                   R"(", "resolution_cm": 3.5,
                                                       "fabric": {"base": "cotton", "shear_N_per_m": 200, "bend_u_N_m": 1e-5, "bend_v_N_m": 1e-5}}],
                                                     "body": {"mannequin": "man"}, "time": {"seconds": 0.3},
                                                     "solver": {"bend_element": "hinge"}})",
                               "s.json"));
  ASSERT_EQ(report.ended, "time");
  EXPECT_GT(report.start.cloth_cloth, 0);
  EXPECT_EQ(report.start.cloth_cloth_left, 0);
  EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0);
}

TEST(Setup, LongerEdgesRestFartherFromTheBodyUnlessTheSceneSays) {
  Scene scene = parse_scene(
      R"({"cloth": [{"grid": {"edge_m": 0.01}}], "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.5}}})", "s.json");
  double edge_m = 0.01;
  EXPECT_DOUBLE_EQ(step_options(scene, edge_m).body.offset_m, 2e-3);
  edge_m = 0.03;
  EXPECT_DOUBLE_EQ(step_options(scene, edge_m).body.offset_m, 2.5e-3);
  edge_m = 0.002;
  EXPECT_DOUBLE_EQ(step_options(scene, edge_m).body.offset_m, 1.5e-3);
  scene.body.contact.offset_m = 4e-3;
  EXPECT_DOUBLE_EQ(step_options(scene, edge_m).body.offset_m, 4e-3);
}

TEST(Setup, LabelHeightsComeFromTheSceneAndTheWaistFromTheBody) {
  GarmentMesh garment;
  garment.labels = {
      {"lower_interface", {0}}, {"right_collar", {1}}, {"pocket", {2}}, {"pocket", {3}}, {"strapless_top", {4}}};
  const SolidMesh solid = rounded_cylinder(0.2, 1.8, Vec3(0, 1.8, 0));
  SceneCloth cloth;
  std::vector<std::string> warnings;
  const BodyFigures figures = body_figures(solid.positions, solid.triangles);
  auto heights = label_heights_of(cloth, garment, false, figures, warnings);
  ASSERT_EQ(heights.size(), 1U);
  EXPECT_GT(heights[0].height_m, 0.9);
  EXPECT_LT(heights[0].height_m, 1.3);
  ASSERT_EQ(warnings.size(), 1U) << "collars and tops are known, and held only where the scene says";
  EXPECT_NE(warnings[0].find("pocket"), std::string::npos);
  warnings.clear();
  cloth.label_heights = {{"lower_interface", 1.1}, {"right_collar", 1.5}, {"pocket", 1}};
  heights = label_heights_of(cloth, garment, false, figures, warnings);
  EXPECT_EQ(heights.size(), 3U);
  EXPECT_TRUE(warnings.empty());
  cloth.label_heights = {{"waist", 1.1}};
  EXPECT_THROW(label_heights_of(cloth, garment, false, figures, warnings), InputError);
}

TEST(Setup, TheWaistOfWhatHangsFromTheShouldersIsHeldOnlyWhereTheSceneSays) {
  GarmentMesh garment;
  garment.labels = {{"lower_interface", {0}}};
  const SolidMesh solid = rounded_cylinder(0.2, 1.8, Vec3(0, 1.8, 0));
  SceneCloth cloth;
  std::vector<std::string> warnings;
  const BodyFigures figures = body_figures(solid.positions, solid.triangles);
  EXPECT_TRUE(label_heights_of(cloth, garment, true, figures, warnings).empty());
  EXPECT_TRUE(warnings.empty());
  cloth.label_heights = {{"lower_interface", 1.1}};
  const auto heights = label_heights_of(cloth, garment, true, figures, warnings);
  ASSERT_EQ(heights.size(), 1U);
  EXPECT_EQ(heights[0].height_m, 1.1);
}

TEST(Run, ASeamThatCannotCloseIsReportedByNameAndLeavesAMesh) {
  const Scratch scratch;
  Scene scene = tube(scratch, 0.2);  // a quarter more round than the tube, which is of a cloth that does not give
  scene.cloth.front().fabric = fabric_preset("denim", "", "");
  const Report report = run(scratch, scene);
  EXPECT_EQ(outcome(report), Outcome::failed);
  EXPECT_EQ(report.ended, "seam_blocked");
  ASSERT_FALSE(report.verdict.reasons.empty());
  EXPECT_EQ(report.verdict.reasons.front().code, "seam_blocked");
  EXPECT_NE(report.verdict.reasons.front().detail.find("seam front."), std::string::npos)
      << report.verdict.reasons.front().detail;
  EXPECT_NE(report.verdict.reasons.front().detail.find("too small"), std::string::npos)
      << report.verdict.reasons.front().detail;
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/sewing.pc2"));
  ASSERT_FALSE(report.open_seams.empty());
  EXPECT_GT(report.open_seams.front().gap_m, 0.01);
  const SurfaceMesh cloth = load_obj(scratch / "out/cloth.obj");
  for (const OpenSeam& seam : report.open_seams)
    for (const auto& [a, b] : seam.vertices) {
      EXPECT_NE(a, b);
      EXPECT_LT(static_cast<std::size_t>(std::max(a, b)), cloth.positions.size());
    }
  const Json json = Json::load(scratch / "out/report.json");
  EXPECT_EQ(json.at("verdict").string(), "fail");
  EXPECT_EQ(json.at("open_seams").array().size(), report.open_seams.size());
  EXPECT_EQ(json.at("frames").integer(), 1);
  EXPECT_EQ(report.verdict.reasons.size(), 1U + (report.verdict.reasons.back().code == "stretch" ? 1 : 0))
      << "of one frame rest is not asked";
}

// Dressing ends when its time is over, and what there is is written.
TEST(Run, DressingEndsAtItsTimeLimitWithWhatThereIs) {
  const Scratch scratch;
  RunOptions options;
  options.directory = scratch / "out";
  options.time_limit_s = 1e-9;
  const Report report = simulate(tube(scratch, 0.1), options);
  EXPECT_EQ(outcome(report), Outcome::failed);
  EXPECT_EQ(report.ended, "time_limit");
  EXPECT_EQ(report.frames, 1);
  EXPECT_FALSE(report.open_seams.empty());
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/cloth.obj"));
  EXPECT_EQ(verify_directory(scratch / "out").frames, 1);
}

}  // namespace
}  // namespace toile::internal
