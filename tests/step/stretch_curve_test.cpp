// A strip that hangs from its upper edge under a heavy gravity: each cross section carries what hangs below it.
#include "support/settle.hpp"
#include "support/stiffening_thread.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

constexpr double length_m = 0.4, width_m = 0.1, gravity_m_per_s2 = 600;

// Of the whole strip, m: the integral of e over it.
double expected(const Fabric& fabric) {
  double sum = 0;
  constexpr int parts = 1000;
  for (int n = 0; n < parts; ++n) {
    const double below = length_m * (n + 0.5) / parts;
    sum += test::extension_at(fabric.density_kg_per_m2 * gravity_m_per_s2 * below, fabric.stretch_v_N_per_m,
                              fabric.doubling_strain_v) *
           length_m / parts;
  }
  return sum;
}

double hanging(const Fabric& fabric, double stiffened = 1) {
  ModelOptions options;
  options.gravity_m_per_s2 = Vec3(0, 0, -gravity_m_per_s2);
  const test::Sheet sheet = test::equilateral_sheet(width_m, length_m, 0.01);
  test::ClothRun run(sheet, fabric, options);
  run.start();
  set_stiffening(run.model, stiffened);
  double lowest = 0;
  for (std::size_t i = 0; i < sheet.x.size(); ++i)
    if (sheet.x[i].z() == 0) run.pin(static_cast<Index>(i));
  test::settle(run, 1.0 / 30, 1e-4, 10, 600);
  for (const Vec3& p : run.state.x) lowest = std::min(lowest, p.z());
  return -lowest - length_m;
}

TEST(StretchCurve, AHangingStripExtendsByTheCurveItHas) {
  Fabric fabric = test::linear_cotton();
  fabric.stretch_v_N_per_m = 800;
  const double straight = expected(fabric);
  EXPECT_NEAR(hanging(fabric), straight, 0.02 * straight);
  fabric.doubling_strain_v = 0.02;
  const double curved = expected(fabric);
  EXPECT_LT(curved, 0.7 * straight);
  EXPECT_NEAR(hanging(fabric), curved, 0.02 * curved);
}

// With a quarter of e^3 / d^2 it doubles at 2 d.
TEST(StretchCurve, AShareOfItIsAFlatterCurve) {
  Fabric fabric = test::linear_cotton();
  fabric.stretch_v_N_per_m = 800;
  fabric.doubling_strain_v = 0.02;
  const double quarter = hanging(fabric, 0.25), none = hanging(fabric, 0);
  fabric.doubling_strain_v = 0.04;
  EXPECT_NEAR(quarter, hanging(fabric), 1e-4 * quarter);
  fabric.doubling_strain_v = 0;
  EXPECT_NEAR(none, hanging(fabric), 1e-4 * none);
}

}  // namespace
}  // namespace toile::internal
