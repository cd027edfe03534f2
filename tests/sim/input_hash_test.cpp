// What `input_hash` is made of besides the settings: the bytes of the files that a scene names.
#include "core/hash.hpp"
#include "io/scratch.hpp"
#include "sim/scene_inputs.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

std::uint64_t input_hash(const Scene& scene) { return input_hash(scene, load_scene(scene, read_text_file)); }

std::string box(double width) {
  std::string text;
  for (const char* corner : {"0 0 0", "1 0 0", "0 1 0", "1 1 0", "0 0 1", "1 0 1", "0 1 1"})
    text += std::string("v ") + corner + "\n";
  text += "v " + std::to_string(width) + " 1 1\n";
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

TEST(InputHash, OfAFileItsBytesCountAndNotItsName) {
  const Scratch scratch;
  scratch.put("a.obj", box(1));
  scratch.put("b.obj", box(1));
  scratch.put("c.obj", box(1.25));
  const auto solid = [&](const std::string& file) {
    return input_hash(parse_scene(R"({"cloth": [{"grid": {"edge_m": 0.2}}], "solids": [{"mesh": ")" + file + R"("}]})",
                                  scratch / "s.json"));
  };
  EXPECT_EQ(solid("a.obj"), solid("b.obj"));
  EXPECT_NE(solid("a.obj"), solid("c.obj"));
}

TEST(InputHash, OfFilesThatChangePlacesIsAnother) {
  const Scratch scratch;
  scratch.put("a.obj", box(1));
  scratch.put("c.obj", box(1.25));
  const auto solids = [&](const std::string& first, const std::string& second) {
    return input_hash(parse_scene(R"({"cloth": [{"grid": {"edge_m": 0.2}}], "solids": [{"mesh": ")" + first +
                                      R"("}, {"sphere": {"radius_m": 1}}, {"mesh": ")" + second + R"("}]})",
                                  scratch / "s.json"));
  };
  EXPECT_NE(solids("a.obj", "c.obj"), solids("c.obj", "a.obj"));
}

TEST(InputHash, OfAColliderIsOfWhatWasReadForIt) {
  const Scratch scratch;
  scratch.put("a.obj", box(1));
  const Scene scene = parse_scene(
      R"({"cloth": [{"grid": {"edge_m": 0.2}}], "solids": [{"mesh": "a.obj"}, {"sphere": {"radius_m": 1}}]})",
      scratch / "s.json");
  const LoadedScene loaded = load_scene(scene, read_text_file);
  EXPECT_EQ(loaded.cloth.front().input_hash, 0U) << "nothing";
  ASSERT_EQ(loaded.colliders.input_hashes.size(), 2U);
  EXPECT_EQ(loaded.colliders.input_hashes[0], hash_of_text(box(1)));
  EXPECT_EQ(loaded.colliders.input_hashes[1], 0U);
}

// What `verify` compares: the files themselves, of a folder those that a scene reads from it.
TEST(InputFiles, AreThoseThatASceneReads) {
  const Scratch scratch;
  for (const char* name : {"walk/b_1.obj", "walk/b_2.obj", "walk/notes.txt", "run/report.json", "run/cloth.obj",
                           "run/cloth.pc2", "run/preview.png", "100%/p.json"})
    scratch.put(name, name);
  const std::vector<std::string> paths = {scratch / "walk", scratch / "walk/b_%d.obj", scratch / "run",
                                          scratch / "100%/p.json", "tshirt"};
  std::vector<std::string> names;
  for (const InputFile& file : checksums_of_inputs(paths, scratch / "out/here")) names.push_back(file.path);
  EXPECT_EQ(names, (std::vector<std::string>{"../../walk/b_1.obj", "../../walk/b_2.obj", "../../run/report.json",
                                             "../../run/cloth.obj", "../../run/cloth.pc2", "../../100%/p.json"}))
      << "each once";
}

TEST(InputHash, TextsThatFollowEachOtherDoNotRunIntoEachOther) {
  Hash one, other;
  one.add_text("ab");
  one.add_text("c");
  other.add_text("a");
  other.add_text("bc");
  EXPECT_NE(one.hex(), other.hex());
}

// Two scenes that differ in nothing but the run that they start from.
TEST(InputHash, AStartIsTheRunThatItStartsFrom) {
  const Scratch scratch;
  const auto run = [&](const std::string& name, const std::string& start, const std::string& gravity) {
    const std::string from = start.empty() ? "" : R"(, "start": ")" + start + '"';
    const Scene scene = parse_scene(R"({"cloth": [{"grid": {"width_m": 0.4, "height_m": 0.4, "edge_m": 0.1}}],
      "world": {"gravity_m_per_s2": [0, )" +
                                        gravity + R"(, 0]}, "time": {"seconds": 0.1})" + from + "}",
                                    scratch / "s.json");
    RunOptions options;
    options.directory = scratch / name;
    return simulate(scene, options).input_hash;
  };
  run("slow", "", "-1");
  run("fast", "", "-20");
  const std::string from_slow = run("x", "slow", "-9");
  EXPECT_NE(from_slow, run("y", "fast", "-9"));
  EXPECT_EQ(from_slow, run("z", "slow", "-9"));
  EXPECT_NE(from_slow, run("w", "", "-9"));
}

TEST(InputHash, SecondsThatAreGivenCount) {
  const auto with = [](const std::string& time) {
    return input_hash(parse_scene(R"({"cloth": [{"grid": {"edge_m": 0.2}}],
      "solids": [{"sphere": {"radius_m": 0.1}, "moves": [{"t_s": 0}, {"t_s": 2, "shift_m": [0, 1, 0]}]}])" +
                                      time + "}",
                                  "s.json"));
  };
  EXPECT_NE(with(""), with(R"(, "time": {"seconds": 5})")) << "2 s of moves, or 5";
}

}  // namespace
}  // namespace toile::internal
