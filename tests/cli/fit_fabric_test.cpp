// `toile fit-fabric` as a user runs it, and --fabric with what it wrote.
#include "cli/program.hpp"
#include "io/json.hpp"
#include "sim/fabric_file.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

std::string example() { return test::source_path("examples/poplin_measurements.json"); }

const char* const little = R"({"name": "gauze", "base": "silk", "weight_g_per_m2": [40, 41], "shear_N_per_m": 1})";
const char* const good = R"({"name": "gauze", "base": "silk", "weight_g_per_m2": [40, 41]})";
const char* const sheet = R"("grid": {"edge_m": 0.2}, "pins": [{"near_m": [0, 0, 0]}]}], "time": {"seconds": 0.1}})";

std::string hash_of(const Ended& ended) { return Json::parse(ended.out, "stdout").at("state_hash").string(); }

TEST(FitFabric, TheExampleAgreesWithItself) {
  const Scratch scratch;
  const Ended ended = run_toile(scratch, {"fit-fabric", example()});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  for (const char* word : {"example poplin: a fabric based on cotton", "density_kg_per_m2         0.11820 ± 0.00025",
                           "kg/m2   weight, 5 readings", "KES-F 2HB", "drape coefficient of the fitted fabric",
                           "\"fabric\": {\"base\": \"cotton\", \"density_kg_per_m2\": 0.1182"})
    EXPECT_NE(ended.out.find(word), std::string::npos) << '"' << word << "\" is not in: " << ended.out;
  EXPECT_EQ(ended.out.find("warning"), std::string::npos) << ended.out;
  EXPECT_EQ(scratch.file_count(), 2u) << "stdout and stderr of this test: nothing is written";
}

TEST(FitFabric, TheFileIsTheJsonAndASceneAndEveryRunTakeIt) {
  const Scratch scratch;
  const Ended told = run_toile(scratch, {"fit-fabric", example(), "--json", "--out", "new/folder/poplin.json"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  EXPECT_EQ(told.out, scratch.get("new/folder/poplin.json"));
  const Json json = Json::parse(told.out, "stdout");
  EXPECT_TRUE(json.at("flags").array().empty());
  const std::size_t begin = told.out.find("\"fabric\": {"), end = told.out.find('}', begin) + 1;

  // The same bits, whichever way the fabric goes into a run; others with another fabric.
  scratch.put("inside.json", "{\"cloth\": [{" + told.out.substr(begin, end - begin) + ", " + sheet);
  scratch.put("s.json", std::string("{\"cloth\": [{") + sheet);
  const Ended inside = run_toile(scratch, {"run", "inside.json", "--out", "a", "--json"}),
              option =
                  run_toile(scratch, {"run", "s.json", "--fabric", "new/folder/poplin.json", "--out", "b", "--json"}),
              cotton = run_toile(scratch, {"run", "s.json", "--out", "c", "--json"});
  EXPECT_EQ(hash_of(inside), hash_of(option));
  EXPECT_NE(hash_of(inside), hash_of(cotton));
  const Json inputs = Json::parse(option.out, "stdout").at("inputs");
  EXPECT_EQ(inputs.array().size(), 2u);
  EXPECT_EQ(inputs.array()[1].at("path").string(), "../new/folder/poplin.json");
  EXPECT_EQ(run_toile(scratch, {"verify", "b"}).exit_code, 0);

  // dress: refused before anything is read of the body, or not at all.
  const std::string pattern = test::source_path("patterns/skirt.json");
  const Ended dressed =
      run_toile(scratch, {"dress", pattern, "--body", "woman", "--fabric", "new/folder/poplin.json", "--resolution",
                          "4", "--time-limit", "1", "--no-preview", "--json", "--out", "d"});
  EXPECT_TRUE(dressed.exit_code == 0 || dressed.exit_code == 5) << dressed.err;
  EXPECT_FALSE(dressed.out.empty());
}

TEST(FitFabric, QuietSaysNothingAndSaysWhereTheFileIs) {
  const Scratch scratch;
  scratch.put("m.json", good);
  const Ended quiet = run_toile(scratch, {"fit-fabric", "m.json", "--quiet", "--out", "f.json"});
  EXPECT_EQ(quiet.exit_code, 0) << quiet.err;
  EXPECT_EQ(quiet.out, "");
  EXPECT_TRUE(is_fabric_fit(scratch.get("f.json")));
  const Ended loud = run_toile(scratch, {"fit-fabric", "m.json", "--out", "f.json"});
  EXPECT_EQ(loud.exit_code, 0) << "its own file may be replaced: " << loud.err;
  EXPECT_TRUE(loud.out.ends_with("\nf.json\n")) << loud.out;
  EXPECT_NE(loud.out.find("silk (base)"), std::string::npos);
}

TEST(FitFabric, NeverWritesOverWhatIsNotItsOwn) {
  const Scratch scratch;
  scratch.put("m.json", good);
  scratch.put("scene.json", "{\"cloth\": []}");
  for (const auto& [out, code] : std::initializer_list<std::pair<const char*, int>>{
           {"./m.json", 6}, {"scene.json", 6}, {"fabric.txt", 2}, {"m.json/f.json", 6}}) {
    const Ended ended = run_toile(scratch, {"fit-fabric", "m.json", "--out", out});
    EXPECT_EQ(ended.exit_code, code) << out << ": " << ended.err;
    EXPECT_EQ(ended.err_lines(), 1) << ended.err;
  }
  EXPECT_EQ(scratch.get("m.json"), good);
  EXPECT_EQ(scratch.get("scene.json"), "{\"cloth\": []}");
  EXPECT_FALSE(std::filesystem::exists(scratch / "fabric.txt"));
}

TEST(FitFabric, WhatIsWrongIsOneLineAndTheRightExitCode) {
  const Scratch scratch;
  scratch.put("m.json", little);
  Ended ended = run_toile(scratch, {"fit-fabric", "m.json", "--out", "f.json"});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_EQ(ended.err_lines(), 1) << ended.err;
  for (const char* word : {"m.json:1:", "expected", "shear_N_per_m", "got"})
    EXPECT_NE(ended.err.find(word), std::string::npos) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "f.json"));
  EXPECT_EQ(run_toile(scratch, {"fit-fabric", "none.json"}).exit_code, 6);
  EXPECT_EQ(run_toile(scratch, {"fit-fabric"}).exit_code, 2);
  ended = run_toile(scratch, {"fit-fabric", "none.json", "--json"});
  EXPECT_EQ(Json::parse(ended.out, "stdout").at("exit_code").integer(), 6);
  // --fabric with a file that is none.
  scratch.put("s.json", std::string("{\"cloth\": [{") + sheet);
  ended = run_toile(scratch, {"run", "s.json", "--fabric", "m.json", "--out", "out"});
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_NE(ended.err.find("m.json:1:"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("toile fit-fabric"), std::string::npos) << ended.err;
  EXPECT_EQ(run_toile(scratch, {"run", "s.json", "--fabric", "none.json", "--out", "out"}).exit_code, 6);
  EXPECT_EQ(run_toile(scratch, {"run", "s.json", "--fabric", "coton", "--out", "out"}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/report.json"));
}

}  // namespace
}  // namespace toile::internal
