// A skirt that is gathered or pleated into a band, sewn and worn: neither the band nor the cloth beside the seam gets too long.
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"

#include <fmt/printf.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

constexpr double most_stretch = 0.03;
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
void expect_worn(const std::string& pattern_text, const std::string& what, double resolution_cm) {
  const Scratch scratch;
  scratch.put("p.json", pattern_text);
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
  EXPECT_TRUE(report.verdict.pass) << what << ": " << report.ended;

  const GarmentMesh garment = as_worn(load_cloth(scene, 0, read_text_file));
  const WeldedMesh welded = weld(garment);
  Pc2Reader frames(scratch / "out/cloth.pc2");
  Vec3s x;
  frames.read(frames.samples() - 1, x);
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  double drawn = 0, worn = 0;  // the band where the skirt is sewn to it
  for (std::size_t k = 0; k + 1 < garment.pairs.size(); ++k) {
    const SeamPair &here = garment.pairs[k], &next = garment.pairs[k + 1];
    if (here.seam != next.seam) continue;
    const std::string& seam = garment.seams[at(here.seam)].name;
    if (seam.rfind("band", 0) != 0 || seam.find("skirt") == std::string::npos) continue;
    const double piece = (garment.x[at(next.a)] - garment.x[at(here.a)]).norm();
    if (piece > 1.5 * resolution_cm / 100)
      continue;  // edges have up to sqrt(2); tips of pleats, at the end of the pairs: not along a seam
    drawn += piece;
    worn += (x[at(welded.particle_of[at(next.a)])] - x[at(welded.particle_of[at(here.a)])]).norm();
  }
  EXPECT_NEAR(drawn, 2 * band_cm / 100, 1e-9);
  EXPECT_LE(std::abs(worn / drawn - 1), most_stretch) << what;
  EXPECT_LE(report.audit.stretch.p99, most_stretch) << what;
  EXPECT_LE(report.audit.stretch.triangle_p99, most_stretch) << what;
}

// Three layers of 9 cm on every 9 cm of a band, as above: the skirt's upper edge is cut into 12 pieces.
std::string pleated_pattern() {
  constexpr int pleats = 4, layers = 3 * pleats;
  constexpr double layer_cm = band_cm / pleats;
  std::string panels, stitches, folds;
  const auto add = [](std::string& list, const std::string& entry) { list += (list.empty() ? "" : ",") + entry; };
  // Corners counter-clockwise from the lower left; those of a back panel the other way round.
  const auto panel = [&](const std::string& name, const std::vector<Vec2>& corners, double y, bool back) {
    const int count = static_cast<int>(corners.size());
    std::string vertices, edges;
    for (const Vec2& p : corners) add(vertices, fmt::sprintf("[%g,%g]", p.x(), p.y()));
    for (int e = 0; e < count; ++e) {
      const int k = back ? count - 1 - e : e, next = (k + 1) % count;
      add(edges, fmt::sprintf(R"({"endpoints": [%d,%d]})", back ? next : k, back ? k : next));
    }
    add(panels, fmt::sprintf(R"("%s": {"translation": [0, %g, %d], "rotation": [0, 0, 0], "vertices": [%s],
      "edges": [%s]})",
                             name, y, back ? -17 : 17, vertices, edges));
  };
  const auto stitch = [&](const std::string& a, int edge_a, const std::string& b, int edge_b,
                          bool right_wrong = false) {
    add(stitches, fmt::sprintf(R"([{"panel": "%s", "edge": %d}, {"panel": "%s", "edge": %d}%s])", a, edge_a, b, edge_b,
                               right_wrong ? R"(, "right_wrong")" : ""));
  };
  std::vector<Vec2> band, skirt;
  for (int k = 0; k <= pleats; ++k) band.emplace_back(k * layer_cm - band_cm / 2, 0);
  band.emplace_back(band_cm / 2, 4);
  band.emplace_back(-band_cm / 2, 4);
  for (int k = 0; k <= layers; ++k) skirt.emplace_back((k - layers / 2) * layer_cm, 0);
  for (int k = layers; k >= 0; --k) skirt.emplace_back((k - layers / 2) * layer_cm, 25);
  const int band_edges = static_cast<int>(band.size()), skirt_edges = static_cast<int>(skirt.size());
  std::string extension;
  for (const bool back : {false, true}) {
    const std::string side = back ? "_b" : "_f";
    panel("band" + side, band, 88, back);
    panel("skirt" + side, skirt, 60, back);
    const auto on_band = [&](int k) { return back ? band_edges - 1 - k : k; };
    const auto on_skirt = [&](int k) { return back ? skirt_edges - 1 - k : k; };
    folds.clear();
    for (int k = 0; k < pleats; ++k) {
      const auto top = [&](int layer) { return on_skirt(2 * layers - layer); };
      for (int layer = 0; layer < 3; ++layer)
        stitch("band" + side, on_band(k), "skirt" + side, top(3 * k + layer), layer == 1);
      for (int line = 1; line < 3; ++line)
        add(folds, fmt::sprintf(R"({"endpoints": [%d,%d], "angle_deg": %d})", 3 * k + line,
                                2 * layers + 1 - 3 * k - line, line == 1 ? 150 : -150));
    }
    add(extension, fmt::sprintf(R"("skirt%s": {"folds": [%s]})", side, folds));
  }
  stitch("band_f", pleats, "band_b", band_edges - 1 - pleats);
  stitch("band_f", pleats + 2, "band_b", band_edges - 3 - pleats);
  stitch("skirt_f", layers, "skirt_b", skirt_edges - 1 - layers);
  stitch("skirt_f", 2 * layers + 1, "skirt_b", skirt_edges - 2 - 2 * layers);
  return R"({"pattern": {"panels": {)" + panels + R"(}, "stitches": [)" + stitches +
         R"(]}, "properties": {"units_in_meter": 100}, "toile": {"panels": {)" + extension + "}}}";
}

void expect_gathered(double ratio, double resolution_cm) {
  expect_worn(pattern(ratio), fmt::sprintf("%g:1 at %g cm", ratio, resolution_cm), resolution_cm);
}

TEST(GatherRun, TwoToOne) { expect_gathered(2, 2); }
TEST(GatherRun, ThreeToOne) { expect_gathered(3, 2); }
TEST(PleatRun, ThreeLayersInOneSeam) { expect_worn(pleated_pattern(), "pleats", 2); }

TEST(PleatRunLong, ThreeLayersInOneSeamOnFineMeshes) {
  for (const double resolution_cm : {1.5, 1.0}) expect_worn(pleated_pattern(), "pleats", resolution_cm);
}

TEST(GatherRunLong, UpToFiveToOneOnThreeMeshes) {
  for (const double ratio : {1.1, 1.5, 2.0, 3.0, 5.0})
    for (const double resolution_cm : {2.0, 1.5, 1.0}) expect_gathered(ratio, resolution_cm);
}

}  // namespace
}  // namespace toile::internal
