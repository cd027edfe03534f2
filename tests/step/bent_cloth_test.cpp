// Cloth in motion that remembers its bends (assembly/bend_memory.hpp).
#include "support/run_cloth.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

// A strip that was held rolled up is let go.  Its threads have slipped by S_f = 30 - kappa_y, and it comes to rest at D_f/(D + D_f) S_f; without
// friction it straightens, and later.
TEST(BentCloth, AStripStaysBentWhereOneWithoutFrictionStraightens) {
  constexpr double rolled_per_m = 30, held_m = 0.01, slip_per_m = 20;
  const auto left_per_m = [&](double friction_N, int frames) {
    Fabric fabric = test::linear_cotton();
    fabric.bend_friction_N = friction_N;
    fabric.bend_friction_curvature_per_m = slip_per_m;
    ModelOptions slowed = test::weightless();
    slowed.drag_per_s = 4;
    const test::Sheet sheet = test::equilateral_sheet(0.04, 0.12, 0.01);
    test::ClothRun run(sheet, fabric, slowed);
    run.step.rows.cloth_cloth = false;
    std::size_t tip = 0, before = 0;
    for (std::size_t i = 0; i < sheet.x.size(); ++i) {
      const double s = std::max(0.0, -sheet.x[i].z() - held_m);
      run.pin(static_cast<Index>(i));
      if (s > 0) {
        run.state.x[i] = Vec3(sheet.x[i].x(), (1 - std::cos(rolled_per_m * s)) / rolled_per_m,
                              -held_m - std::sin(rolled_per_m * s) / rolled_per_m);
      }
      if (sheet.x[i].x() > 0.001) continue;  // along one edge
      if (sheet.x[i].z() < sheet.x[tip].z()) {
        before = tip;
        tip = i;
      }
    }
    run.run(1);  // threads slip
    std::erase_if(run.world.pins, [&](const Pin& pin) { return -sheet.x[at(pin.particle)].z() > held_m; });
    run.run(frames);
    EXPECT_LT(run.fastest(), 1e-4);
    const Vec3 end = run.state.x[tip] - run.state.x[before];
    const double turned_m = -0.5 * (sheet.x[tip].z() + sheet.x[before].z()) - held_m;
    return std::atan2(end.y(), -end.z()) / turned_m;
  };
  const double B = test::linear_cotton().bend_u_N_m, D_f = 6e-4 / slip_per_m;
  EXPECT_NEAR(left_per_m(6e-4, 240), D_f / (B + D_f) * (rolled_per_m - slip_per_m), 0.3);
  EXPECT_NEAR(left_per_m(0, 480), 0, 0.1);
}

}  // namespace
}  // namespace toile::internal
