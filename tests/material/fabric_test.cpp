#include "material/fabric.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/error.hpp"

namespace toile::internal {
namespace {

std::string message_of(const Fabric& fabric) {
  try {
    check_fabric(fabric, "scene.json:14", "/cloth/0/fabric");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

struct Number {
  const char* key;
  double Fabric::*value;
  bool may_be_zero;
};
const std::vector<Number> numbers = {
    {"density_kg_per_m2", &Fabric::density_kg_per_m2, false},
    {"stretch_u_N_per_m", &Fabric::stretch_u_N_per_m, false},
    {"stretch_v_N_per_m", &Fabric::stretch_v_N_per_m, false},
    {"doubling_strain_u", &Fabric::doubling_strain_u, true},
    {"doubling_strain_v", &Fabric::doubling_strain_v, true},
    {"shear_N_per_m", &Fabric::shear_N_per_m, true},
    {"bend_u_N_m", &Fabric::bend_u_N_m, true},
    {"bend_v_N_m", &Fabric::bend_v_N_m, true},
    {"bend_friction_N", &Fabric::bend_friction_N, true},
    {"bend_friction_curvature_per_m", &Fabric::bend_friction_curvature_per_m, false},
    {"bend_set", &Fabric::bend_set, true},
    {"bend_set_s", &Fabric::bend_set_s, false},
    {"stretch_damping_s", &Fabric::stretch_damping_s, true},
    {"shear_damping_s", &Fabric::shear_damping_s, true},
    {"bend_damping_s", &Fabric::bend_damping_s, true},
    {"friction", &Fabric::friction, true},
    {"thickness_m", &Fabric::thickness_m, false},
};

TEST(Fabric, PresetsAreThosePromisedAndValid) {
  std::vector<std::string> names;
  for (const Fabric& fabric : fabric_presets()) {
    names.push_back(fabric.name);
    EXPECT_EQ(message_of(fabric), "");
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"silk", "cotton", "wool", "denim", "knit", "chiffon", "satin", "jersey", "rib",
                                      "poplin", "linen", "flannel", "suiting", "canvas", "leather", "neoprene"}));
}

TEST(Fabric, CottonIsTheDefault) {
  const Fabric& cotton = fabric_preset("cotton", "", "");
  const Fabric fabric;
  EXPECT_EQ(fabric.name, cotton.name);
  for (const Number& number : numbers) EXPECT_EQ(fabric.*number.value, cotton.*number.value) << number.key;
}

// The table of docs/theory/fabrics.md.
TEST(Fabric, PresetsLieInTheRangesOfTheirKindOfCloth) {
  struct Range {
    double low, high;
  };
  struct Kind {
    const char* name;
    Range density, stretch_u, stretch_v, shear, bend;
    double friction;
  };
  const std::vector<Kind> kinds = {{"silk", {0.06, 0.09}, {500, 1500}, {500, 1500}, {20, 60}, {1e-6, 3e-6}, 0.25},
                                   {"cotton", {0.12, 0.15}, {3000, 3000}, {2000, 2000}, {17, 84}, {5e-6, 1.5e-5}, 0.35},
                                   {"wool", {0.20, 0.27}, {2000, 2000}, {1200, 1200}, {17, 84}, {8e-6, 1.5e-5}, 0.40},
                                   {"denim", {0.32, 0.37}, {5000, 10000}, {4000, 8000}, {84, 191}, {3e-5, 1e-4}, 0.50},
                                   {"knit", {0.16, 0.20}, {50, 400}, {30, 300}, {40, 150}, {3e-6, 1e-5}, 0.40}};
  const auto expect_in = [](double value, Range range, const std::string& what) {
    EXPECT_GE(value, range.low) << what;
    EXPECT_LE(value, range.high) << what;
  };
  for (const Kind& kind : kinds) {
    const Fabric& fabric = fabric_preset(kind.name, "", "");
    const std::string name = kind.name;
    expect_in(fabric.density_kg_per_m2, kind.density, name + " density");
    expect_in(fabric.stretch_u_N_per_m, kind.stretch_u, name + " warp");
    expect_in(fabric.stretch_v_N_per_m, kind.stretch_v, name + " weft");
    expect_in(fabric.shear_N_per_m, kind.shear, name + " shear");
    expect_in(fabric.bend_u_N_m, kind.bend, name + " bend u");
    expect_in(fabric.bend_v_N_m, kind.bend, name + " bend v");
    expect_in(fabric.stretch_damping_s, {1e-3, 5e-3}, name + " stretch damping");
    expect_in(fabric.shear_damping_s, {1e-3, 5e-3}, name + " shear damping");
    expect_in(fabric.thickness_m, {1e-3, 4e-3}, name + " thickness");
    EXPECT_EQ(fabric.friction, kind.friction) << name;
  }
}

// Poplin and suiting are measured cloths (docs/theory/fabrics.md#named-cloths): 1 gf cm^2/cm = 9.81e-5 N m, 1 gf cm/cm = 9.81e-3 N.
TEST(Fabric, NamedClothsAreThoseThatWereMeasured) {
  struct Sheet {
    const char* name;
    double mg_per_cm2, B_gf_cm2_per_cm, hysteresis_gf_cm_per_cm;  // 2HB
  };
  for (const Sheet& sheet : {Sheet{"poplin", 12.38, 0.118, 0.124}, Sheet{"suiting", 16.29, 0.067, 0.033}}) {
    const Fabric& fabric = fabric_preset(sheet.name, "", "");
    EXPECT_NEAR(fabric.density_kg_per_m2, 0.01 * sheet.mg_per_cm2, 1e-3) << sheet.name;
    for (const double bend : {fabric.bend_u_N_m, fabric.bend_v_N_m})
      EXPECT_NEAR(bend, 9.81e-5 * sheet.B_gf_cm2_per_cm, 0.01 * bend) << sheet.name;
    EXPECT_NEAR(fabric.bend_friction_N, 0.5 * 9.81e-3 * sheet.hysteresis_gf_cm_per_cm, 0.02 * fabric.bend_friction_N)
        << sheet.name;
  }
  // Cotton is poplin's cloth, 0.63 times as stiff.
  const Fabric &cotton = fabric_preset("cotton", "", ""), &poplin = fabric_preset("poplin", "", "");
  EXPECT_NEAR(cotton.bend_u_N_m, 0.63 * poplin.bend_u_N_m, 0.002 * cotton.bend_u_N_m);
  EXPECT_NEAR(cotton.bend_friction_N, 0.63 * poplin.bend_friction_N, 0.002 * cotton.bend_friction_N);
  for (const char* kind : {"silk", "wool", "denim", "knit"})
    EXPECT_EQ(fabric_preset(kind, "", "").bend_friction_N, 0) << kind;
}

TEST(Fabric, ABadValueIsNamedByItsSceneKey) {
  for (const Number& number : numbers) {
    for (const double bad : {-0.2, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      Fabric fabric;
      fabric.*number.value = bad;
      const std::string message = message_of(fabric);
      EXPECT_NE(message.find(std::string("scene.json:14: /cloth/0/fabric/") + number.key + ": "), std::string::npos)
          << message;
    }
    Fabric fabric;
    fabric.*number.value = 0;
    EXPECT_EQ(message_of(fabric).empty(), number.may_be_zero) << number.key;
  }
  Fabric steep;
  for (const double doubling : {1e-200, 1e-6}) {
    steep.doubling_strain_v = doubling;
    EXPECT_EQ(message_of(steep),
              "scene.json:14: /cloth/0/fabric/doubling_strain_v: expected 0 or at least 1e-05, got " +
                  std::string(doubling == 1e-6 ? "1e-06" : "1e-200"));
  }
  Fabric fabric;
  fabric.density_kg_per_m2 = -0.2;
  EXPECT_EQ(message_of(fabric),
            "scene.json:14: /cloth/0/fabric/density_kg_per_m2: expected a number above zero, got -0.2");
}

// A plate of thickness h has k = E h, S = G h, D = E h^3 / 12 (Poisson ratio 0) and D_uv = G h^3 / 12.  Two of them, fused, are one of 2 h.
TEST(Fabric, TwoFusedHalvesBendAsTheWholePlate) {
  const auto plate = [](double h) {
    const double E_u = 3e6, E_v = 2e6, G = 7e4;
    Fabric one;
    one.density_kg_per_m2 = 500 * h;
    one.stretch_u_N_per_m = E_u * h;
    one.stretch_v_N_per_m = E_v * h;
    one.shear_N_per_m = G * h;
    one.bend_u_N_m = E_u * h * h * h / 12;
    one.bend_v_N_m = E_v * h * h * h / 12;
    one.bend_poisson = 0;
    one.bend_uv_N_m = G * h * h * h / 12;
    return one;
  };
  const double h = 3e-4;
  const Fabric whole = plate(2 * h), halves = fused(plate(h), plate(h), h);
  for (const double Fabric::*value :
       {&Fabric::density_kg_per_m2, &Fabric::stretch_u_N_per_m, &Fabric::stretch_v_N_per_m, &Fabric::shear_N_per_m,
        &Fabric::bend_u_N_m, &Fabric::bend_v_N_m, &Fabric::bend_uv_N_m})
    EXPECT_NEAR(halves.*value, whole.*value, 1e-12 * whole.*value);
  // Unequal layers: the parallel axes about the common middle, sum of k_i z_i^2.
  const double H = 5e-4;
  const Fabric thick = plate(H), both = fused(thick, plate(h), (H + h) / 2), sum = plate(H + h);
  EXPECT_NEAR(both.bend_u_N_m, sum.bend_u_N_m, 1e-12 * sum.bend_u_N_m);
  EXPECT_NEAR(both.bend_uv_N_m, sum.bend_uv_N_m, 1e-12 * sum.bend_uv_N_m);
}

// Without a distance layers slide: rigidities add up, that of the twist by the rule of the Poisson ratio.
TEST(Fabric, InterfacingAddsUpAndTheRestIsTheCloths) {
  const Fabric cotton = fabric_preset("cotton", "", ""), silk = fabric_preset("silk", "", "");
  const Fabric both = fused(cotton, silk, 0);
  EXPECT_DOUBLE_EQ(both.density_kg_per_m2, cotton.density_kg_per_m2 + silk.density_kg_per_m2);
  EXPECT_DOUBLE_EQ(both.bend_u_N_m, cotton.bend_u_N_m + silk.bend_u_N_m);
  EXPECT_DOUBLE_EQ(both.bend_uv_N_m, 0.35 * cotton.bend_u_N_m + 0.35 * 0.5 * (silk.bend_u_N_m + silk.bend_v_N_m));
  EXPECT_EQ(both.name, "cotton");
  EXPECT_EQ(both.friction, cotton.friction);
  EXPECT_EQ(both.compression_ratio, cotton.compression_ratio);
  Fabric no_threads = silk;
  no_threads.shear_N_per_m = 0;
  Fabric none = cotton;
  none.shear_N_per_m = 0;
  EXPECT_TRUE(std::isfinite(fused(none, no_threads, 1e-3).bend_uv_N_m));
}

TEST(Fabric, AnUnknownNameIsAnsweredWithTheNearest) {
  try {
    fabric_preset("coton", "scene.json:3", "/cloth/0/fabric");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "scene.json:3: /cloth/0/fabric: expected a fabric, one of silk, cotton, wool, denim, knit, chiffon, "
                 "satin, jersey, rib, poplin, linen, flannel, suiting, canvas, leather, neoprene; nearest is "
                 "\"cotton\", got \"coton\"");
  }
}

}  // namespace
}  // namespace toile::internal
