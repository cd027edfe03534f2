// What a scene will take is said before the start, holds, and is refused beyond a limit.
#include "cli/program.hpp"
#include "io/json.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

// `count` sheets of `triangles` each, as far as the sheet's size gives that.
std::string sheets(int count, double edge_m, const std::string& more = "") {
  std::string text = R"({"name": "many", "cloth": [)";
  for (int k = 0; k < count; ++k)
    text += (k > 0 ? ", " : "") + (R"({"name": "a)" + std::to_string(k)) +
            R"(", "grid": {"width_m": 6.5, "height_m": 6.5, "edge_m": )" + std::to_string(edge_m) + "}}";
  return text + "], \"time\": {\"seconds\": 0.1}" + more + '}';
}

// `check`, `run` and `dress` say the same, and leave nothing.
std::string refused(const Scratch& scratch, const std::vector<std::string>& run, std::vector<std::string> options) {
  std::vector<std::string> words = {"check", run[1]};
  words.insert(words.end(), options.begin(), options.end());
  const Ended checked = run_toile(scratch, words);
  words = run;
  words.insert(words.end(), options.begin(), options.end());
  words.insert(words.end(), {"--out", "never"});
  const Ended ran = run_toile(scratch, words);
  EXPECT_EQ(checked.exit_code, 7) << checked.err;
  EXPECT_EQ(ran.exit_code, 7) << ran.err;
  EXPECT_EQ(checked.err, ran.err);
  EXPECT_EQ(ran.err_lines(), 1) << ran.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "never"));
  return ran.err;
}

TEST(Budget, ManyItemsThatAreEachAllowedAreRefusedTogether) {
  const Scratch scratch;
  scratch.put("bomb.json", sheets(50, 0.0071));
  const std::string said = refused(scratch, {"run", "bomb.json"}, {"--max-memory", "20000"});
  EXPECT_NE(said.find("many: memory: expected at most 20,000 MB"), std::string::npos) << said;
  EXPECT_NE(said.find("cloth \"a0\" (grid), 1,935,572 triangles"), std::string::npos) << said;
  EXPECT_NE(said.find("and 47 more"), std::string::npos) << said;
  scratch.put("sheets.json", sheets(200, 0.2));
  EXPECT_NE(refused(scratch, {"run", "sheets.json"}, {"--max-memory", "1000"}).find("and 197 more"), std::string::npos);
  EXPECT_EQ(run_toile(scratch, {"check", "sheets.json", "--max-memory", "50000"}).exit_code, 0)
      << "and no more than that";
  // Without the option, what there is.
  EXPECT_EQ(run_toile(scratch, {"check", "bomb.json"}).exit_code, 7) << "350 GB";
}

TEST(Budget, FramesAndHoursHaveLimitsToo) {
  const Scratch scratch;
  scratch.put("s.json", R"({"name": "long", "cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.05}}],
      "time": {"fps": 1000, "seconds": 3600}})");
  EXPECT_NE(refused(scratch, {"run", "s.json"}, {})
                .find("long: frames: expected at most 1,000,000 (--max-frames), got up to 3,600,000"),
            std::string::npos);
  EXPECT_NE(refused(scratch, {"run", "s.json"}, {"--max-frames", "1e7", "--max-hours", "0.1"})
                .find("long: time: expected at most 0.1 hours"),
            std::string::npos);
  EXPECT_EQ(run_toile(scratch, {"check", "s.json", "--max-frames", "1e7"}).exit_code, 0);
  for (const char* option : {"--max-memory", "--max-frames", "--max-hours"})
    for (const char* value : {"0", "-1", "nan", "x"})
      EXPECT_EQ(run_toile(scratch, {"run", "s.json", option, value}).exit_code, 2) << option << ' ' << value;
}

