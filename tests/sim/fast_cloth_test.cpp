// Cloth may be as fast as what drives it: no speed is an error of its own.
#include "io/scratch.hpp"
#include "sim/simulate.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

Report run_fast(const std::string& scene) {
  const Scratch scratch;
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  return simulate(parse_scene(scene, "s.json"), options);
}

// A wind of 70 m/s throws silk of 70 g/m2 forward at 40,000 m/s2; what snaps tight moves faster than the wind.
TEST(FastCloth, AGaleStretchesSilkAndEndsNoRun) {
  const Report report = run_fast(R"({
    "cloth": [{"grid": {"width_m": 1, "height_m": 0.6, "edge_m": 0.06}, "fabric": "silk",
               "pins": [{"near_m": [-0.5, 0.3, 0]}, {"near_m": [0.5, 0.3, 0]}]}],
    "world": {"wind_m_per_s": [3, 0, 70]}, "time": {"fps": 30, "seconds": 0.4}})");
  EXPECT_EQ(report.ended, "time");
  EXPECT_EQ(report.frames, 12);
}

// Twelve seconds without air are 118 m/s and 706 m.
TEST(FastCloth, FallsWithoutAirForAsLongAsAsked) {
  const Report report = run_fast(R"({
    "cloth": [{"grid": {"width_m": 0.1, "height_m": 0.1, "edge_m": 0.05}}],
    "world": {"air_density_kg_per_m3": 0}, "time": {"fps": 10, "seconds": 12, "until_still": false}})");
  EXPECT_EQ(report.ended, "time");
  EXPECT_EQ(report.frames, 120);
}

}  // namespace
}  // namespace toile::internal
