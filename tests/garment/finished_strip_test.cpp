// Strips with finished edges bend as the sum of cloth and lines says, on the triangles that garments are made of.
#include "material/edge_finish.hpp"
#include "support/strip_rigidity.hpp"
#include "support/turned_strip.hpp"

namespace toile::internal {
namespace {

constexpr double length_m = 0.2, width_m = 0.02;

// Both long sides.
void tape(ClothMesh& mesh, double tape_m) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = mesh.uv[t][k].y(), b = mesh.uv[t][(k + 1) % 3].y();
      const auto on = [&](double v) { return std::abs(a - v) < 1e-9 && std::abs(b - v) < 1e-9; };
      if (on(0) || on(width_m))
        mesh.finished.push_back({mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3], 0, tape_m});
    }
}

// How much farther the strip sags, held at one end, than one of cloth as stiff as both lines and the cloth, under the same load.
double too_far(double edge_m, double turn, double tape_m) {
  Fabric fabric = test::elastic_cotton();
  fabric.bend_poisson = 0;  // a strip's rigidity is then D, however wide it is
  ClothMesh strip = test::turned_strip(length_m, width_m, edge_m, turn);
  const double lines_N_m2 = 2 * line_stiffness(fabric, {1, 0}, {0, tape_m}).bend_N_m2;
  Fabric stiff = fabric;
  stiff.bend_u_N_m = stiff.bend_v_N_m = fabric.bend_u_N_m + lines_N_m2 / width_m;
  const ClothModel same = build_model(strip, {&stiff, 1});
  tape(strip, tape_m);
  ClothModel taped = build_model(strip, {&fabric, 1});
  taped.mass_kg = same.mass_kg;
  const auto sag = [&](const ClothModel& model) {
    return test::end_deflection(model, test::StripAlong::u, length_m, 1.01 * edge_m);
  };
  return sag(taped) / sag(same) - 1;
}

// Spread over the triangles that have a side on the line, the tapes would let it sag 76 to 124 % too far.
TEST(FinishedStrip, BendsByClothAndTapesHoweverTheTrianglesLie) {
  for (const double turn : {0.0, 0.26, 0.5}) {
    for (const double tape : {0.01, 0.3}) {  // lines twice and sixty times as stiff as the cloth between them
      EXPECT_NEAR(too_far(0.01, turn, tape), 0, 0.04) << turn << ", " << tape;
      EXPECT_NEAR(too_far(0.005, turn, tape), 0, 0.02) << turn << ", " << tape;
    }
  }
}

}  // namespace
}  // namespace toile::internal
