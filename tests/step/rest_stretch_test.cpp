// b_u and b_v changed while the cloth moves: a panel that shrinks, wrinkles its neighbours, and comes back.      [BW98 4.2]
#include "core/error.hpp"
#include "support/run_cloth.hpp"

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;

ModelOptions weightless() {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  return options;
}

TEST(RestStretch, AFreePanelTakesItsNewWidthInTheMidstOfARun) {
  Fabric fabric;
  fabric.compression_ratio = 1;  // it pushes itself wide again
  ClothRun run(test::equilateral_sheet(0.2, 0.2, 0.02), fabric, weightless());
  run.step.rows.cloth_cloth = false;
  const auto size = [&] {
    Vec3 low = run.state.x[0], high = low;
    for (const Vec3& p : run.state.x) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    return Vec3(high - low);
  };
  run.run(5);
  EXPECT_NEAR(size().x(), 0.2, 1e-9);
  set_panel_rest_stretch(run.model, 0, Vec2(0.8, 1));
  run.run(60);
  EXPECT_NEAR(size().x(), 0.16, 1e-4);
  EXPECT_NEAR(size().z(), 0.2, 1e-4);
  set_panel_rest_stretch(run.model, 0, Vec2(1, 1.1));
  run.run(60);
  EXPECT_NEAR(size().x(), 0.2, 1e-4);
  EXPECT_NEAR(size().z(), 0.22, 1e-4);
}

// A band across a sheet, the band its own panel.
Sheet banded() {
  Sheet sheet = test::equilateral_sheet(0.3, 0.2, 0.0125);
  test::add_panel(sheet, "band", [](const Vec2& uv) { return std::abs(uv.y() - 0.1) < 0.02; });
  return sheet;
}

TEST(RestStretch, ABandThatShrinksWrinklesTheClothBesideIt) {
  ClothRun run(banded(), fabric_preset("silk", "", ""), weightless());
  run.state.x = test::crumpled(run.state.x, 1e-4, 4);
  run.run(10);
  const auto depth = [&] {
    double low = 1, high = -1;
    for (const Vec3& p : run.state.x) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    return high - low;
  };
  const auto mean_stretch = [&](Index panel) {
    Elements elements(run.model);
    std::vector<Vec2> w(run.model.mesh.triangles.size());
    elements.stretch(run.state.x, w);
    double sum = 0, count = 0;
    for (std::size_t t = 0; t < w.size(); ++t) {
      if (run.model.mesh.panel[t] != panel) continue;
      sum += w[t].x();
      ++count;
    }
    return sum / count;
  };
  EXPECT_LT(depth(), 1e-3);
  for (int f = 1; f <= 30; ++f) {  // gathered within a second
    set_panel_rest_stretch(run.model, 1, Vec2(1 - 0.4 * f / 30, 1));
    run.frame();
  }
  run.run(60);
  std::printf("band %.3f, cloth %.3f of its width; wrinkles %.1f mm deep\n", mean_stretch(1), mean_stretch(0),
              1e3 * depth());
  EXPECT_NEAR(mean_stretch(1), 0.6, 0.07);  // the band has its length, nearly
  EXPECT_GT(mean_stretch(0), 0.95);         // the cloth keeps its own, and goes into folds
  EXPECT_GT(depth(), 0.01);
  for (Index t = 0; t < static_cast<Index>(run.model.membrane.size()); ++t) set_rest_stretch(run.model, t, Vec2(1, 1));
  run.run(120);
  EXPECT_NEAR(mean_stretch(1), 1, 0.01);
  EXPECT_LT(run.fastest(), 0.05);
}

TEST(RestStretch, ContactDistancesFollow) {
  // 0.45 of the shortest rest edge: 3.6 mm of edges of 8 mm, more than the thickness; 1.8 once they have shrunk to half.
  ClothRun run(test::equilateral_sheet(0.08, 0.08 * std::sqrt(0.75), 0.008), Fabric{}, weightless());
  run.start();
  ContactRows& rows = run.stepper->integrator().contact_rows();
  const std::size_t inner = run.state.x.size() / 2;
  EXPECT_DOUBLE_EQ(rows.contact_m()[inner], Fabric{}.thickness_m);
  set_panel_rest_stretch(run.model, 0, Vec2(0.5, 0.5));
  run.frame(1e-4);
  EXPECT_NEAR(rows.contact_m()[inner], 0.45 * 0.004, 1e-12);
  const std::vector<double> half(run.state.x.size(), 0.5);
  rows.set_thickness_scale(half);
  set_panel_rest_stretch(run.model, 0, Vec2(1, 1));
  run.frame(1e-4);
  EXPECT_DOUBLE_EQ(rows.contact_m()[inner], 0.5 * Fabric{}.thickness_m);  // and keep their scale
}

TEST(RestStretch, NonsenseIsRefused) {
  ClothRun run(test::equilateral_sheet(0.1, 0.1, 0.02), Fabric{});
  EXPECT_THROW(set_panel_rest_stretch(run.model, 1, Vec2(1, 1)), InputError);
  EXPECT_THROW(set_rest_stretch(run.model, 100000, Vec2(1, 1)), InputError);
  EXPECT_THROW(set_rest_stretch(run.model, -1, Vec2(1, 1)), InputError);
  EXPECT_THROW(set_rest_stretch(run.model, 0, Vec2(0, 1)), InputError);
  EXPECT_THROW(set_panel_rest_stretch(run.model, 0, Vec2(1, std::numeric_limits<double>::quiet_NaN())), InputError);
}

}  // namespace
}  // namespace toile::internal
