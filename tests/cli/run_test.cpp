// Runs that succeed, or fail for a reason: files, exit codes and equal bits.
#include "cli/program.hpp"
#include "io/json.hpp"
#include "support/paths.hpp"
#include "support/tube_pattern.hpp"

#include <fmt/printf.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <set>
#include <thread>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

// A small cloth that falls on a cylinder and folds: contact of both kinds.
const char* const small_scene = R"({"cloth": [{"grid": {"width_m": 0.5, "height_m": 0.5, "edge_m": 0.03},
    "placement": {"translation_m": [0, 0.01, 0], "rotation_deg": [-90, 0, 0]}}],
  "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.4}}, "time": {"seconds": 0.7}})";

Json run_small(const Scratch& scratch, const std::string& out, std::vector<std::string> more) {
  std::vector<std::string> words = {"run", "s.json", "--json", "--out", out};
  words.insert(words.end(), more.begin(), more.end());
  const Ended ended = run_toile(scratch, words);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  // On a machine of fewer cores there is a warning.
  EXPECT_TRUE(ended.err.empty() || ended.err.starts_with("toile: warning: --threads 5: there are")) << ended.err;
  return Json::parse(ended.out, "stdout");
}

TEST(Run, GivesTheSameBitsTwiceAndForAnyNumberOfThreads) {
  const Scratch scratch;
  scratch.put("s.json", small_scene);
  const Json first = run_small(scratch, "a", {"--threads", "1"});
  const std::string hash = first.at("state_hash").string(), cache = scratch.get("a/cloth.pc2");
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_FALSE(cache.empty());
  for (const char* threads : {"1", "2", "5"}) {
    const Json again = run_small(scratch, std::string("b") + threads, {"--threads", threads});
    EXPECT_EQ(again.at("state_hash").string(), hash) << threads << " threads";
    EXPECT_EQ(again.at("input_hash").string(), first.at("input_hash").string());
    EXPECT_EQ(scratch.get(std::string("b") + threads + "/cloth.pc2"), cache) << threads << " threads";
  }
}

TEST(Run, AnotherInputHasAnotherHash) {
  const Scratch scratch;
  scratch.put("s.json", small_scene);
  const Json first = run_small(scratch, "a", {"--seconds", "0.1"}),
             second = run_small(scratch, "b", {"--seconds", "0.2"});
  const Json third = run_small(scratch, "c", {"--seconds", "0.1", "--fabric", "silk"});
  EXPECT_NE(first.at("input_hash").string(), second.at("input_hash").string());
  EXPECT_NE(first.at("input_hash").string(), third.at("input_hash").string());
  EXPECT_NE(first.at("state_hash").string(), second.at("state_hash").string());
  EXPECT_NE(first.at("state_hash").string(), third.at("state_hash").string());
}

// A post of twelve sides and 1.6 m.
std::string post_obj() {
  constexpr int sides = 12;
  std::string obj;
  for (const double y : {0.0, 1.6})
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      obj += fmt::sprintf("v %.6f %.1f %.6f\n", 0.1 * std::sin(angle), y, 0.1 * std::cos(angle));
    }
  for (int k = 0; k < sides; ++k) {
    const int a = k + 1, b = (k + 1) % sides + 1;
    obj += fmt::sprintf("f %d %d %d\nf %d %d %d\n", a, b, b + sides, a, b + sides, a + sides);
    if (k > 0 && k + 1 < sides) obj += fmt::sprintf("f 1 %d %d\nf %d %d %d\n", b, a, 1 + sides, a + sides, b + sides);
  }
  return obj;
}

// Options of a pattern's finish arrive, each with another state.
TEST(Run, DressesWithHemsAndSeamAllowances) {
  const Scratch scratch;
  scratch.put("post.obj", post_obj());
  scratch.put("tube.json", test::tube_pattern_text(50, 20, 25, 120));
  const auto dress = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"dress",     "tube.json", "--body",       "post.obj", "--resolution", "6",
                                      "--seconds", "0.6",       "--no-preview", "--out",    "out"};
    words.insert(words.end(), more.begin(), more.end());
    return run_toile(scratch, words);
  };
  std::set<std::string> states;
  const std::vector<std::vector<std::string>> finishes = {
      {}, {"--hem", "20"}, {"--allowance", "10"}, {"--allowance", "10", "--topstitched"}};
  for (const std::vector<std::string>& finish : finishes) {
    const Ended ended = dress(finish);
    ASSERT_EQ(ended.exit_code, 5) << "it still falls: " << ended.err;
    states.insert(Json::load(scratch / "out/report.json").at("state_hash").string());
  }
  EXPECT_EQ(states.size(), finishes.size());
  const Ended alone = dress({"--topstitched"});
  EXPECT_EQ(alone.exit_code, 3) << alone.err;
  EXPECT_NE(alone.err.find("an allowance above zero beside it (allowance_mm, --allowance)"), std::string::npos)
      << alone.err;
}

