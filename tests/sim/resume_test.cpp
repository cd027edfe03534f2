// A run that is left anywhere and taken up again ends with the bits of one that was not.
#include "core/parallel.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "io/scratch.hpp"
#include "sim/simulate.hpp"
#include "support/paths.hpp"
#include "support/tube_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

namespace toile::internal {
namespace {

RunOptions options_of(const std::string& directory) {
  RunOptions options;
  options.directory = directory;
  options.command = "toile run s.json";
  options.arguments = {"run", "s.json"};
  options.checkpoints.every_frames = 1;
  return options;
}

// Wall time, and what depends on the process.
bool differs_between_runs(const std::string& key) {
  return key.find("seconds") != std::string::npos || key == "peak_memory_mb" || key == "threads" ||
         key == "report_hash";
}

// Every value of a report at its pointer, but those that differ between two runs.
void add_values(const Json& value, std::map<std::string, std::string>& values) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.object())
      if (!differs_between_runs(key)) add_values(member, values);
  } else if (value.is_array()) {
    for (const Json& one : value.array()) add_values(one, values);
  } else {
    values[value.pointer()] = value.is_string() ? value.string() : value.describe();
  }
}

// Bytes of all files but the report, and what the report says that is not time.
std::map<std::string, std::string> contents(const std::string& directory) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    if (name != "report.json") files[name] = read_file(entry.path().string());
  }
  add_values(Json::load(directory + "/report.json"), files);
  return files;
}

// Stopped after every so many questions whether it should, each time by another number of threads.
void compare(const Scene& scene, const std::vector<int>& stops) {
  const Scratch scratch;
  simulate(scene, options_of(scratch / "whole"));
  const auto whole = contents(scratch / "whole");
  for (const int stop : stops) {
    SCOPED_TRACE("stopped after " + std::to_string(stop));
    RunOptions options = options_of(scratch / "parts");
    int left = 0, parts = 0;
    options.stop = [&] { return --left < 0; };
    Report report;
    do {
      left = stop << std::min(parts / 3, 12);  // a stop in the first frame of a part leads nowhere: then a later one
      with_threads(parts % 2 == 0 ? 1 : 3, [&] { report = simulate(scene, options); });
      options.resume = true;
      ASSERT_LT(++parts, 60);
    } while (report.ended == reason::interrupted);
    EXPECT_GT(parts, 1);
    EXPECT_EQ(contents(scratch / "parts"), whole);
    std::filesystem::remove_all(scratch / "parts");
  }
}

TEST(Resume, OfShapesThatAreLedAndPulled) {
  compare(parse_scene(R"({"cloth": [
      {"name": "flag", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05}, "placement": {"translation_m": [0, 0.3, 0], "rotation_deg": [-90, 0, 0]},
       "pins": [{"near_m": [-0.15, 0.3, -0.15], "to_s": 0.2}, {"in_box_m": [[0.14, 0.2, -0.2], [0.2, 0.4, 0.2]], "hold": "moves", "from_s": 0.1, "moves": [{"t_s": 0.1}, {"t_s": 0.4, "shift_m": [0.1, 0, 0], "rotation_deg": [0, 30, 0]}]}],
       "panels": {"flag": {"rest_stretch_path": [[0.1, 1, 1], [0.4, 0.9, 0.95]], "pressure_path": [[0.2, 0], [0.4, 3]]}}},
      {"name": "other", "grid": {"width_m": 0.3, "height_m": 0.2, "edge_m": 0.05}, "placement": {"translation_m": [0, 0.26, 0], "rotation_deg": [-90, 0, 0]},
       "drags": [{"near_m": [0.1, 0.26, 0.1], "path_m": [[0, 0.1, 0.3, 0.1], [0.3, 0.2, 0.4, 0.1]]}]}],
      "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.4, "top_m": [0, 0.2, 0]}},
      "solids": [{"sphere": {"radius_m": 0.06}, "edge_m": 0.03, "placement": {"translation_m": [0.2, 0.1, 0]}, "moves": [{"t_s": 0}, {"t_s": 0.3, "shift_m": [0, 0.2, 0]}]}],
      "time": {"seconds": 0.6, "drape_seconds": 0.2}, "world": {"wind_m_per_s": [1, 0, 0]}})",
                      "s.json"),
          {5, 17});
}

// Slipped threads and the set of a bend are the state of every triangle.
TEST(Resume, OfClothThatRemembersItsBends) {
  compare(
      parse_scene(
          R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.04}, "placement": {"translation_m": [0, 0.21, 0], "rotation_deg": [-90, 0, 0]},
      "fabric": {"base": "cotton", "bend_friction_N": 6e-4, "bend_set": 0.3, "bend_set_s": 0.5}}],
      "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.4, "top_m": [0, 0.2, 0]}}, "time": {"seconds": 0.5}})",
          "s.json"),
      {7});
}

