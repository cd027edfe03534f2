// Runs as folders, and the same scene by every way.
#include "toile/run.hpp"

#include "arrays.hpp"
#include "io/scratch.hpp"
#include "sim/simulate.hpp"
#include "support/message_of.hpp"
#include "support/paths.hpp"
#include "support/tube_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace toile {
namespace {

using Scratch = internal::Scratch;
using test::message_of;

std::string scene_text() {
  return R"({"name": "drop", "cloth": [{"grid": {"width_m": 0.4, "height_m": 0.4, "edge_m": 0.04},
    "placement": {"translation_m": [0, 0.1, 0], "rotation_deg": [-90, 0, 0]}}],
    "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.3, "top_m": [0, 0, 0]}}, "time": {"fps": 30, "seconds": 1}})";
}

TEST(ExportRun, WritesFramesOfARunForOtherPrograms) {
  const Scratch scratch;
  const test::Arrays cloth = test::level_sheet(10, 0.03, 0.16);
  Simulation sim(Cloth::from_arrays({.vertices_m = cloth.vertices_m, .faces = cloth.faces}), Body::none());
  const std::string folder = scratch / "run";
  RunWriter writer(folder, sim, 30);
  sim.advance(1.0 / 30);
  writer.add(sim);
  writer.finish();
  for (const char* file : {"last.obj", "last.ply", "last.glb"}) {
    EXPECT_EQ(export_run(folder, scratch / file), std::vector<std::string>{scratch / file});
    EXPECT_GT(scratch.get(file).size(), 1000U) << file;
  }
  EXPECT_EQ(export_run(folder, scratch / "all", {.to = "ply", .all = true}).size(), 2U);
  EXPECT_THROW(export_run(folder, scratch / "a.ply", {.frame = 2}), InputError);
  EXPECT_THROW(export_run(folder, scratch / "a.ply", {.frame = -2}), InputError);
  EXPECT_THROW(export_run(folder, scratch / "a.usd"), Error);
}

TEST(RunWriter, WritesWhatTheJudgeReads) {
  const Scratch scratch;
  const test::Arrays cloth = test::level_sheet(10, 0.03, 0.16), block = test::box({0, 0, 0}, 0.15);
  Simulation sim(Cloth::from_arrays({.vertices_m = cloth.vertices_m, .faces = cloth.faces}),
                 Body::from_arrays(block.vertices_m, block.faces));
  const std::string folder = scratch / "run";
  RunWriter writer(folder, sim, 30);
  for (int k = 0; k < 20; ++k) {
    ASSERT_TRUE(sim.advance(1.0 / 30).ok());
    writer.add(sim);
  }
  EXPECT_FALSE(verify(folder).pass) << "it is not finished";
  const Verdict written = writer.finish();
  EXPECT_TRUE(written.pass) << written.explain();
  EXPECT_EQ(written.frames, 21);
  const Verdict read = verify(folder);
  EXPECT_TRUE(read.pass) << read.explain();
  EXPECT_EQ(read.frames, 21);
  EXPECT_NEAR(read.stretch_max, written.stretch_max, 1e-6) << "the drawing is rounded in the file";
  EXPECT_THROW(writer.add(sim), Error);
  EXPECT_EQ(writer.frames(), 21);
  std::ifstream report(folder + "/report.json");
  const std::string text((std::istreambuf_iterator<char>(report)), {});
  EXPECT_NE(text.find('"' + sim.state_hash() + '"'), std::string::npos);
  const RunWriter over_it(folder, sim);  // the folder is free again, while the first writer lives
  EXPECT_EQ(over_it.frames(), 1);
}

TEST(RunWriter, RefusesAnotherCloth) {
  const Scratch scratch;
  const test::Arrays coarse = test::level_sheet(4, 0.05, 0), fine = test::level_sheet(5, 0.05, 0);
  const Simulation one(Cloth::from_arrays({.vertices_m = coarse.vertices_m, .faces = coarse.faces}));
  const Simulation other(Cloth::from_arrays({.vertices_m = fine.vertices_m, .faces = fine.faces}));
  RunWriter writer(scratch / "run", one);
  EXPECT_THROW(writer.add(other), InputError);
  std::ofstream(scratch / "mine/cloth.obj");
  std::filesystem::create_directories(scratch / "mine");
  std::ofstream(scratch / "mine/cloth.obj") << "not Toile's\n";
  EXPECT_THROW(RunWriter(scratch / "mine", one), IoError);
}