TEST(Run, WritesTheFilesOfTheContractAndVerifyAgrees) {
  const Scratch scratch;
  scratch.put("s.json", small_scene);
  const Json said = run_small(scratch, "a", {});
  for (const char* name : {"cloth.obj", "cloth.pc2", "body.obj", "body.pc2", "report.json"})
    EXPECT_TRUE(std::filesystem::exists(scratch / (std::string("a/") + name))) << name;
  for (const auto& entry : std::filesystem::directory_iterator(scratch / "a"))
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  const Json report = Json::load(scratch / "a/report.json");
  EXPECT_EQ(report.at("state_hash").string(), said.at("state_hash").string()) << "--json prints the report";
  for (const char* key : {"toile_version", "command",     "input_hash",    "state_hash",      "verdict",
                          "reasons",       "limits",      "threads",       "units",           "cloth",
                          "body",          "fps",         "frames",        "steps",           "steps_rejected",
                          "step_min_ms",   "step_max_ms", "seconds_total", "startup_seconds", "seconds_per_frame",
                          "cg_iterations", "stretch",     "shear_degrees", "penetrations",    "gap_mm",
                          "layer_gap",     "still",       "peak_memory_mb"})
    EXPECT_NE(report.find(key), nullptr) << key;
  double parts = 0;
  for (const char* part : {"scene", "cloth", "body", "placement", "crossings", "other"}) {
    EXPECT_GE(report.at("startup_seconds").at(part).number(), 0) << part;
    parts += report.at("startup_seconds").at(part).number();
  }
  EXPECT_NEAR(report.at("startup_seconds").at("total").number(), parts, 1e-9);
  EXPECT_LT(parts, report.at("seconds_total").number() + report.at("startup_seconds").at("scene").number());
  EXPECT_EQ(report.at("frames").integer(), 21) << "0.7 s at 30 per second, frame 0 included";
  std::int32_t samples = 0;
  std::memcpy(&samples, scratch.get("a/cloth.pc2").data() + 28, 4);
  EXPECT_EQ(samples, 21);

  const Ended verify = run_toile(scratch, {"verify", "a", "--json"});
  EXPECT_EQ(verify.exit_code, 0) << verify.err << verify.out;
  const Json judged = Json::parse(verify.out, "stdout");
  EXPECT_EQ(judged.at("verdict").string(), report.at("verdict").string());
  for (const char* kind : {"cloth_body_edges", "cloth_cloth_edges"})
    EXPECT_EQ(judged.at("penetrations").at(kind).at("max").number(),
              report.at("penetrations").at(kind).at("max").number());
  for (const char* part : {"p50", "p99", "max"})
    EXPECT_NEAR(judged.at("stretch").at(part).number(), report.at("stretch").at(part).number(), 1e-4) << part;
}

// A sheet that hangs by its top for three frames, in folder a.
void run_hanging_sheet(const Scratch& scratch) {
  scratch.put(
      "s.json",
      R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.05}, "pins": [{"near_m": [0, 0.1, 0]}]}],
    "time": {"seconds": 0.1}})");
  ASSERT_EQ(run_toile(scratch, {"run", "s.json", "--out", "a", "--no-preview"}).exit_code, 0);
}

TEST(Run, PicturesAsInAStudio) {
  const Scratch scratch;
  run_hanging_sheet(scratch);
  const auto expect_drawn = [&](const std::vector<std::string>& words, const std::vector<const char*>& keys) {
    const Ended drawn = run_toile(scratch, words);
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    const Json made = Json::parse(drawn.out, "stdout");
    for (const char* key : keys) EXPECT_GT(std::filesystem::file_size(scratch / made.at(key).string()), 1000u) << key;
  };
  expect_drawn({"preview", "a", "--style", "studio", "--close-up", "0,0,0", "--no-film", "--json"},
               {"png", "close_up"});
  EXPECT_FALSE(std::filesystem::exists(scratch / "a/preview.mp4"));
  const std::string studio = scratch.get("a/preview.png");
  expect_drawn({"preview", "a", "--close-up", "0,0,0", "--turntable", "--json"},
               {"png", "mp4", "close_up", "turntable"});
  EXPECT_NE(scratch.get("a/preview.png"), studio);
  EXPECT_EQ(run_toile(scratch, {"preview", "a", "--style", "oil"}).exit_code, 2);
  EXPECT_EQ(run_toile(scratch, {"preview", "a", "--close-up", "0,0"}).exit_code, 2);
  EXPECT_EQ(run_toile(scratch, {"preview", "a", "--close-up", "0,nan,0"}).exit_code, 3);
}

