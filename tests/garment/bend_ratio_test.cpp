// Warp and weft bend as asked for, on the meshes that garments are made of.
#include "support/sheets.hpp"
#include "support/strip_rigidity.hpp"
#include "support/turned_strip.hpp"

namespace toile::internal {
namespace {

using test::realised_rigidity;
using test::StripAlong;
using test::turned_strip;

struct Realised {
  double u, v;  // over what was asked for
};

// Strips of 20 x 8 cm cut along both threads from sheets whose triangles lie as `strip(u_m, v_m, edge_m)` lays them.
template <class Strip>
Realised realised(const Strip& strip, double D_u, double D_v) {
  constexpr double length_m = 0.2, width_m = 0.08, edge_m = 0.01, held_m = 0.0101;
  const ClothMesh along_u = strip(length_m, width_m, edge_m), along_v = strip(width_m, length_m, edge_m);
  return {realised_rigidity(along_u, StripAlong::u, length_m, held_m, D_u, D_v) / D_u,
          realised_rigidity(along_v, StripAlong::v, length_m, held_m, D_u, D_v) / D_v};
}

void expect_ratio(double ratio, double tolerance) {
  for (const bool stiff_weft : {false, true}) {
    const double D_u = stiff_weft ? 1e-5 : ratio * 1e-5, D_v = stiff_weft ? ratio * 1e-5 : 1e-5;
    const auto expect = [&](const Realised& r) {
      EXPECT_NEAR(r.u, 1, tolerance) << D_u << " : " << D_v;
      EXPECT_NEAR(r.v, 1, tolerance) << D_u << " : " << D_v;
    };
    expect(
        realised([](double u, double v, double edge) { return test::equilateral_sheet(u, v, edge).mesh; }, D_u, D_v));
    for (const double turn : {0.0, 0.26, 0.5, 0.8}) {
      expect(realised([turn](double u, double v, double edge) { return turned_strip(u, v, edge, turn); }, D_u, D_v));
    }
  }
}

TEST(BendRatio, IsRealisedAlongBothThreadsHoweverTheTrianglesLie) {
  expect_ratio(1, 1e-9);
  expect_ratio(2, 0.10);
  expect_ratio(5, 0.10);
}

TEST(BendRatio, OfTenToOneIsRealisedWithinAFifth) { expect_ratio(10, 0.20); }

}  // namespace
}  // namespace toile::internal
