// Cloth at rest in its own plane against closed forms: a hanging strip and pure shear.
#include "support/run_cloth.hpp"
#include "validation/figures.hpp"

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;

// Turned so that v runs down: hangs from its edge v = 0.
Sheet hanging_strip(double width, double length, double edge) {
  Sheet sheet = test::equilateral_sheet(width, length, edge);
  for (Vec3& p : sheet.x) p = Vec3(p.x(), p.z(), 0);  // z = -v
  return sheet;
}

double tip_elongation(double edge, bool paper_scaling, double stiffness) {
  Fabric fabric = test::elastic_cotton();
  fabric.density_kg_per_m2 = 0.15;
  fabric.stretch_u_N_per_m = fabric.stretch_v_N_per_m = stiffness;
  fabric.shear_N_per_m = 0;  // one-dimensional: no Poisson-like coupling at the clamp
  ModelOptions options;
  options.paper_scaling = paper_scaling;
  const Sheet sheet = hanging_strip(0.2, 1, edge);
  ClothRun run(sheet, fabric, options);
  run.step.rows.cloth_cloth = false;
  run.step.pcg.tolerance = 1e-4;
  for (std::size_t i = 0; i < sheet.x.size(); ++i) {
    if (sheet.x[i].y() > -1e-9) run.pin(static_cast<Index>(i));
  }
  run.run(40);
  double tip = 0;
  int count = 0;
  for (std::size_t i = 0; i < sheet.x.size(); ++i) {
    if (sheet.x[i].y() < -1 + 1e-9) {
      tip += -1 - run.state.x[i].y();
      ++count;
    }
  }
  EXPECT_LT(run.fastest(), 1e-4);
  return tip / count;
}

TEST(HangingStrip, TipElongationIsRhoGLSquaredOverTwoKAtEveryResolution) {
  const double exact = 0.15 * 9.81 / (2 * 3000.0);
  double error[3];
  int k = 0;
  test::Figures figures("hanging_strip");
  for (const double edge : {0.1, 0.05, 0.025}) {
    const double measured = tip_elongation(edge, false, 3000);
    char mesh[48];
    std::snprintf(mesh, sizeof mesh, "equilateral %g mm", 1e3 * edge);
    figures.add("tip", mesh, "elongation mm", 1e3 * exact, 1e3 * measured);
    error[k++] = std::abs(measured / exact - 1);
  }
  EXPECT_LT(error[0], 0.02);
  EXPECT_LT(error[1], 0.01);
  EXPECT_LT(error[2], 0.005);
}

TEST(HangingStrip, ThePapersScalingSoftensFourTimesPerRefinement) {
  // With C = area * (...), k is per area: 3000 N/m at the coarser mesh's triangle area.
  const double area = 0.05 * 0.05 * std::sqrt(3.0) / 4;
  const double coarse = tip_elongation(0.05, true, 3000 / area), fine = tip_elongation(0.025, true, 3000 / area);
  EXPECT_NEAR(fine / coarse, 4, 0.4);
}

TEST(PureShear, ForcePerWidthFollowsFromTheEnergy) {
  // w_u = (1, 0), w_v = (sin phi, cos phi): E/A = k/2 sin^2 phi, so the couple per area is dE/dphi = k sin phi cos phi; the
  // force on the top edge along u, per width, is k sin phi (P_v . u), with |w_v| = 1.
  Fabric fabric = test::elastic_cotton();
  const double phi = 0.3;
  Sheet sheet = test::equilateral_sheet(0.1, 0.1, 0.02);
  ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  ClothState state{sheet.x, Vec3s(sheet.x.size(), Vec3::Zero())};
  std::vector<bool> top(sheet.x.size());
  for (std::size_t i = 0; i < sheet.x.size(); ++i) {
    const double v = -sheet.x[i].z();
    top[i] = v > 0.1 - 1e-9;
    state.x[i] = Vec3(sheet.x[i].x() + v * std::sin(phi), 0, -v * std::cos(phi));
  }
  Elements elements(model);
  elements.evaluate(model, state);
  Vec3s f(state.x.size());
  elements.forces(f);
  double along_u = 0;
  for (std::size_t i = 0; i < f.size(); ++i) along_u += top[i] ? f[i].x() : 0;
  // Corner particles of the top edge also carry the side edges' traction: k sin phi w_v . u over half an edge on either side cancels.
  test::Figures figures("pure_shear");
  figures.add("phi 0.3", "equilateral 20 mm", "force per width N/m", fabric.shear_N_per_m * std::sin(phi),
              -along_u / 0.1);
  figures.add("phi 0.3", "equilateral 20 mm", "energy mJ", 5 * fabric.shear_N_per_m * std::sin(phi) * std::sin(phi),
              1e3 * elements.energy_J());
  EXPECT_NEAR(-along_u / 0.1, fabric.shear_N_per_m * std::sin(phi), 0.02 * fabric.shear_N_per_m * std::sin(phi));
  EXPECT_NEAR(elements.energy_J(), 0.5 * fabric.shear_N_per_m * std::sin(phi) * std::sin(phi) * 0.01, 1e-12);
}

}  // namespace
}  // namespace toile::internal