TEST(Run, PicturesInColours) {
  const Scratch scratch;
  run_hanging_sheet(scratch);
  const std::string before = scratch.get("a/report.json");
  const std::vector<std::string> words{"preview", "a", "--no-film", "--looks", "looks.json"};
  scratch.put("looks.json",
              R"({"looks": [{"fabric": "cotton", "print": {"check": [["#c00000", 20], ["#ffffff", 20]]}}]})");
  ASSERT_EQ(run_toile(scratch, {"preview", "a", "--no-film"}).exit_code, 0);
  const std::string plain = scratch.get("a/preview.png");
  const Ended drawn = run_toile(scratch, words);
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_NE(scratch.get("a/preview.png"), plain);
  EXPECT_EQ(scratch.get("a/report.json"), before);
  scratch.put("looks.json", "{\"looks\": [\n  {\"fabric\": \"silk\", \"colour\": \"#c00000\"}\n]}");
  const Ended refused = run_toile(scratch, words);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("looks.json:2:14: /looks/0/fabric: expected a fabric of this run: \"cotton\""),
            std::string::npos)
      << refused.err;
  EXPECT_EQ(run_toile(scratch, {"preview", "a", "--looks", "none.json"}).exit_code, 6);
  // A picture that would be written over.
  scratch.put("looks.json", R"({"looks": [{"print": {"image": "a/preview.png", "width_mm": 100}}]})");
  EXPECT_EQ(run_toile(scratch, words).exit_code, 6);
}

TEST(Run, TheJudgeNamesAndDrawsCrossings) {
  const Scratch scratch;
  run_hanging_sheet(scratch);
  // In frame 2 the two ends of an edge are put on either side of the middle.
  std::string cache = scratch.get("a/cloth.pc2");
  std::int32_t points = 0;
  std::memcpy(&points, cache.data() + 16, 4);
  const auto place = [&](int i) { return cache.data() + 32 + 12 * (2 * points + i); };
  std::array<float, 3> first{}, last{};
  std::memcpy(first.data(), place(0), 12);
  std::memcpy(last.data(), place(points - 1), 12);
  for (std::size_t k = 0; k < 3; ++k) first[k] = 0.45F * first[k] + 0.55F * last[k];
  for (const int i : {0, 1}) {
    std::array<float, 3> end = first;
    end[2] += i == 0 ? 0.02F : -0.02F;
    std::memcpy(place(i), end.data(), 12);
  }
  scratch.put("a/cloth.pc2", cache);
  const Ended judged = run_toile(scratch, {"verify", "a", "--picture"});
  EXPECT_NE(judged.out.find("frame 2 has most crossings"), std::string::npos) << judged.out;
  EXPECT_NE(judged.out.find("of the cloth through triangle"), std::string::npos) << judged.out;
  EXPECT_GT(std::filesystem::file_size(scratch / "a/crossings.png"), 10'000u);
  const Json json = Json::parse(run_toile(scratch, {"verify", "a", "--json"}).out, "stdout");
  EXPECT_EQ(json.at("worst_frame").integer(), 2);
  const auto& crossings = json.at("worst_frame_crossings").array();
  ASSERT_FALSE(crossings.empty());
  for (const Json& crossing : crossings) {
    EXPECT_EQ(crossing.at("edge").array().size(), 2u);
    EXPECT_EQ(crossing.at("edge_of").string(), "cloth");
    EXPECT_EQ(crossing.at("position_m").array().size(), 3u);
  }
}

TEST(Run, AnUnfinishedFailureIsDiagnosedWithExitCodeFive) {
  const Scratch scratch;
  // Two corners of one cloth are torn apart: no step can follow without stretching the cloth past all limits.
  scratch.put(
      "s.json",
      R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.05}, "placement": {"translation_m": [0, 1, 0]},
    "pins": [{"near_m": [-0.1, 1.1, 0]}, {"near_m": [0.1, 1.1, 0], "hold": "path", "path_m": [[0, 0.1, 1.1, 0], [0.3, 1, 1.1, 0]]}]}],
    "time": {"seconds": 0.5}})");
  const Ended ended = run_toile(scratch, {"run", "s.json", "--out", "a", "--json"});
  EXPECT_EQ(ended.exit_code, 5) << ended.err;
  EXPECT_EQ(ended.err_lines(), 1) << ended.err;
  const Json report = Json::parse(ended.out, "stdout");
  EXPECT_EQ(report.at("verdict").string(), "fail");
  EXPECT_FALSE(report.at("reasons").array().empty());
  EXPECT_EQ(run_toile(scratch, {"verify", "a", "--quiet"}).exit_code, 5);
}

