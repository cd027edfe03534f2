// Cloth under pressure, against closed forms.
#include "assembly/pressure.hpp"
#include "assembly/air.hpp"
#include "support/run_cloth.hpp"
#include "support/tubes.hpp"

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;

auto of_all(double Pa) {
  return [Pa](double, std::span<double> panel_Pa) { std::fill(panel_Pa.begin(), panel_Pa.end(), Pa); };
}

// A prism of `around` sides whose drawing is its surface unrolled, warp around it.
Sheet drawn_tube(double radius_m, double length_m, Index around, Index rows) {
  const test::Tube tube = test::tube(radius_m, 0, length_m, around, rows, false);
  Sheet sheet;
  sheet.x = tube.x;
  sheet.mesh.particle_count = static_cast<Index>(tube.x.size());
  sheet.mesh.triangles = tube.triangles;
  sheet.mesh.panel.assign(tube.triangles.size(), 0);
  sheet.mesh.panel_names = {"tube"};
  const double side_m = 2 * radius_m * std::sin(M_PI / around);
  for (const Triangle& t : tube.triangles) {
    std::array<Vec2, 3> uv;
    const bool wraps = std::any_of(t.begin(), t.end(), [&](Index i) { return i % around == around - 1; });
    for (std::size_t c = 0; c < 3; ++c) {
      const Index k = t[c] % around == 0 && wraps ? around : t[c] % around;
      uv[c] = Vec2(-side_m * k, tube.x[at(t[c])].y());  // seen from outside the angle runs to the left
    }
    sheet.mesh.uv.push_back(uv);
  }
  return sheet;
}

// The thread around carries T = p r: k (l - 1) = p R l cos(pi/n) of a prism that was R wide and is l R.
TEST(Pressure, ATubeStretchesUntilItsThreadsCarryPTimesR) {
  const double radius_m = 0.1, k = 1000;
  const Index around = 40, rows = 8;
  Fabric fabric = test::linear_cotton();
  fabric.stretch_u_N_per_m = fabric.stretch_v_N_per_m = k;
  fabric.strain_limit = 0;
  for (const double Pa : {100.0, 1000.0}) {
    ClothRun run(drawn_tube(radius_m, 0.15, around, rows), fabric, test::weightless());
    run.add_force<Pressure>(of_all(Pa), std::size_t{1});
    run.add_force<Air>(AirOptions{});
    run.step.relinearisations = 6;
    for (Index i = 0; i < run.model.particle_count(); ++i) {
      if (i >= around && i < rows * around) continue;  // both rims keep their height
      run.pin(i);
      run.world.pins.back().constrained_directions = 1;
      run.world.pins.back().p = Vec3(0, 1, 0);
    }
    run.run(90);
    EXPECT_LT(run.fastest(), 1e-3) << Pa << " Pa";
    double mean = 0;
    for (Index i = 4 * around; i < 5 * around; ++i)
      mean += Vec3(run.state.x[at(i)].x(), 0, run.state.x[at(i)].z()).norm();
    const double l = mean / around / radius_m, pr = Pa * radius_m * std::cos(M_PI / around);
    EXPECT_NEAR((l - 1) / (k / (k - pr) - 1), 1, 0.01) << Pa << " Pa";
  }
}

TEST(Pressure, ASheetFloatsWhereItEqualsItsWeight) {
  Fabric fabric = test::linear_cotton();
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), fabric);
  run.add_force<Pressure>(of_all(fabric.density_kg_per_m2 * 9.81), std::size_t{1});
  run.run(30);
  for (std::size_t i = 0; i < run.state.x.size(); ++i)
    EXPECT_LT((run.state.x[i] - test::equilateral_sheet(0.2, 0.2, 0.02).x[i]).norm(), 1e-9);
}

TEST(Pressure, IsAskedForTheEndOfEveryStepAndActsThenAlone) {
  ClothRun run(test::equilateral_sheet(0.1, 0.1, 0.02), test::linear_cotton(), test::weightless());
  std::vector<double> asked;
  run.add_force<Pressure>(
      [&](double end_s, std::span<double> panel_Pa) {
        asked.push_back(end_s);
        panel_Pa[0] = end_s > 0.1 + 1e-9 ? 2 : 0;
      },
      std::size_t{1});
  run.run(3);
  EXPECT_LT(run.fastest(), 1e-12);
  run.frame();
  EXPECT_NEAR(run.state.v[0].y(), 2 / Fabric{}.density_kg_per_m2 / 30, 1e-3);
  ASSERT_EQ(asked.size(), 4u);
  for (std::size_t k = 0; k < asked.size(); ++k) EXPECT_NEAR(asked[k], static_cast<double>(k + 1) / 30, 1e-12);
}

// A closed bag of threads that hardly stretch, filled in one step of 1/30 s: it is explicit, and yet takes no short steps for long.
TEST(Pressure, ABagThatIsFilledAtOnceComesToRest) {
  Fabric fabric;
  fabric.strain_limit = 0;
  ClothRun run(drawn_tube(0.1, 0.3, 24, 16), fabric, test::weightless());
  run.add_force<Air>(AirOptions{});
  run.add_force<Pressure>(of_all(2000), std::size_t{1});
  run.step.relinearisations = 6;
  for (Index i = 0; i < run.model.particle_count(); ++i)
    if (i < 24 || i >= 16 * 24) run.pin(i);
  for (Vec3& p : run.state.x) p.z() *= 0.3;
  int steps = 0;
  for (int f = 0; f < 60; ++f) {
    const FrameReport report = run.frame();
    if (f >= 30) steps += report.steps + report.rejected;
  }
  EXPECT_LT(run.fastest(), 5e-3);
  EXPECT_LE(steps, 33);
  double widest = 0;
  for (const Vec3& p : run.state.x) widest = std::max(widest, std::abs(p.z()));
  EXPECT_GT(widest, 0.08) << "and is full";
}

}  // namespace
}  // namespace toile::internal
