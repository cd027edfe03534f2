#include "material/fabric_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.hpp"
#include "material/drape_curve.hpp"
#include "material/laboratory_units.hpp"
#include "material/tensile_chord.hpp"
#include "support/stiffening_thread.hpp"

namespace toile::internal {
namespace {

const FittedNumber& number_of(const FabricFit& fit, std::string_view key) {
  for (const auto* list : {&fit.numbers, &fit.beside})
    for (const FittedNumber& number : *list)
      if (number.key == key) return number;
  throw std::out_of_range(std::string(key));
}

int count_flags(const FabricFit& fit, std::string_view code, std::string_view key = {}) {
  int count = 0;
  for (const FitFlag& flag : fit.flags) count += flag.code == code && (key.empty() || flag.key == key) ? 1 : 0;
  return count;
}

constexpr double staple = 0.1, filament = 0.005;  // compression_ratio

TEST(LaboratoryUnits, AreThoseComputedByHand) {
  EXPECT_NEAR(laboratory::bending_N_m, 9.80665e-5, 1e-12);        // 9.80665e-3 N * (1e-2 m)^2 / 1e-2 m
  EXPECT_NEAR(laboratory::bending_friction_N, 9.80665e-3, 1e-9);  // 9.80665e-3 N * 1e-2 m / 1e-2 m
  EXPECT_NEAR(laboratory::shear_N_per_m, 56.188, 1e-3);           // 0.980665 N/m * 57.29578
  EXPECT_NEAR(laboratory::kes_tensile_N_per_m, 490.33, 1e-2);
  EXPECT_NEAR(laboratory::work_N_per_m, 0.980665, 1e-9);  // 9.80665e-5 N m / 1e-4 m^2
  EXPECT_NEAR(laboratory::fast_loads_N_per_m[0], 4.903, 1e-3);
  EXPECT_NEAR(laboratory::fast_loads_N_per_m[1], 19.61, 1e-2);
  EXPECT_NEAR(laboratory::fast_loads_N_per_m[2], 98.07, 1e-2);
  EXPECT_NEAR(laboratory::bias_shear_N_per_m(0.01), 122.6, 0.1);  // 123 N/m over EB5 in percent
}

TEST(FabricFit, RigidityFromACantileverIsThatOfTheStandard) {
  FabricMeasurements measured;
  measured.weight_kg_per_m2 = {0.15};
  measured.warp.cantilever_m = {0.0204};
  const FabricFit fit = fit_fabric(measured);
  const FittedNumber& bend = number_of(fit, "bend_u_N_m");
  EXPECT_NEAR(bend.estimate.value, 1.2493e-5, 1e-9);  // 0.15 * 9.81 * 8.4897e-6
  EXPECT_NEAR(bend.estimate.relative, std::sqrt(0.15 * 0.15 + 0.02 * 0.02), 1e-9);
  EXPECT_EQ(fit.fabric.bend_u_N_m, 1.249e-5);
  EXPECT_EQ(number_of(fit, "bend_v_N_m").estimate.readings, 0) << "cotton's";
  EXPECT_EQ(fit.fabric.bend_v_N_m, Fabric{}.bend_v_N_m);
  EXPECT_TRUE(fit.flags.empty());
}

TEST(FabricFit, EveryFigureOfKesAndFastGivesItsNumber) {
  FabricMeasurements measured;
  measured.base = "wool";  // which has no friction
  measured.warp.kes_bending_N_m = {0.1 * laboratory::bending_N_m};
  measured.weft.fast_bending_N_m = {5e-6};
  measured.kes_shear_N_per_m = {1.2 * laboratory::shear_N_per_m};
  measured.friction = {0.4};
  measured.warp.kes_hysteresis_N = {0.05 * laboratory::bending_friction_N};
  measured.weft.kes_hysteresis_N = {0.03 * laboratory::bending_friction_N};
  FabricFit fit = fit_fabric(measured);
  EXPECT_NEAR(fit.fabric.bend_u_N_m, 9.807e-6, 1e-10);
  EXPECT_EQ(fit.fabric.bend_v_N_m, 5e-6);
  EXPECT_NEAR(fit.fabric.shear_N_per_m, 67.43, 0.01);
  EXPECT_EQ(fit.fabric.friction, 0.4);
  EXPECT_NEAR(number_of(fit, "bend_friction_N").estimate.value, 0.5 * 0.04 * 9.80665e-3, 1e-9);
  measured = {};
  measured.fast_bias_extension = {0.022};
  fit = fit_fabric(measured);
  EXPECT_NEAR(fit.fabric.shear_N_per_m, 55.72, 0.01);  // 4.9033 / (4 * 0.022)
}

// B is the slope where threads slip, and a cantilever, which bends less, shows more than it: up to B + D_f, D_f = M_f / kappa_y.
TEST(FabricFit, BendingFrictionComesWithBAndExplainsAStifferCantilever) {
  FabricMeasurements measured;
  measured.weight_kg_per_m2 = {0.124};
  measured.warp.kes_bending_N_m = measured.weft.kes_bending_N_m = {1e-5};
  measured.warp.kes_hysteresis_N = {8e-4};
  measured.weft.kes_hysteresis_N = {4e-4};  // M_f = 3e-4, D_f = 1.5e-5
  const auto cantilever = [&](double rigidity_N_m) {
    measured.warp.cantilever_m = {cube_root(rigidity_N_m / (0.124 * 9.80665))};
    return fit_fabric(measured);
  };
  FabricFit fit = cantilever(1.8e-5);
  EXPECT_EQ(fit.fabric.bend_friction_N, 3e-4);
  EXPECT_EQ(fit.fabric.bend_friction_curvature_per_m, Fabric{}.bend_friction_curvature_per_m);
  EXPECT_EQ(fit.fabric.bend_u_N_m, 1e-5) << "the cantilever's is beside it";
  EXPECT_NEAR(number_of(fit, "bend_friction_N").estimate.uncertainty(), 0.15 * std::hypot(2e-4, 1e-4), 1e-9);
  EXPECT_TRUE(fit.flags.empty());
  EXPECT_EQ(count_flags(cantilever(6e-5), fit_flag::sources_disagree, "bend_u_N_m"), 1);
  EXPECT_EQ(count_flags(cantilever(4e-6), fit_flag::sources_disagree, "bend_u_N_m"), 1);
  // The drape is between those of B and B + D_f.
  fit = cantilever(1.8e-5);
  const MonotoneCurve& curve = drape_curve::percent_of_bending_length(staple);
  const double low = curve.value(cube_root(1e-5 / (0.124 * 9.80665))),
               high = curve.value(cube_root(2.5e-5 / (0.124 * 9.80665)));
  EXPECT_NEAR(fit.drape.of_the_fabric->value, 0.5 * (low + high), 0.01);
  EXPECT_GT(fit.drape.of_the_fabric->uncertainty(), (high - low) / std::sqrt(12.0));
  measured.drape = {0.01 * low};
  EXPECT_EQ(count_flags(fit_fabric(measured), fit_flag::drape_disagrees, "drape_percent"), 0);
  measured.drape = {0.3};
  EXPECT_EQ(count_flags(fit_fabric(measured), fit_flag::drape_disagrees, "drape_percent"), 1);
  // Without B along both threads it is for the record, and the cantilever counts.
  measured.weft.kes_bending_N_m = {};
  measured.drape = {};
  fit = fit_fabric(measured);
  EXPECT_EQ(fit.fabric.bend_friction_N, 0);
  EXPECT_NE(fit.fabric.bend_u_N_m, 1e-5);
}

// What a cantilever or a disc shows of a cloth contains its friction: the base's would count twice.
TEST(FabricFit, BendingThatWasMeasuredWithoutItsHysteresisIsElastic) {
  FabricMeasurements measured;
  measured.base = "poplin";
  measured.weight_kg_per_m2 = {0.124};
  EXPECT_EQ(fit_fabric(measured).fabric.bend_friction_N, fabric_preset("poplin", "", "").bend_friction_N);
  measured.warp.cantilever_m = measured.weft.cantilever_m = {0.02};
  const FabricFit fit = fit_fabric(measured);
  EXPECT_EQ(fit.fabric.bend_friction_N, 0);
  EXPECT_EQ(number_of(fit, "bend_friction_N").estimate.readings, 2)
      << "it is written, so that the base's does not count";
  EXPECT_TRUE(fit.flags.empty());
  measured.base = "wool";
  EXPECT_EQ(fit_fabric(measured).drape.of_the_fabric->value, fit.drape.of_the_fabric->value);
  // B alone is the slope where threads slip, and says nothing of what they hold.
  measured.warp = measured.weft = {};
  measured.warp.kes_bending_N_m = measured.weft.kes_bending_N_m = {1e-5};
  EXPECT_EQ(count_flags(fit_fabric(measured), fit_flag::no_bending_friction, "bend_friction_N"), 1);
}

// Force over extension of the fitted curve, at a force.
double chord_of_weft(const Fabric& fabric, double force_N_per_m) {
  return force_N_per_m / test::extension_at(force_N_per_m, fabric.stretch_v_N_per_m, fabric.doubling_strain_v);
}

TEST(FabricFit, StretchIsTheChordWhereGarmentsPull) {
  // A straight line, then one that stiffens.
  FabricMeasurements measured;
  measured.warp.curve = {{0.01, 30}, {0.03, 90}};
  measured.weft.fast_extension = {Readings{0.004}, Readings{0.010}, Readings{0.025}};
  const FabricFit fit = fit_fabric(measured);
  EXPECT_NEAR(fit.fabric.stretch_u_N_per_m, 3000, 0.5);
  EXPECT_NEAR(number_of(fit, "stretch_u_N_per_m").estimate.relative, 0.05, 1e-6) << "no part of the range";
  EXPECT_EQ(fit.fabric.doubling_strain_u, 0);
  EXPECT_GT(chord_of_weft(fit.fabric, 30), 19.61 / 0.010);
  EXPECT_LT(chord_of_weft(fit.fabric, 30), 98.07 / 0.025);
  EXPECT_NEAR(chord_of_weft(fit.fabric, 98.07), 98.07 / 0.025, 2) << "the end of the curve";
  EXPECT_LT(fit.fabric.stretch_v_N_per_m, chord_of_weft(fit.fabric, 30));
  EXPECT_GT(number_of(fit, "stretch_v_N_per_m").estimate.relative, 0.1);
  EXPECT_TRUE(fit.flags.empty());
  // The middle of the range of forces, wherever that is.
  measured.weft = {};
  measured.weft.curve = {{0.01, 30}, {0.012, 100}};
  EXPECT_NEAR(chord_of_weft(fit_fabric(measured).fabric, 30), 3000, 2);
  measured.warp.curve = measured.weft.curve;
  measured.chord_N_per_m = {50, 150};
  EXPECT_NEAR(fit_fabric(measured).fabric.stretch_u_N_per_m, 100 / 0.012, 1);
  measured.chord_N_per_m = {10, 50};
  measured.warp.curve = {{0.01, 200}};
  EXPECT_EQ(count_flags(fit_fabric(measured), fit_flag::chord_elsewhere, "stretch_u_N_per_m"), 1);
  EXPECT_EQ(count_flags(fit_fabric(measured), fit_flag::stiff_stretch, "stretch_u_N_per_m"), 1);
  measured.warp.curve = {{0.01, 5}};
  EXPECT_EQ(count_flags(fit_fabric(measured), fit_flag::chord_elsewhere, "stretch_u_N_per_m"), 1);
  EXPECT_NEAR(fit_fabric(measured).fabric.stretch_u_N_per_m, 500, 0.01);
}

TEST(FabricFit, TheCurveOfKesHasItsEndAndItsWork) {
  const double top = laboratory::kes_tensile_N_per_m;
  for (const double linearity : {0.34, 0.45, 0.5, 0.62, 0.8, 1.0}) {
    // strain(F) = F / chord; the work under the curve, by the trapezoidal rule over the force: F e - integral of e dF
    const int n = 4000;
    double beside = 0, before = 0;
    for (int k = 1; k <= n; ++k) {
      const double force = top * k / n;
      const double strain = force / kes_chord(0.05, linearity, {force * 0.999999, force * 1.000001}).stiffness_N_per_m;
      beside += 0.5 * (strain + before) * top / n;
      before = strain;
    }
    EXPECT_NEAR(before, 0.05, 1e-6);
    EXPECT_NEAR((top * 0.05 - beside) / (0.5 * top * 0.05), linearity, 2e-3);
  }
}

TEST(FabricFit, LinearityFromWorkIsThatGiven) {
  FabricMeasurements by_linearity, by_work;
  by_linearity.warp.kes_extension = by_work.warp.kes_extension = {0.06};
  by_linearity.warp.kes_linearity = {0.62};
  by_work.warp.kes_work_N_per_m = {0.62 * 0.5 * laboratory::kes_tensile_N_per_m * 0.06};
  EXPECT_EQ(fit_fabric(by_linearity).fabric.stretch_u_N_per_m, fit_fabric(by_work).fabric.stretch_u_N_per_m);
  EXPECT_GT(number_of(fit_fabric(by_work), "stretch_u_N_per_m").estimate.relative, kes_shape_relative);
  by_work.warp.kes_work_N_per_m = {1.3 * 0.5 * laboratory::kes_tensile_N_per_m * 0.06};
  try {
    fit_fabric(by_work);
    ADD_FAILURE() << "a linearity of 1.3";
  } catch (const InputError& error) {
    EXPECT_EQ(error.path(), "/kes/WT_warp_gf_cm_per_cm2");
    EXPECT_EQ(error.got(), "1.3");
  }
}

TEST(FabricFit, SourcesThatAgreeAreCombinedAndThoseThatDoNotAreFlagged) {
  FabricMeasurements measured;
  measured.weight_kg_per_m2 = {0.15};
  measured.warp.cantilever_m = {0.0204};
  measured.warp.kes_bending_N_m = {1.3e-5};
  FabricFit fit = fit_fabric(measured);
  EXPECT_TRUE(fit.flags.empty());
  const Estimate& bend = number_of(fit, "bend_u_N_m").estimate;
  EXPECT_GT(bend.value, 1.2493e-5);
  EXPECT_LT(bend.value, 1.3e-5);
  EXPECT_LT(bend.relative, 0.1);
  measured.warp.kes_bending_N_m = {3e-5};
  fit = fit_fabric(measured);
  ASSERT_EQ(count_flags(fit, fit_flag::sources_disagree, "bend_u_N_m"), 1);
  EXPECT_GT(number_of(fit, "bend_u_N_m").estimate.relative, 0.2);
  for (const char* word : {"cantilever 1.25e-05 (15 %)", "KES-F B 3e-05 (10 %)", "chi-square"})
    EXPECT_NE(fit.flags.front().text.find(word), std::string::npos) << fit.flags.front().text;
  // Two lengths: the weight, which both use, does not hide that they differ.
  measured.warp.kes_bending_N_m.clear();
  measured.warp.fast_bending_m = {0.027};
  EXPECT_EQ(count_flags(fit_fabric(measured), fit_flag::sources_disagree, "bend_u_N_m"), 1);
}

TEST(FabricFit, AWeightThatNobodyMeasuredIsSaidAndCounted) {
  FabricMeasurements measured;
  measured.base = "denim";
  measured.warp.cantilever_m = Readings(20, 0.027);
  const FabricFit fit = fit_fabric(measured);
  EXPECT_EQ(count_flags(fit, fit_flag::weight_of_the_base), 1);
  EXPECT_GT(number_of(fit, "bend_u_N_m").estimate.relative, 0.15);
  EXPECT_EQ(fit.fabric.name, "denim");
  EXPECT_EQ(fit.fabric.thickness_m, fabric_preset("denim", "", "").thickness_m);
}

// ---- drape --------------------------------------------------------------------------------------------------------------

TEST(DrapeCurve, AscendsAndKnowsThePresets) {
  for (const double ratio : {staple, filament}) {
    const MonotoneCurve& curve = drape_curve::percent_of_bending_length(ratio);
    double before = 0;
    for (double c = curve.first()[0]; c <= curve.last()[0]; c += 1e-4) {
      EXPECT_GT(curve.value(c), before) << c;
      EXPECT_GT(curve.slope(c), 0) << c;
      before = curve.value(c);
      EXPECT_LE(drape_curve::percent_of_bending_length(filament).value(c),
                drape_curve::percent_of_bending_length(staple).value(c));
    }
  }
  // docs/validation.md#drape, edges of 3.5 mm: of other weights, shears and stretches than the curve's.  Cotton has friction besides.
  const std::pair<const char*, double> presets[] = {{"silk", 25.6}, {"wool", 52.4}, {"denim", 82.6}, {"knit", 41.8}};
  for (const auto& [name, percent] : presets) {
    const Fabric& fabric = fabric_preset(name, "", "");
    const double scatters = fabric.name == "denim" ? 2.5 : 2;  // 5.5 points
    const double c = cube_root(std::sqrt(fabric.bend_u_N_m * fabric.bend_v_N_m) / (fabric.density_kg_per_m2 * 9.81));
    EXPECT_NEAR(drape_curve::percent_of_bending_length(fabric.compression_ratio).value(c), percent,
                scatters * drape_curve::uncertainty_points(c, fabric.compression_ratio))
        << name;
  }
}

TEST(DrapeCurve, IsAsUncertainAsItsPointsScatter) {
  EXPECT_DOUBLE_EQ(drape_curve::uncertainty_points(0.0225, staple), 3.4);
  EXPECT_DOUBLE_EQ(drape_curve::uncertainty_points(0.02375, staple), 2.95);
  EXPECT_DOUBLE_EQ(drape_curve::uncertainty_points(0.005, staple), drape_curve::least_uncertainty_points);
  EXPECT_DOUBLE_EQ(drape_curve::uncertainty_points(0.04, staple), 1.5);
}

TEST(FabricFit, BendingComesFromTheDrapeWhereNothingElseSaysIt) {
  const MonotoneCurve& curve = drape_curve::percent_of_bending_length(staple);
  FabricMeasurements measured;
  measured.weight_kg_per_m2 = {0.12, 0.12, 0.12};
  measured.drape = {0.01 * curve.value(0.019)};
  FabricFit fit = fit_fabric(measured);
  EXPECT_TRUE(fit.drape.gives_bending);
  EXPECT_NEAR(fit.fabric.bend_u_N_m / laboratory::rigidity_N_m(0.12, 0.019), 1, 1e-3);
  EXPECT_EQ(fit.fabric.bend_u_N_m, fit.fabric.bend_v_N_m);
  const double points = quadrature(0.05 * curve.value(0.019), drape_curve::uncertainty_points(0.019, staple));
  EXPECT_NEAR(number_of(fit, "bend_u_N_m").estimate.relative,
              quadrature(3 * points / curve.slope(0.019) / 0.019, 0.002), 1e-6);
  // With one thread known, the other is what the mean needs.
  measured.warp.kes_bending_N_m = {2 * laboratory::rigidity_N_m(0.12, 0.019)};
  fit = fit_fabric(measured);
  EXPECT_NEAR(fit.fabric.bend_v_N_m / (0.5 * laboratory::rigidity_N_m(0.12, 0.019)), 1, 1e-3);
  EXPECT_GT(number_of(fit, "bend_v_N_m").estimate.relative, number_of(fit, "bend_u_N_m").estimate.relative);
}

TEST(FabricFit, ADrapeThatBendingDoesNotExplainIsFlagged) {
  const MonotoneCurve& curve = drape_curve::percent_of_bending_length(staple);
  FabricMeasurements measured;
  measured.weight_kg_per_m2 = {0.12};
  measured.warp.cantilever_m = {0.019};
  measured.weft.cantilever_m = {0.019};
  measured.drape = {0.01 * curve.value(0.019) + 0.02};
  FabricFit fit = fit_fabric(measured);
  ASSERT_TRUE(fit.drape.of_the_fabric.has_value());
  EXPECT_NEAR(fit.drape.of_the_fabric->value, curve.value(0.019), 1e-6);
  EXPECT_FALSE(fit.drape.gives_bending);
  EXPECT_TRUE(fit.flags.empty());
  measured.drape = {0.92};
  fit = fit_fabric(measured);
  EXPECT_EQ(count_flags(fit, fit_flag::drape_disagrees), 1);
  EXPECT_NEAR(fit.fabric.bend_u_N_m / laboratory::rigidity_N_m(0.12, 0.019), 1, 1e-3) << "bending stays as measured";
  measured.warp.cantilever_m = measured.weft.cantilever_m = {0.08};
  EXPECT_EQ(count_flags(fit_fabric(measured), fit_flag::outside_the_drape_curve), 1);
}

TEST(FabricFit, ADrapeOutsideTheCurveIsRefused) {
  FabricMeasurements measured;
  measured.weight_kg_per_m2 = {0.12};
  for (const double drape : {0.03, 0.99}) {
    measured.drape = {drape};
    try {
      fit_fabric(measured);
      ADD_FAILURE() << drape;
    } catch (const InputError& error) {
      EXPECT_EQ(error.path(), "/drape_percent");
      EXPECT_NE(error.expected().find("where the drape says how stiff a cloth is"), std::string::npos);
    }
  }
}

// ---- a fabric that is known, measured many times -------------------------------------------------------------------------

class Laboratory {
 public:
  explicit Laboratory(std::uint64_t seed) : random_(seed) {}
  Readings readings(double truth, double scatter, int count) {
    Readings list;
    for (int k = 0; k < count; ++k) list.push_back(truth * (1 + scatter * normal_(random_)));
    return list;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

TEST(FabricFit, AKnownFabricIsFoundAndTheUncertaintyCoversItInTwoThirdsOfAllCases) {
  const Fabric truth = fabric_preset("wool", "", "");
  const auto length = [&](double rigidity) { return std::cbrt(rigidity / (truth.density_kg_per_m2 * 9.81)); };
  struct Count {
    std::string_view key;
    double truth;
    int covered = 0;
    double mean = 0;
  };
  std::vector<Count> counts = {{"density_kg_per_m2", truth.density_kg_per_m2},
                               {"stretch_v_N_per_m", truth.stretch_v_N_per_m},
                               {"shear_N_per_m", truth.shear_N_per_m},
                               {"bend_u_N_m", truth.bend_u_N_m},
                               {"bend_v_N_m", truth.bend_v_N_m},
                               {"friction", truth.friction}};
  Laboratory laboratory_of(11);
  constexpr int trials = 3000;
  for (int trial = 0; trial < trials; ++trial) {
    FabricMeasurements measured;
    measured.weight_kg_per_m2 = laboratory_of.readings(truth.density_kg_per_m2, 0.01, 3);
    measured.friction = laboratory_of.readings(truth.friction, 0.1, 5);
    measured.warp.cantilever_m = laboratory_of.readings(length(truth.bend_u_N_m), 0.04, 4);
    measured.weft.cantilever_m = laboratory_of.readings(length(truth.bend_v_N_m), 0.05, 1);
    measured.weft.kes_bending_N_m = laboratory_of.readings(truth.bend_v_N_m, 0.1, 1);
    measured.kes_shear_N_per_m = laboratory_of.readings(truth.shear_N_per_m, 0.06, 6);
    const double end = laboratory::fast_loads_N_per_m[2] / truth.stretch_v_N_per_m;
    measured.weft.fast_extension[2] = laboratory_of.readings(end, 0.08, 5);
    const FabricFit fit = fit_fabric(measured);
    for (Count& count : counts) {
      const Estimate& estimate = number_of(fit, count.key).estimate;
      count.covered += std::abs(estimate.value - count.truth) < estimate.uncertainty() ? 1 : 0;
      count.mean += estimate.value / trials;
    }
  }
  for (const Count& count : counts) {
    EXPECT_NEAR(count.mean / count.truth, 1, 0.015) << count.key;
    EXPECT_NEAR(count.covered / static_cast<double>(trials), 0.683, 0.03) << count.key;
  }
}

TEST(FabricFit, ACurveThatStiffensIsFound) {
  // k = 1050 N/m and d = 1.6 %, as KES-F sees it: the end of the curve and its work.
  const double k = 1050, d = 0.016, top = laboratory::kes_tensile_N_per_m;
  const auto extension = [&](double force) { return test::extension_at(force, k, d); };
  FabricMeasurements measured;
  const double E = extension(top), r = (E / d) * (E / d);
  measured.warp.kes_extension = {E};
  measured.warp.kes_linearity = {(1 + 0.5 * r) / (1 + r)};
  FabricFit fit = fit_fabric(measured);
  EXPECT_NEAR(fit.fabric.stretch_u_N_per_m, k, 0.01 * k);
  EXPECT_NEAR(fit.fabric.doubling_strain_u, d, 0.01 * d);
  EXPECT_EQ(fit.fabric.doubling_strain_v, 0) << "nothing was measured along the weft";
  // As a tensile curve.
  measured.warp = {};
  for (const double force : {5.0, 10.0, 20.0, 30.0, 50.0, 100.0, 200.0, 490.0})
    measured.warp.curve.push_back({extension(force), force});
  fit = fit_fabric(measured);
  EXPECT_NEAR(fit.fabric.stretch_u_N_per_m, k, 0.01 * k);
  EXPECT_NEAR(fit.fabric.doubling_strain_u, d, 0.01 * d);
  // A base that stiffens, and a sheet that does not.
  measured.base = "poplin";
  measured.warp.curve = {{0.01, 30}, {0.1, 300}};
  fit = fit_fabric(measured);
  EXPECT_EQ(fit.fabric.doubling_strain_u, 0);
  EXPECT_GT(number_of(fit, "doubling_strain_u").estimate.readings, 0)
      << "it is written, so that the base's does not count";
  EXPECT_EQ(fit.fabric.doubling_strain_v, fabric_preset("poplin", "", "").doubling_strain_v);
}

// Chords of two methods: the one where garments pull may lie at a larger extension than the end of the other's curve.
TEST(FabricFit, ACurveThatHasNoRoomToStiffenIsAsSteepAsACurveMayBe) {
  for (const double end_chord : {8000.0, 30000.0}) {
    const StiffeningCurve curve = curve_through(3000, 30, 60, end_chord);
    EXPECT_NEAR(curve.stiffness_N_per_m, 300, 1e-9);
    EXPECT_NEAR(30 / test::extension_at(30, curve.stiffness_N_per_m, curve.doubling_strain), 3000, 1e-6)
        << "the chord is kept";
  }
}

TEST(FabricFit, TheUncertaintyOfTheDoublingCoversIt) {
  const double k = 1050, d = 0.03;
  const auto extension = [&](double force) { return test::extension_at(force, k, d); };
  Laboratory laboratory_of(12);
  constexpr int trials = 1000;
  int covered = 0, seen = 0;
  double mean = 0;
  for (int trial = 0; trial < trials; ++trial) {
    FabricMeasurements measured;
    for (std::size_t n = 0; n < 3; ++n)
      measured.warp.fast_extension[n] = laboratory_of.readings(extension(laboratory::fast_loads_N_per_m[n]), 0.08, 5);
    const FabricFit fit = fit_fabric(measured);
    if (fit.fabric.doubling_strain_u == 0) continue;
    ++seen;
    const Estimate& estimate = number_of(fit, "doubling_strain_u").estimate;
    covered += std::abs(estimate.value - d) < estimate.uncertainty() ? 1 : 0;
    mean += estimate.value;
  }
  EXPECT_GT(seen, 0.9 * trials);
  EXPECT_NEAR(mean / seen / d, 1, 0.15) << "the chord between two of FAST's loads is read from a smooth curve";
  EXPECT_GT(covered, 0.65 * seen);
}

TEST(FabricFit, NumbersHaveFourDigits) {
  EXPECT_EQ(four_digits(0.0123456), 0.01235);
  EXPECT_EQ(four_digits(8.71749e-6), 8.717e-6);
  EXPECT_EQ(four_digits(0), 0);
}

}  // namespace
}  // namespace toile::internal
