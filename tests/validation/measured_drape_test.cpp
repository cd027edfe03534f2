// The drape of four cloths of which KES-F has the mass, B and 2HB, against their own drape coefficients.        docs/validation.md#drape-of-measured-cloth
#include "validation/drape_run.hpp"
#include "validation/figures.hpp"

#include <cmath>

namespace toile::internal {
namespace {

using test::Figures;

struct MeasuredCloth {
  const char* name;
  double density_kg_per_m2, B_N_m, HB_N;                       // HB: half of 2HB
  double stretch_u_N_per_m, stretch_v_N_per_m, shear_N_per_m;  // of its kind: the drape depends little on them
  double drape_percent;
};

constexpr MeasuredCloth measured[] = {{"polyester faille", 0.1043, 1.86e-6, 3.4e-5, 1500, 1200, 25, 28.3},
                                      {"wool tropical", 0.1629, 6.57e-6, 1.62e-4, 1050, 1050, 26, 49.8},
                                      {"polyester tropical", 0.1165, 7.55e-6, 1.42e-4, 1500, 1200, 30, 50.7},
                                      {"cotton broadcloth", 0.1238, 1.157e-5, 6.08e-4, 3000, 2000, 60, 82.9}};

// Of the Japanese standard, which the paper is likely to have used: a disc of 254 mm on one of 127.
constexpr test::CusickSizes jis{0.127, 0.0635};

Fabric fabric_of(const MeasuredCloth& cloth, bool rubs) {
  Fabric fabric;
  fabric.name = cloth.name;
  fabric.density_kg_per_m2 = cloth.density_kg_per_m2;
  fabric.stretch_u_N_per_m = cloth.stretch_u_N_per_m;
  fabric.stretch_v_N_per_m = cloth.stretch_v_N_per_m;
  fabric.shear_N_per_m = cloth.shear_N_per_m;
  fabric.bend_u_N_m = fabric.bend_v_N_m = cloth.B_N_m;
  fabric.bend_friction_N = rubs ? cloth.HB_N : 0;
  return fabric;
}

// Bending friction is what makes the broadcloth stand out: no number is fitted.
TEST(MeasuredDrape, IsThatOfTheClothWhichWasMeasured) {
  Figures figures("drape_measured");
  double off = 0, off_elastic = 0;
  for (const MeasuredCloth& cloth : measured) {
    const test::Drape rubbing = test::drape(fabric_of(cloth, true), 0.007, 1, jis),
                      elastic = test::drape(fabric_of(cloth, false), 0.007, 1, jis);
    figures.add(cloth.name, "measured", "DC %", Figures::no_reference, cloth.drape_percent);
    figures.add(cloth.name, "with 2HB", "DC %", cloth.drape_percent, rubbing.percent);
    figures.add(cloth.name, "without", "DC %", cloth.drape_percent, elastic.percent);
    EXPECT_NEAR(rubbing.percent, cloth.drape_percent, 10) << cloth.name;
    EXPECT_GT(rubbing.percent, elastic.percent) << cloth.name;
    off += std::abs(rubbing.percent - cloth.drape_percent) / 4;
    off_elastic += std::abs(elastic.percent - cloth.drape_percent) / 4;
  }
  EXPECT_LT(off, 6);
  EXPECT_GT(off_elastic, 8);
}

}  // namespace
}  // namespace toile::internal
