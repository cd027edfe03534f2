// Gathered seams: the mesh beside them, and its shape at rest.
#include "garment/gathers.hpp"

#include "assembly/cloth_model.hpp"
#include "garments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace toile::internal {
namespace {

constexpr double band_m = 0.2, drop_m = 0.16;

// A band above a sheet that is `ratio` times as wide; seam 0 joins them.
Pattern gathered(double ratio, bool back = false) {
  Pattern pattern;
  pattern.name = "gathered";
  const Vec3 above(0, 0.1, 0), below(0, -0.1, 0);
  pattern.panels = {back ? test::back_rectangle(band_m, 0.04, above) : test::front_rectangle(band_m, 0.04, above),
                    back ? test::back_rectangle(ratio * band_m, drop_m, below)
                         : test::front_rectangle(ratio * band_m, drop_m, below)};
  pattern.stitches = {test::stitch(0, 0, 1, 2)};
  return pattern;
}

double side(const std::array<Vec2, 3>& uv, std::size_t k) { return (uv[(k + 1) % 3] - uv[k]).norm(); }

// Of a corner of panel 1: how far below the seam.  u is the height.
double depth(const Vec2& uv) { return drop_m / 2 - uv.x(); }

class GathersOf : public ::testing::TestWithParam<double> {};

TEST_P(GathersOf, TakeTheShortSidesLengthsAtTheSeamAndLeaveTheClothAsDrawnBelow) {
  const double ratio = GetParam();
  for (const bool back : {false, true}) {
    const GarmentMesh garment = mesh_garment(gathered(ratio, back), 0.02);
    const ClothMesh& mesh = garment.mesh;
    ASSERT_EQ(mesh.gathered_uv.size(), mesh.uv.size());
    std::map<std::pair<Index, Index>, double> rest;  // triangles agree on their common edges
    int on_seam = 0, as_drawn = 0;
    for (std::size_t t = 0; t < mesh.uv.size(); ++t) {
      const auto &uv = mesh.uv[t], &to = mesh.gathered_uv[t];
      double nearest = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        const double length = side(to, k);
        const Index i = mesh.triangles[t][k], j = mesh.triangles[t][(k + 1) % 3];
        const auto other = rest.try_emplace(std::minmax(i, j), length).first;
        EXPECT_NEAR(length, other->second, 1e-12);
        if (mesh.panel[t] == 0) continue;
        nearest = std::min(nearest, depth(0.5 * (uv[k] + uv[(k + 1) % 3])));
        if (depth(uv[k]) > 1e-9 || depth(uv[(k + 1) % 3]) > 1e-9) continue;
        EXPECT_NEAR(length, side(uv, k) / ratio, 1e-9);
        ++on_seam;
      }
      if (mesh.panel[t] == 1 && nearest < gather_reach_m) continue;
      EXPECT_EQ(to, uv);  // the short side, and what is far from the seam
      ++as_drawn;
    }
    EXPECT_EQ(on_seam, static_cast<int>(std::ceil(ratio * band_m / gather_edge_m(0.02) - 1e-9)));
    EXPECT_GT(as_drawn, 100);
  }
}

TEST_P(GathersOf, KeepTheGrain) {
  const GarmentMesh garment = mesh_garment(gathered(GetParam()), 0.02);
  const ClothMesh& mesh = garment.mesh;
  double least = 1;
  for (std::size_t t = 0; t < mesh.uv.size(); ++t) {
    Mat2 drawn, rest;
    drawn << mesh.uv[t][1] - mesh.uv[t][0], mesh.uv[t][2] - mesh.uv[t][0];
    rest << mesh.gathered_uv[t][1] - mesh.gathered_uv[t][0], mesh.gathered_uv[t][2] - mesh.gathered_uv[t][0];
    const Mat2 stretch = rest * drawn.inverse();
    EXPECT_NEAR(stretch(0, 1), stretch(1, 0), 1e-9);  // no turn
    EXPECT_GT(stretch.determinant(), 0);
    EXPECT_LT(stretch.trace(), 2 + 0.1);
    least = std::min(least, stretch.determinant());
  }
  EXPECT_NEAR(least, 1 / GetParam(), 0.15 / GetParam());
}

INSTANTIATE_TEST_SUITE_P(UpToFive, GathersOf, ::testing::Values(1.5, 2.0, 3.0, 5.0));

TEST(Gathers, HaveFineTrianglesNearTheSeamOnly) {
  const ClothMesh mesh = mesh_garment(gathered(3), 0.02).mesh;
  double near_sum = 0, near = 0, far_sum = 0, far = 0;
  for (std::size_t t = 0; t < mesh.uv.size(); ++t) {
    if (mesh.panel[t] == 0) continue;
    const double d = depth((mesh.uv[t][0] + mesh.uv[t][1] + mesh.uv[t][2]) / 3), area = test::uv_area(mesh.uv[t]);
    if (d < 0.025) near_sum += area, ++near;
    if (d > 0.06) far_sum += area, ++far;
  }
  const double equilateral = std::sqrt(0.1875);      // of edge 1
  EXPECT_LT(near_sum / near, 0.45 * far_sum / far);  // smoothing spreads the finer lattice
  EXPECT_NEAR(far_sum / far, equilateral * 0.02 * 0.02, 0.1 * equilateral * 0.02 * 0.02);
}

TEST(Gathers, EaseIsNone) {
  const ClothMesh mesh = mesh_garment(gathered(1.12), 0.02).mesh;
  EXPECT_TRUE(mesh.gathered_uv.empty());
}

// Lies at rest in the shape that it is gathered to, and not as drawn; the mass is that of the cloth as cut.
TEST(Gathers, AModelRestsAsItIsGathered) {
  const Fabric cotton;
  const ClothMesh mesh = mesh_garment(gathered(3), 0.02).mesh;
  ClothModel model = build_model(mesh, {&cotton, 1});
  const double mass = std::accumulate(model.mass_kg.begin(), model.mass_kg.end(), 0.0);
  EXPECT_NEAR(mass, cotton.density_kg_per_m2 * (band_m * 0.04 + 3 * band_m * drop_m), 1e-9);
  for (const double share : {1.0, 0.4, 0.0}) {
    set_gathers(model, share);
    for (std::size_t t = 0; t < mesh.uv.size(); ++t) {
      const std::array<Vec2, 3> rest = model.rest_uv(t);
      std::array<Vec3, 3> x;
      for (std::size_t k = 0; k < 3; ++k) x[k] = Vec3(rest[k].x(), rest[k].y(), 0);
      const MembraneResponse at_rest = membrane_response(model.membrane[t], model.stiffness_of(t), x, {});
      EXPECT_NEAR(at_rest.energy_J, 0, 1e-18);
      EXPECT_EQ(model.membrane[t].scale2, material_frame(mesh.uv[t]).area_m2);
    }
  }
}

}  // namespace
}  // namespace toile::internal
