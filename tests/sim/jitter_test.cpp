// Jitter planted in the files of a real run is seen by the judge.
#include "io/json.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// Every position of the cloth up by half a millimetre in even frames, down by as much in odd ones.
void plant(const std::string& path) {
  std::vector<std::vector<Vec3>> frames;
  {
    Pc2Reader reader(path);
    frames.resize(static_cast<std::size_t>(reader.samples()));
    for (int f = 0; f < reader.samples(); ++f) reader.read(f, frames[static_cast<std::size_t>(f)]);
  }
  std::filesystem::remove(path);
  Pc2Writer writer(path, static_cast<Index>(frames[0].size()), 0, 1);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (f > 0)  // frame 0 is cloth.obj
      for (Vec3& p : frames[f]) p.y() += f % 2 == 0 ? 0.5e-3 : -0.5e-3;
    writer.append(frames[f]);
  }
}

// A kerchief, so many metres off the middle of her head.
Scene on_a_twisting_head(const std::string& aside_m) {
  return parse_scene(R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.03},
      "placement": {"translation_m": [)" +
                         aside_m + R"(, 1.74, 0], "rotation_deg": [-90, 0, 0]}}],
    "body": {"mannequin": "woman", "motion": "twist"}, "time": {"seconds": 1, "drape_seconds": 1}})",
                     "s.json");
}

// Of single starts one in five to three is over it, however exactly steps are solved: a corner snaps over.  Solved to 0.1 instead of 0.01
// the median is 88.
TEST(JitterOfARun, IsSmallInTheMedianOfSevenStarts) {
  std::vector<double> p99;
  for (const char* aside_m : {"-0.006", "-0.004", "-0.002", "0", "0.002", "0.004", "0.006"}) {
    const Scratch scratch;
    RunOptions options;
    options.directory = scratch / "out";
    options.command = "test";
    const Report report = simulate(on_a_twisting_head(aside_m), options);
    ASSERT_EQ(report.ended, "time") << aside_m;
    p99.push_back(report.audit.jitter.p99_mm_per_s);
  }
  std::sort(p99.begin(), p99.end());
  EXPECT_LT(p99[3], 20);
}

TEST(JitterOfARun, RisesWhenItsFilesTremble) {
  const Scratch scratch;
  const Scene scene = on_a_twisting_head("0");
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  const Report report = simulate(scene, options);
  ASSERT_EQ(report.ended, "time");
  const JitterStatistics as_run = report.audit.jitter;
  EXPECT_EQ(as_run.windows, report.motion.frames - 4) << "of the motion only";

  const JitterStatistics as_written = verify_directory(options.directory).jitter;
  EXPECT_EQ(as_written.p50_mm_per_s, as_run.p50_mm_per_s);
  EXPECT_EQ(as_written.p99_mm_per_s, as_run.p99_mm_per_s);
  EXPECT_EQ(as_written.max_mm_per_s, as_run.max_mm_per_s);
  const Json json = Json::parse(text_of(scratch / "out/report.json"), "report.json");
  EXPECT_EQ(json.at("jitter").at("speed_mm_per_s_p99").number(), as_run.p99_mm_per_s);
  EXPECT_EQ(json.at("jitter").at("speed_mm_per_s_max").number(), as_run.max_mm_per_s);

  plant(scratch / "out/cloth.pc2");
  const JitterStatistics trembling = verify_directory(options.directory).jitter;
  RecordProperty("as_run_p99", std::to_string(as_run.p99_mm_per_s));
  EXPECT_NEAR(trembling.p50_mm_per_s, 30, as_run.p99_mm_per_s);  // 2 A fps
  EXPECT_GT(trembling.p99_mm_per_s, as_run.p99_mm_per_s + 10);
  std::printf("jitter p50, p99, max: %.1f %.1f %.1f mm/s; planted %.1f %.1f %.1f\n", as_run.p50_mm_per_s,
              as_run.p99_mm_per_s, as_run.max_mm_per_s, trembling.p50_mm_per_s, trembling.p99_mm_per_s,
              trembling.max_mm_per_s);
}

}  // namespace
}  // namespace toile::internal