TEST(Resume, OfALayerOnALayerWithOtherSolvers) {
  for (
      const char* solver :
      {R"("solver": {"newton_iterations": 2}, "time": {"seconds": 0.5, "integrator": "bdf2"})",
       R"("solver": {"preconditioner": "block_ssor", "procedure": "paper_1998"}, "time": {"seconds": 0.5, "step_max_ms": 10})"})
    compare(parse_scene(R"({"cloth": [
      {"name": "a", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.04}, "placement": {"translation_m": [0, 0.21, 0], "rotation_deg": [-90, 0, 0]}},
      {"name": "b", "grid": {"width_m": 0.25, "height_m": 0.25, "edge_m": 0.04}, "placement": {"translation_m": [0.02, 0.23, 0], "rotation_deg": [-90, 20, 0]}}],
      "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.4, "top_m": [0, 0.2, 0]}}, )" +
                            std::string(solver) + "}",
                        "s.json"),
            {7});
}

// Nothing touches: BDF2 remembers the step before from frame to frame.
TEST(Resume, OfAFlagThatSwingsFreely) {
  compare(
      parse_scene(
          R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.2, "edge_m": 0.06}, "placement": {"rotation_deg": [-90, 0, 0]},
      "pins": [{"in_box_m": [[-0.2, -0.1, -0.2], [0.2, 0.1, -0.09]]}]}], "time": {"seconds": 0.4, "integrator": "bdf2"}})",
          "s.json"),
      {9});
}

// It ends at rest: how far it came before it was left counts.
TEST(Resume, OfASheetThatComesToRest) {
  const Scene scene = parse_scene(
      R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.05}, "placement": {"rotation_deg": [-30, 0, 0]},
      "pins": [{"in_box_m": [[-0.2, 0.08, -0.2], [0.2, 0.11, 0.2]]}]}],
      "time": {"seconds": 10, "until_still": true}})",
      "s.json");
  const Scratch scratch;
  const Report report = simulate(scene, options_of(scratch / "whole"));
  EXPECT_EQ(report.ended, "still");
  EXPECT_GT(report.frames, 20);
  compare(scene, {13});
}

// Cloth that starts through itself: what pushes it apart goes on, too.
TEST(Resume, OfCrossingCloth) {
  compare(parse_scene(R"({"cloth": [
      {"name": "a", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.03}, "pins": [{"in_box_m": [[-0.2, 0.14, -0.1], [0.2, 0.16, 0.1]]}]},
      {"name": "b", "grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.03}, "placement": {"translation_m": [0.05, -0.04, 0], "rotation_deg": [0, 80, 0]},
       "pins": [{"in_box_m": [[-0.2, 0.1, -0.2], [0.2, 0.12, 0.2]]}]}], "time": {"seconds": 0.4}})",
                      "s.json"),
          {6});
}

// Sewing, the drape of what goes below, sewing over it, settling, drape and motion: a stop in each.
TEST(Resume, OfAnOutfitThatMoves) {
  const std::string folder = test::source_path("patterns/");
  compare(
      parse_scene(R"({"cloth": [{"pattern": ")" + folder + R"(short_skirt.json", "resolution_cm": 7}, {"pattern": ")" +
                      folder + R"(tshirt.json", "resolution_cm": 7}],
      "body": {"mannequin": "woman", "motion": "sway"}, "time": {"seconds": 0.3, "drape_seconds": 0.8}})",
                  "s.json"),
      {37});
}

// A wide tube, drawn across the arms from the hips to the neck: arms are lifted, the body grows, and a seam may stay open.
TEST(Resume, OfAPersonThatGrowsWithItsArmsLifted) {
  const Scratch scratch;
  scratch.put("wide.json", test::tube_pattern_text(60, 60, 25, 85));
  compare(parse_scene(R"({"cloth": [{"pattern": "wide.json", "resolution_cm": 4}], "body": {"mannequin": "woman"},
      "time": {"seconds": 0.4, "until_still": false}})",
                      scratch / "s.json"),
          {90});
}

// Sewn with edges of 2 cm and cut finer after it: the inner one before it is draped, the outer one before the drape.
TEST(Resume, OfAnOutfitThatIsCutFinerOnceItIsOn) {
  const Scratch scratch;
  scratch.put("inner.json", test::tube_pattern_text(20, 6, 7, -3));
  scratch.put("outer.json", test::tube_pattern_text(24, 6, 9, -3));
  const std::string text =
      R"({"cloth": [{"pattern": "inner.json", "resolution_cm": 1}, {"pattern": "outer.json", "resolution_cm": 1}],
      "body": {"cylinder": {"radius_m": 0.055, "height_m": 0.4, "top_m": [0, 0.2, 0]}}, "time": {"seconds": 0.3, "drape_seconds": 0.2, "until_still": false}})";
  const Scene scene = parse_scene(text, scratch.put("s.json", text));
  const Report report = simulate(scene, options_of(scratch / "again"));
  EXPECT_GT(report.vertices, 2 * 250) << "edges of 1 cm, not of 2";
  EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0);
  EXPECT_EQ(report.audit.cloth_body_edges.max, 0);
  compare(scene, {9, 31});
}

