// Three layers in one seam: three stitches of one edge.
#include "garment/pleats.hpp"

#include "garment/pattern_check.hpp"
#include "garments.hpp"
#include "mesh/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

namespace toile::internal {
namespace {

constexpr double layer_m = 0.09;

// A band of one layer's width above a sheet of three: a, b, c from the left are edges 5, 4, 3 of the sheet.
Pattern pleated() {
  Pattern pattern;
  pattern.name = "pleated";
  const double w = 1.5 * layer_m, l = 0.5 * layer_m;
  Panel sheet = test::straight_panel(
      "sheet", {{-w, -0.2}, {-l, -0.2}, {l, -0.2}, {w, -0.2}, {w, 0}, {l, 0}, {-l, 0}, {-w, 0}}, {0, 0, 0});
  for (const auto& [from, to, angle] : {std::tuple(1, 6, 2.5), std::tuple(2, 5, -2.5)}) {
    PanelFold fold;
    fold.line.start = from;
    fold.line.end = to;
    fold.angle_rad = angle;
    sheet.folds.push_back(fold);
  }
  pattern.panels = {test::front_rectangle(layer_m, 0.04, {0, 0.05, 0}), sheet};
  pattern.stitches = {test::stitch(0, 0, 1, 6), test::stitch(0, 0, 1, 5, true), test::stitch(0, 0, 1, 4)};
  return pattern;
}

TEST(Pleats, ThreeStitchesOfAnEdgeAreAPleatAndTwoAreNot) {
  Pattern pattern = pleated();
  EXPECT_TRUE(find_faults(pattern).empty());
  const auto pleat = pleat_of(pattern, {0, 1, 2});
  ASSERT_TRUE(pleat);
  EXPECT_EQ(pleat->over, 0U);
  EXPECT_EQ(pleat->under, 1U);
  EXPECT_EQ(pleat->inner, 2U);
  EXPECT_EQ(pleat->tip, 5);       // between b and c
  EXPECT_EQ(pleat->band_end, 0);  // the band's left
  std::swap(pattern.stitches[0], pattern.stitches[2]);
  EXPECT_TRUE(find_faults(pattern).empty()) << "in any order";
  std::swap(pattern.stitches[0], pattern.stitches[2]);
  pattern.stitches[1].right_wrong = false;
  EXPECT_FALSE(find_faults(pattern).empty()) << "the layer between must be turned";
  pattern.stitches.pop_back();
  EXPECT_FALSE(find_faults(pattern).empty());
}

TEST(Pleats, AreLaidAndWeldedToASurface) {
  for (const double resolution_m : {0.12, 0.02, 0.009}) {  // coarser than the layer, too
    const Pattern pattern = pleated();
    const GarmentMesh garment = mesh_garment(pattern, resolution_m);
    EXPECT_TRUE(garment.pleated);
    EXPECT_EQ(garment.seams.size(), 2U);  // a to the band, b to c
    double left = 1, right = -1, front = -1, back = 1;
    for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
      const Triangle& corners = garment.mesh.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {  // nothing is stretched
        const std::size_t next = (k + 1) % 3;
        EXPECT_NEAR((garment.x[at(corners[next])] - garment.x[at(corners[k])]).norm(),
                    (garment.mesh.uv[t][next] - garment.mesh.uv[t][k]).norm(), 1e-12);
        if (garment.mesh.panel[t] == 0) continue;
        const Vec3& x = garment.x[at(corners[k])];
        left = std::min(left, x.x()), right = std::max(right, x.x());
        front = std::max(front, x.z()), back = std::min(back, x.z());
      }
    }
    EXPECT_LT(right - left, 1.1 * layer_m);
    EXPECT_LT(front - back, 0.5 * layer_m);
    const WeldedMesh welded = weld(garment);
    EXPECT_NO_THROW(build_topology(welded.mesh.particle_count, welded.mesh.triangles)) << resolution_m;
    // The tip, at the band's left corner: of all that is welded there, one particle each of the band, a, and the tip.
    std::vector<int> size(garment.x.size(), 0);
    for (const Index root : garment.merged) ++size[at(root)];
    EXPECT_EQ(std::count(size.begin(), size.end(), 3), 2);  // at the right the band, the end of a, and that of c
  }
}

}  // namespace
}  // namespace toile::internal