// The engine as the program calls it, a scene in memory, and the same frame by frame.
TEST(Scene, EndsWithTheSameBitsByProgramLibraryAndLoop) {
  const Scratch scratch;
  const std::string path = scratch / "drop.json";
  std::ofstream(path) << scene_text();
  internal::RunOptions options;
  options.directory = scratch / "program";
  const std::string hash = internal::simulate(internal::parse_scene(scene_text(), path), options).state_hash;

  Simulation whole = Simulation::from_scene(path);
  EXPECT_TRUE(whole.run().ok());
  EXPECT_EQ(whole.state_hash(), hash);

  Simulation loop = Simulation::from_scene(path);
  for (int k = 1; k < 30; ++k) ASSERT_TRUE(loop.advance(1 / 30.0).ok());
  EXPECT_EQ(loop.state_hash(), hash);

  const Verdict verdict = run_scene(path, scratch / "library");
  EXPECT_TRUE(verdict.pass) << verdict.explain();
  std::ifstream report(scratch / "library/report.json");
  const std::string text((std::istreambuf_iterator<char>(report)), {});
  EXPECT_NE(text.find('"' + hash + '"'), std::string::npos);
}

// A sleeve on an elbow that is bent until the arm is in itself.
TEST(Scene, ClothThatTheBodyPinchesIsAWarning) {
  const Scratch scratch;
  std::ifstream file(internal::test::source_path("scenes/torture/18-elbow.json"));
  std::string text((std::istreambuf_iterator<char>(file)), {});
  for (const auto& [from, to] :
       {std::pair{R"("length_m": 0.44, "edge_m": 0.012)", R"("length_m": 0.44, "edge_m": 0.018)"},
        std::pair{R"("seconds": 3)", R"("seconds": 0.7)"},
        std::pair{R"("time": {)", R"("solver": {"bend_element": "hinge"}, "time": {)"}}) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), std::string_view(from).size(), to);
  }
  const DressReport report = Simulation::from_scene(scratch.put("elbow.json", text)).run();
  for (const Reason& reason : report.reasons) EXPECT_NE(reason.code, "cloth_body_intersection");
  EXPECT_TRUE(std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& warning) {
    return warning.starts_with("pinched_cloth: ");
  })) << report.explain();
}

// A plate goes up under a sheet: run() leaves it on the way of a motion, and a state of then goes on here and elsewhere.
TEST(Scene, AStateOfThingsThatMoveGoesOn) {
  const Scratch scratch;
  const std::string path =
      scratch.put("lift.json", R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.04},
    "placement": {"translation_m": [0, 0.06, 0], "rotation_deg": [-90, 0, 0]}}],
    "solids": [{"box": {"size_m": [0.3, 0.1, 0.3]}, "moves": [{"t_s": 0}, {"t_s": 2, "shift_m": [0, 0.4, 0]}]}],
    "time": {"seconds": 0.5}})");
  Simulation sim = Simulation::from_scene(path);
  sim.run();
  const State then = sim.state();
  const double height = sim.body_positions_m()[0][1];
  const auto end_of = [](Simulation& one) {
    for (int k = 0; k < 5; ++k) EXPECT_TRUE(one.advance(1.0 / 30).ok());
    return one.state_hash();
  };
  const std::string end = end_of(sim);
  EXPECT_NEAR(sim.body_positions_m()[0][1], height + 0.2 * 5 / 30, 1e-9);
  EXPECT_GT(sim.positions_m()[0][1], sim.body_positions_m()[0][1]) << "it is carried";
  sim.set_state(then);
  EXPECT_EQ(end_of(sim), end);
  Simulation other = Simulation::from_scene(path);
  other.set_state(then);
  EXPECT_EQ(end_of(other), end);
}

