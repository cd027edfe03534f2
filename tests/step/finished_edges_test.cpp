// A strip that hangs by its finished edges.
#include "material/edge_finish.hpp"
#include "support/finished_sides.hpp"
#include "support/settle.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

constexpr double tape_m = 0.01;

// A strip of 30 by 4 cm that hangs from its short side.  Elongation by its own weight: mu g L^2 / (2 EA), with both long sides taped
//   EA = E w + 2 tape,   mu = rho w + 2 (tape's mass per metre)
double elongation(double grain_deg, bool taped) {
  constexpr double length = 0.3, width = 0.04, edge = 0.01, gravity = 40;
  test::Sheet sheet = test::equilateral_sheet(length, width, edge);
  if (taped) test::finish_sides(sheet, width, {0, 0, 0, tape_m}, true);
  const Mat2 turn = Eigen::Rotation2Dd(grain_deg * 3.14159265358979323846 / 180).toRotationMatrix();
  for (auto& uv : sheet.mesh.uv)
    for (Vec2& corner : uv) corner = turn * corner;
  ModelOptions options;
  options.gravity_m_per_s2 = {gravity, 0, 0};
  test::ClothRun run(sheet, Fabric(), options);
  for (std::size_t i = 0; i < sheet.x.size(); ++i)
    if (sheet.x[i].x() < 1e-12) run.pin(static_cast<Index>(i));
  test::settle(run, 0.1, 1e-5, 5, 400);
  double end = 0;
  for (const Vec3& x : run.state.x) end = std::max(end, x.x());
  return end - length;
}

TEST(FinishedEdges, AStripOnTheGrainHangsByClothAndTape) {
  const Fabric fabric;
  constexpr double length = 0.3, width = 0.04, gravity = 40;
  const LineStiffness tape = line_stiffness(fabric, {1, 0}, {0, tape_m});
  const double plain =
      fabric.density_kg_per_m2 * width * gravity * length * length / (2 * fabric.stretch_u_N_per_m * width);
  const double taped = (fabric.density_kg_per_m2 * width + 2 * tape.mass_kg_per_m) * gravity * length * length /
                       (2 * (fabric.stretch_u_N_per_m * width + 2 * tape.stretch_N));
  EXPECT_NEAR(elongation(0, false), plain, 0.02 * plain);
  EXPECT_NEAR(elongation(0, true), taped, 0.02 * taped);
}

TEST(FinishedEdges, ATapeHoldsAStripOnTheBias) {
  const double plain = elongation(45, false), taped = elongation(45, true);
  EXPECT_GT(plain, 5 * taped) << plain << " and " << taped << " m";
}

}  // namespace
}  // namespace toile::internal