// It is sewn and grown into with edges of 2 cm; a stop in each phase, and in the drape.
TEST(Resume, OfAPersonThatGrowsIntoWhatIsCutFiner) {
  const Scratch scratch;
  scratch.put("band.json", test::tube_pattern_text(52, 6, 20, 96));
  compare(parse_scene(R"({"cloth": [{"pattern": "band.json", "resolution_cm": 1}], "body": {"mannequin": "woman"},
      "time": {"seconds": 0.2, "until_still": false}})",
                      scratch / "s.json"),
          {45});
}

// The same until rest: it falls before it is cut finer, and is left in that fall and after it.
TEST(Resume, OfAGarmentThatFallsBeforeItIsCutFiner) {
  const Scratch scratch;
  scratch.put("ring.json", test::tube_pattern_text(20, 6, 7, 6));
  const Scene scene = parse_scene(
      R"({"cloth": [{"pattern": "ring.json", "resolution_cm": 1}], "body": {"sphere": {"radius_m": 0.1}}, "time": {"seconds": 0.6}})",
      scratch / "s.json");
  ASSERT_TRUE(scene.until_still);
  compare(scene, {29, 41});
}

// A strip between the sides of both seams of a tube blocks them, and is taken apart from them.  Left open they cross nothing: a run that took
// them for blocked would go on from there.
TEST(Resume, OfASeamThatIsStoppedWhileItIsTakenApart) {
  const Scratch scratch;
  scratch.put("tube.json", R"({"pattern": {"panels": {
      "front": {"translation": [0, 0, 12], "rotation": [0, 0, 0], "vertices": [[-6, -6], [6, -6], [6, 6], [-6, 6]],
        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]},
      "back": {"translation": [0, 0, -12], "rotation": [0, 0, 0], "vertices": [[-6, -6], [-6, 6], [6, 6], [6, -6]],
        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]},
      "strip": {"translation": [0, 0, 0], "rotation": [0, 0, 0], "vertices": [[-15, -10], [15, -10], [15, 10], [-15, 10]],
        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}},
    "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 2}],
                 [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 0}]]},
    "properties": {"units_in_meter": 100}})");
  const std::string text =
      R"({"cloth": [{"pattern": "tube.json", "resolution_cm": 5}], "contact": {"thickness_mm": 20}, "time": {"seconds": 0.3}})";
  const Scene scene = parse_scene(text, scratch.put("s.json", text));
  const Report report = simulate(scene, options_of(scratch / "whole"));
  EXPECT_TRUE(report.open_seams.empty());
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_NE(report.warnings.front().find("was taken apart, and sewing went on"), std::string::npos)
      << report.warnings.front();
  RunOptions options = options_of(scratch / "parts");
  bool untangling = false;
  options.progress = [&](const Progress& progress) { untangling = untangling || progress.phase == "untangling"; };
  options.stop = [&] { return untangling; };
  EXPECT_EQ(simulate(scene, options).ended, reason::interrupted);
  EXPECT_TRUE(untangling);
  options.progress = nullptr;
  options.stop = nullptr;
  options.resume = true;
  simulate(scene, options);
  EXPECT_EQ(contents(scratch / "parts"), contents(scratch / "whole"));
}

TEST(Resume, RefusesOtherInputsAndADamagedState) {
  const Scratch scratch;
  const auto scene = [](const char* gravity) {
    return parse_scene(
        R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.05}}], "time": {"seconds": 1},
      "world": {"gravity_m_per_s2": [0, )" +
            std::string(gravity) + ", 0]}}",
        "s.json");
  };
  RunOptions options = options_of(scratch / "out");
  int left = 10;
  options.stop = [&] { return --left < 0; };
  const Scene same = scene("-9.81");
  ASSERT_EQ(simulate(same, options).ended, reason::interrupted);
  options.resume = true;
  EXPECT_NE(message_of<InputError>([&] { simulate(scene("-9.8"), options); }).find("input_hash"), std::string::npos);
  const std::string state = scratch.get("out/checkpoint.bin");
  for (std::size_t k = 0; k < state.size(); k += 1 + state.size() / 97) {
    std::string changed = state;
    changed[k] = static_cast<char>(changed[k] ^ 4);
    scratch.put("out/checkpoint.bin", changed);
    EXPECT_THROW(simulate(same, options), InputError) << k;
    scratch.put("out/checkpoint.bin", state.substr(0, k));
    EXPECT_THROW(simulate(same, options), InputError) << k;
  }
  scratch.put("out/checkpoint.bin", state);
  options.stop = {};
  EXPECT_EQ(simulate(same, options).ended, "time");
  EXPECT_THROW(simulate(same, options), IoError) << "it is finished";
}

}  // namespace
}  // namespace toile::internal
