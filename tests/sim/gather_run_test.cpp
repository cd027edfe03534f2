// A skirt that is gathered into a band, sewn and worn: neither the band nor the cloth beside the seam gets too long.
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"

#include <fmt/printf.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace toile {
namespace {

constexpr double most = 0.03;
constexpr double band_cm = 36;

// Front and back of a band of 4 cm and of a skirt of 25 cm, `ratio` times as wide; seams 4 and 5 gather.
std::string pattern(double ratio) {
  const auto panel = [](const char* name, double width, double height, double y, bool back) {
    const double w = width / 2, z = back ? -17 : 17;
    const std::string outline = back ? fmt::sprintf("[[%g,0],[%g,%g],[%g,%g],[%g,0]]", -w, -w, height, w, height, w)
                                     : fmt::sprintf("[[%g,0],[%g,0],[%g,%g],[%g,%g]]", -w, w, w, height, -w, height);
    return fmt::sprintf(R"("%s": {"translation": [0, %g, %g], "rotation": [0, 0, 0], "vertices": %s,
      "edges": [{"endpoints": [0,1]}, {"endpoints": [1,2]}, {"endpoints": [2,3]}, {"endpoints": [3,0]}]})",
                        name, y, z, outline);
  };
  const auto stitch = [](const char* a, int edge_a, const char* b, int edge_b) {
    return fmt::sprintf(R"([{"panel": "%s", "edge": %d}, {"panel": "%s", "edge": %d}])", a, edge_a, b, edge_b);
  };
  return R"({"pattern": {"panels": {)" + panel("band_f", band_cm, 4, 88, false) + "," +
         panel("band_b", band_cm, 4, 88, true) + "," + panel("skirt_f", ratio * band_cm, 25, 60, false) + "," +
         panel("skirt_b", ratio * band_cm, 25, 60, true) + R"(}, "stitches": [)" + stitch("band_f", 1, "band_b", 2) +
         "," + stitch("band_f", 3, "band_b", 0) + "," + stitch("skirt_f", 1, "skirt_b", 2) + "," +
         stitch("skirt_f", 3, "skirt_b", 0) + "," + stitch("band_f", 0, "skirt_f", 2) + "," +
         stitch("band_b", 3, "skirt_b", 1) + R"(]}, "properties": {"units_in_meter": 100}})";
}

// Worn by a dress form for two and a half seconds.
void expect_worn(double ratio, double resolution_cm) {
  const Scratch scratch;
  scratch.put("p.json", pattern(ratio));
  const Scene scene = parse_scene(fmt::sprintf(R"({"cloth": [{"pattern": "p.json", "resolution_cm": %g}],
    "solids": [{"revolved": {"profile_m": [[0, 0.2], [0.14, 0.2], [0.15, 0.25], [0.15, 0.7], [0.112, 0.88], [0.1, 0.94],
      [0.1, 1.1], [0, 1.1]]}, "edge_m": 0.015}],
    "time": {"seconds": 2.5, "until_still": false}})",
                                               resolution_cm),
                                  scratch / "s.json");
  RunOptions options;
  options.directory = scratch / "out";
  options.command = "test";
  const Report report = simulate(scene, options);
  const std::string what = fmt::sprintf("%g:1 at %g cm", ratio, resolution_cm);
  EXPECT_TRUE(report.verdict.pass) << what << ": " << report.ended;

  Hash unused;
  const GarmentMesh garment = load_cloth(scene, scene.cloth.front(), read_text_file, unused).garment;
  const WeldedMesh welded = weld(garment);
  Pc2Reader frames(scratch / "out/cloth.pc2");
  Vec3s x;
  frames.read(frames.samples() - 1, x);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  for (const Index seam : {4, 5}) {  // pairs of a seam follow each other, the band's side first
    double drawn = 0, worn = 0;
    for (std::size_t k = 0; k + 1 < garment.pairs.size(); ++k) {
      if (garment.pairs[k].seam != seam || garment.pairs[k + 1].seam != seam) continue;
      const Index i = garment.pairs[k].a, j = garment.pairs[k + 1].a;
      drawn += (garment.x[at(j)] - garment.x[at(i)]).norm();
      worn += (x[at(welded.particle_of[at(j)])] - x[at(welded.particle_of[at(i)])]).norm();
    }
    EXPECT_NEAR(drawn, band_cm / 100, 1e-9);
    EXPECT_LE(worn / drawn - 1, most) << what;
    EXPECT_GE(worn / drawn - 1, -most) << what;
  }
  EXPECT_LE(report.audit.stretch.p99, most) << what;
  EXPECT_LE(report.audit.stretch.triangle_p99, most) << what;
}

TEST(GatherRun, TwoToOne) { expect_worn(2, 2); }
TEST(GatherRun, ThreeToOne) { expect_worn(3, 2); }

TEST(GatherRunLong, UpToFiveToOneOnThreeMeshes) {
  for (const double ratio : {1.1, 1.5, 2.0, 3.0, 5.0})
    for (const double resolution_cm : {2.0, 1.5, 1.0}) expect_worn(ratio, resolution_cm);
}

}  // namespace
}  // namespace toile