// Two squares that are sewn together at two sides; `z` is where one of them is, cm.
std::string two_squares(const std::string& z) {
  const std::string square = R"("rotation": [0, 0, 0], "vertices": [[0, 0], [30, 0], [30, 30], [0, 30]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})";
  return R"({"pattern": {"panels": {"far": {"translation": [0, 80, )" + z + "], " + square +
         R"(, "near": {"translation": [0, 80, 1], )" + square +
         R"(}, "stitches": [[{"panel": "far", "edge": 1}, {"panel": "near", "edge": 1}],
      [{"panel": "far", "edge": 3}, {"panel": "near", "edge": 3}]]},
    "properties": {"curvature_coords": "relative", "units_in_meter": 100}})";
}

TEST(Budget, APanelThatIsFarAwayIsRefusedByName) {
  const Scratch scratch;
  scratch.put("far.json", two_squares("99000"));
  const std::string said = refused(scratch, {"dress", "far.json", "--body", "woman"}, {});
  EXPECT_NE(
      said.find(
          "far.json: panel \"far\": expected within 20 m of what it is sewn to, got 990 m from panel \"near\" (seam "),
      std::string::npos)
      << said;
  scratch.put("near.json", two_squares("60"));
  EXPECT_EQ(run_toile(scratch, {"check", "near.json"}).exit_code, 0);
}

TEST(Budget, TheEstimateOfMemoryIsNearThePeak) {
  constexpr double band =
      0.35;  // small scenes, whose memory is the program's own to a part, move more than large ones (bench/notes.md)
  const Scratch scratch;
  scratch.put("sheet.json", R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.021},
      "placement": {"translation_m": [0, 0.01, 0], "rotation_deg": [-90, 0, 0]}}], "body": {"cylinder": {"radius_m": 0.2, "height_m": 0.5}},
      "time": {"seconds": 1}})");
  scratch.put("finer.json",
              R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.009}}], "time": {"seconds": 0.2}})");
  scratch.put("ball.json", R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05}}],
      "solids": [{"sphere": {"radius_m": 0.5}, "edge_m": 0.01, "placement": {"translation_m": [0, -1, 0]}}], "time": {"seconds": 0.1}})");
  scratch.put("shirt.json",
              R"({"cloth": [{"pattern": ")" + test::source_path("patterns/tshirt.json") + R"(", "resolution_cm": 1.5}],
      "body": {"mannequin": "woman", "motion": "walk"}, "time": {"drape_seconds": 0.3, "seconds": 0.2}})");
  for (const char* scene : {"sheet", "finer", "ball", "shirt"}) {
    const std::string file = std::string(scene) + ".json";
    const Json checked = Json::parse(run_toile(scratch, {"check", file, "--json"}).out, "stdout");
    const double estimate_mb = checked.at("files").array().front().at("budget").at("memory_mb").number();
    const Json report =
        Json::parse(run_toile(scratch, {"run", file, "--out", scene, "--json", "--no-preview"}).out, "stdout");
    const double peak_mb = report.at("peak_memory_mb").number();
    EXPECT_NEAR(estimate_mb / peak_mb, 1, band) << scene << ": " << estimate_mb << " MB, measured " << peak_mb;
  }
}

TEST(Budget, CheckSaysWhatARunWillTake) {
  const Scratch scratch;
  scratch.put(
      "s.json",
      R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.05}}], "time": {"fps": 30, "seconds": 2}})");
  const std::string tshirt = test::source_path("patterns/tshirt.json");
  const Json said = Json::parse(run_toile(scratch, {"check", "s.json", tshirt, "--json"}).out, "stdout");
  const Json &sheet = said.at("files").array()[0].at("budget"), &shirt = said.at("files").array()[1].at("budget");
  EXPECT_EQ(sheet.at("frames").integer(), 60);
  EXPECT_EQ(sheet.at("unwritten_frames").integer(), 0);
  EXPECT_EQ(shirt.at("frames").integer(), 600) << "20 s, as dress has them";
  EXPECT_GT(shirt.at("unwritten_frames").integer(), 30) << "of sewing";
  EXPECT_GT(shirt.at("seconds").number(), sheet.at("seconds").number());
  EXPECT_NE(run_toile(scratch, {"check", "s.json"}).out.find(" MB, up to 60 frames, up to "), std::string::npos);
}

}  // namespace
}  // namespace toile::internal