// `verify` says why as the run did: one line on stderr, also of a run that has no cloth to measure.
TEST(Run, TheJudgeSaysOnStderrWhyItDoesNotPass) {
  const Scratch scratch;
  scratch.put(
      "s.json",
      R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.05}}], "time": {"seconds": 0.3, "until_still": true}})");
  const Ended ran = run_toile(scratch, {"run", "s.json", "--out", "a", "--quiet"});
  EXPECT_EQ(ran.exit_code, 5);
  const Ended judged = run_toile(scratch, {"verify", "a", "--quiet"});
  EXPECT_EQ(judged.exit_code, 5);
  EXPECT_EQ(judged.out, "");
  EXPECT_EQ(judged.err, ran.err);
  EXPECT_EQ(judged.err.find("toile: a: static_equilibrium: p99 speed "), 0u) << judged.err;

  std::filesystem::create_directory(scratch / "b");
  scratch.put("b/report.json", R"({"frames": 0, "reasons": ["seam_blocked"]})");
  const Ended blocked = run_toile(scratch, {"verify", "b", "--json"});
  EXPECT_EQ(blocked.exit_code, 5);
  EXPECT_EQ(blocked.err_lines(), 1);
  EXPECT_EQ(blocked.err.find("toile: b: "), 0u) << blocked.err;
}

TEST(Run, AnInterruptedRunKeepsConsistentFilesAndSaysSo) {
  const Scratch scratch;
  scratch.put(
      "s.json",
      R"({"cloth": [{"grid": {"edge_m": 0.03}, "placement": {"translation_m": [0, 1, 0]}, "pins": [{"near_m": [-0.5, 1.5, 0]}]}], "time": {"seconds": 600}})");
  const Ended ended = run_toile(scratch, {"run", "s.json", "--out", "a"}, [&](pid_t child) {
    for (int k = 0; k < 200 && !std::filesystem::exists(scratch / "a/cloth.pc2"); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    kill(child, SIGINT);
  });
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.exit_code, 8) << ended.err;
  const Json report = Json::load(scratch / "a/report.json");
  EXPECT_EQ(report.at("verdict").string(), "fail");
  EXPECT_EQ(report.at("reasons").array().front().string(), "interrupted");
  const std::string cache = scratch.get("a/cloth.pc2");
  std::int32_t points = 0, samples = 0;
  ASSERT_GT(cache.size(), 32u);
  std::memcpy(&points, cache.data() + 16, 4);
  std::memcpy(&samples, cache.data() + 28, 4);
  EXPECT_EQ(samples, report.at("frames").integer());
  EXPECT_EQ(cache.size(), 32u + 12u * static_cast<std::size_t>(points) * static_cast<std::size_t>(samples));
  EXPECT_EQ(run_toile(scratch, {"verify", "a", "--quiet"}).exit_code, 5) << "the judge does not acquit it";
}

TEST(Check, CountsAPatternAndSpeaksJson) {
  const Scratch scratch;
  const Ended ended = run_toile(scratch, {"check", test::source_path("patterns/tshirt.json"),
                                          test::source_path("scenes/cylinder.json"), "--json"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  const Json json = Json::parse(ended.out, "stdout");
  const Json& shirt = json.at("files").array().at(0);
  EXPECT_EQ(shirt.at("kind").string(), "pattern");
  EXPECT_EQ(shirt.at("panels").integer(), 8);
  EXPECT_EQ(shirt.at("stitches").integer(), 16);
  EXPECT_GT(shirt.at("mesh").at("min_angle_deg").number(), 20);
  EXPECT_EQ(json.at("files").array().at(1).at("body_vertices").integer(), 322) << "the paper's solid";
}

TEST(Check, GoesOnAfterABadFile) {
  const Scratch scratch;
  scratch.put("bad.json", "{");
  const Ended ended = run_toile(scratch, {"check", "bad.json", test::source_path("patterns/skirt.json")});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_EQ(ended.err_lines(), 1) << ended.err;
  EXPECT_NE(ended.out.find("skirt.json: pattern"), std::string::npos) << ended.out;
}

TEST(Demo, TheDefaultIsAGarmentOnABodyThatWalks) {
  const Scratch scratch;
  scratch.put("patterns/tshirt.json", "not the one that is built in");
  const Ended ended =
      run_toile(scratch, {"demo", "--resolution", "4", "--seconds", "0.2", "--no-preview", "--out", scratch / "out"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  const Json report = Json::load(scratch / "out/report.json");
  EXPECT_EQ(report.at("verdict").string(), "pass");
  EXPECT_EQ(report.at("motion").at("name").string(), "walk");
  EXPECT_EQ(report.at("motion").at("frames").number(), 6);
  EXPECT_TRUE(report.at("inputs").array().empty()) << "no file was read";
}

TEST(Demo, ListsWhatItHas) {
  const Scratch scratch;
  const Ended ended = run_toile(scratch, {"demo", "--list"});
  EXPECT_EQ(ended.exit_code, 0);
  for (const char* name : {"tshirt", "skirt", "cylinder", "sheet"})
    EXPECT_NE(ended.out.find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace toile::internal