// What can only be told once the garment is on.
TEST(Scene, ADressThatThrowsLeavesItAsItWas) {
  const Scratch scratch;
  const std::string path =
      scratch.put("s.json", R"({"cloth": [{"pattern": ")" + internal::test::source_path("patterns/skirt.json") +
                                R"(", "resolution_cm": 6, "pins": [{"in_box_m": [[5, 5, 5], [6, 6, 6]]}]}],
    "body": {"mannequin": "woman"}})");
  Simulation sim = Simulation::from_scene(path);
  const std::string before = sim.state_hash();
  for (int k = 0; k < 2; ++k) {
    EXPECT_THROW(sim.dress(1), InputError) << "a box with nothing of the cloth in it";
    EXPECT_EQ(sim.state_hash(), before);
    EXPECT_TRUE(sim.warnings().empty()) << sim.warnings().front();
  }
}

// What is found only when the scene is loaded, or when the cloth is on; without a file there is no line to name.
TEST(Scene, IsRefusedByFileAndLine) {
  const Scratch scratch;
  const std::string bad = scratch.put("bad.json", R"({"cloth": [{"grid": {"edge_m": 0.2}}], "solids": [
  {"capsule": {"radius_m": 0.1, "from_m": [1, 0, 0], "to_m": [1, 0, 0]}}]})");
  const std::string refused = "to_m: expected another place than from_m, got the same: that is a sphere";
  EXPECT_EQ(message_of<InputError>([&] { Simulation::from_scene(bad); }), bad + ":2:3: /solids/0: " + refused);
  EXPECT_EQ(message_of<InputError>([&] { run_scene(bad, scratch / "run"); }), bad + ":2:3: /solids/0: " + refused);
  const Cloth sheet = Cloth::grid({.width_m = 1, .height_m = 1, .edge_m = 0.2});
  const Body point = Body::capsule(0.1, {1, 0, 0}, {1, 0, 0});
  EXPECT_EQ(message_of<InputError>([&] { Simulation(sheet, point); }), refused);

  scratch.put("tube.json", internal::test::tube_pattern_text());
  const std::string pinned =
      scratch.put("pinned.json", R"({"cloth": [{"pattern": "tube.json", "resolution_cm": 5, "pins": [
    {"in_box_m": [[5, 5, 5], [6, 6, 6]]}]}], "body": {"cylinder": {"radius_m": 0.1, "height_m": 1, "top_m": [0, 0.6, 0]}}})");
  Simulation sewn = Simulation::from_scene(pinned);
  EXPECT_EQ(message_of<InputError>([&] { sewn.dress(0.1); }),
            pinned + ":2:5: /cloth/0/pins/0: expected a box with particles of the cloth in it, got none");
}

TEST(Fabric, ADefaultOneIsCottonInEveryNumber) {
  const Fabric cotton = fabric("cotton"), fresh;
  const auto numbers = [](const Fabric& f) {
    return std::vector<double>{f.density_kg_per_m2, f.stretch_u_N_per_m,
                               f.stretch_v_N_per_m, f.doubling_strain_u,
                               f.doubling_strain_v, f.shear_N_per_m,
                               f.compression_ratio, f.strain_limit,
                               f.bend_u_N_m,        f.bend_v_N_m,
                               f.bend_poisson,      f.bend_uv_N_m,
                               f.bend_friction_N,   f.bend_friction_curvature_per_m,
                               f.bend_set,          f.bend_set_s,
                               f.stretch_damping_s, f.shear_damping_s,
                               f.bend_damping_s,    f.friction,
                               f.thickness_m};
  };
  EXPECT_EQ(numbers(fresh), numbers(cotton));
  EXPECT_EQ(fresh.name, cotton.name);
}

TEST(Check, FindsWhatIsWrongWithAPattern) {
  const CheckReport good = check_pattern(internal::test::source_path("patterns/skirt.json"));
  EXPECT_TRUE(good.usable) << good.explain();
  const Scratch scratch;
  std::ofstream(scratch / "bad.json") << R"({"pattern": {"panels": {"front": {"translation": [0, 0, 0],
    "rotation": [0, 0, 0], "vertices": [[0, 0], [10, 0], [10, 10]], "edges": [{"endpoints": [0, 1]},
    {"endpoints": [1, 2]}]}}, "stitches": []}})";
  const CheckReport bad = check_pattern(scratch / "bad.json");
  ASSERT_FALSE(bad.findings.empty());
  EXPECT_NE(bad.explain().find("front"), std::string::npos);
  EXPECT_THROW(check_pattern(scratch / "none.json"), IoError);
}

}  // namespace
}  // namespace toile
