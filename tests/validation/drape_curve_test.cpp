// The drape coefficient over the bending length: how src/material/drape_curve.cpp was made, and how well it is known.
#include "material/drape_curve.hpp"
#include "material/laboratory_units.hpp"
#include "support/fabrics.hpp"
#include "validation/drape_run.hpp"
#include "validation/figures.hpp"

namespace toile::internal {
namespace {

using test::Drape;
using test::drape;
using test::Figures;

Fabric cloth_of(double bending_length_m, double weight_kg_per_m2 = 0.15, double shear_N_per_m = 60,
                double stretch = 1) {
  Fabric cloth = test::elastic_cotton();
  cloth.density_kg_per_m2 = weight_kg_per_m2;
  cloth.shear_N_per_m = shear_N_per_m;
  cloth.stretch_u_N_per_m *= stretch;
  cloth.stretch_v_N_per_m *= stretch;
  cloth.bend_u_N_m = cloth.bend_v_N_m = laboratory::rigidity_N_m(weight_kg_per_m2, bending_length_m);
  return cloth;
}

TEST(DrapeCurve, APointComesAgainFromTheEngine) {
  constexpr double c = 0.018;
  for (const double ratio : {0.1, 0.005}) {
    Fabric cloth = cloth_of(c);
    cloth.compression_ratio = ratio;
    EXPECT_NEAR(drape(cloth, 0.005, 7).percent, drape_curve::percent_of_bending_length(ratio).value(c),
                drape_curve::uncertainty_points(c, ratio));
  }
}

// Writes <build>/validation/drape_curve.csv: the means and scatters are the points of the curve.
TEST(DrapeCurveLong, ComesAgainFromTheEngine) {
  Figures figures("drape_curve");
  struct Specimen {
    const char* what;
    double weight_kg_per_m2 = 0.15, shear_N_per_m = 60, stretch = 1, edge_m = 0.005;
    std::uint64_t start = 1;
    bool of_filaments = false;  // too
  };
  const std::vector<Specimen> specimens = {{.what = "cotton", .of_filaments = true},
                                           {.what = "another start", .start = 2},
                                           {.what = "soft in shear", .shear_N_per_m = 30, .of_filaments = true},
                                           {.what = "stiff in shear", .shear_N_per_m = 120},
                                           {.what = "stretch of 4 times", .stretch = 4},
                                           {.what = "light", .weight_kg_per_m2 = 0.07, .of_filaments = true},
                                           {.what = "heavy", .weight_kg_per_m2 = 0.35},
                                           {.what = "fine mesh", .edge_m = 0.0035}};
  for (const drape_curve::Point& point : drape_curve::points) {
    char name[32];
    std::snprintf(name, sizeof name, "%g mm", 1e3 * point.bending_length_m);
    std::vector<double> percents, filaments;
    for (const Specimen& one : specimens) {
      Fabric cloth = cloth_of(point.bending_length_m, one.weight_kg_per_m2, one.shear_N_per_m, one.stretch);
      const Drape d = drape(cloth, one.edge_m, one.start);
      figures.add(one.what, name, "DC %", point.staple.percent, d.percent);
      figures.add(one.what, name, "folds", Figures::no_reference, d.folds);
      percents.push_back(d.percent);
      if (!one.of_filaments) continue;
      cloth.compression_ratio = 0.005;
      filaments.push_back(drape(cloth, one.edge_m, one.start).percent);
      figures.add(std::string(one.what) + ", filaments", name, "DC %", point.filament.percent, filaments.back());
    }
    const auto compare = [&](const char* what, const std::vector<double>& discs, const drape_curve::Drape& on_curve) {
      double mean = 0, square = 0;
      for (const double percent : discs) mean += percent / static_cast<double>(discs.size());
      for (const double percent : discs) square += (percent - mean) * (percent - mean);
      const double scatter = std::sqrt(square / static_cast<double>(discs.size() - 1));
      figures.add(std::string(what) + ", mean", name, "DC %", on_curve.percent, mean);
      figures.add(std::string(what) + ", scatter", name, "DC %", on_curve.scatter, scatter);
      EXPECT_NEAR(mean, on_curve.percent, 0.3) << what << ' ' << name;
      EXPECT_NEAR(scatter, on_curve.scatter, 0.3) << what << ' ' << name;
    };
    compare("staple", percents, point.staple);
    compare("filaments", filaments, point.filament);
  }
}

}  // namespace
}  // namespace toile::internal
