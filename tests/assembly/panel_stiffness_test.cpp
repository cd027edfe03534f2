// Panels that get stiffer or softer between two steps.
#include "assembly/elements.hpp"
#include "core/error.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

using test::Sheet;

// The left half is one panel, the right half another.
Sheet two_panels() {
  Sheet sheet = test::equilateral_sheet(0.2, 0.1, 0.02);
  test::add_panel(sheet, "right", [](const Vec2& uv) { return uv.x() >= 0.1; });
  return sheet;
}

double energy_J(const ClothModel& model, const Vec3s& x) {
  Elements elements(model);
  elements.evaluate(model, ClothState{x, Vec3s(x.size(), Vec3::Zero())});
  return elements.energy_J();
}

TEST(PanelStiffness, EnergyIsInProportionToEachShare) {
  const Sheet sheet = two_panels();
  Vec3s stretched = sheet.x, sheared = sheet.x, bent = sheet.x;
  for (Vec3& p : stretched) p.x() *= 1.02;
  for (Vec3& p : sheared) p.x() += 0.03 * p.z();
  for (Vec3& p : bent) {
    const double angle = p.x() / 0.1;
    p = Vec3(0.1 * std::sin(angle), 0.1 * (1 - std::cos(angle)), p.z());
  }
  const Fabric fabric;
  ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  const auto with = [&](const StiffnessShare& share, const Vec3s& x) {
    for (Index panel = 0; panel < 2; ++panel) set_panel_stiffness(model, panel, share);
    return energy_J(model, x);
  };
  const double stretch_J = with({}, stretched), shear_J = with({}, sheared), bend_J = with({}, bent);
  EXPECT_NEAR(with({3, 1, 1}, stretched) / stretch_J, 3, 1e-6);
  EXPECT_NEAR(with({1, 0.5, 1}, sheared) / shear_J, 0.5, 0.01);  // a little stretch is in it
  const double without_bend_J = with({1, 1, 1e-9}, bent);
  EXPECT_NEAR((with({1, 1, 4}, bent) - without_bend_J) / (bend_J - without_bend_J), 4, 1e-6);
}

TEST(PanelStiffness, OfOnePanelLeavesTheOtherAndComesBackToTheBit) {
  const Sheet sheet = two_panels();
  const Fabric fabric;
  ModelOptions hinges;
  hinges.bend_element = BendElement::hinge;
  const ClothModel built = build_model(sheet.mesh, {&fabric, 1}, hinges);
  ClothModel model = built;
  set_panel_stiffness(model, 1, {2, 3, 5});
  EXPECT_EQ(model.stiffness.at(0).k_u, built.stiffness.at(0).k_u);
  EXPECT_EQ(model.stiffness.at(1).k_u, 2 * built.stiffness.at(0).k_u);
  EXPECT_EQ(model.stiffness.at(1).k_shear, 3 * built.stiffness.at(0).k_shear);
  EXPECT_EQ(model.stiffness.at(1).tau_stretch, built.stiffness.at(0).tau_stretch);
  int beside = 0;
  for (std::size_t h = 0; h < model.bend.size(); ++h) {
    const auto& [a, b] = model.topology.hinges[h].triangle;
    const int sides = model.mesh.panel[at(a)] + model.mesh.panel[at(b)];
    EXPECT_DOUBLE_EQ(model.bend[h].kappa_N_m / built.bend[h].kappa_N_m, sides == 0 ? 1 : sides == 1 ? 3 : 5);
    beside += sides == 1 ? 1 : 0;
  }
  EXPECT_GT(beside, 3) << "hinges on the seam have the mean of both sides";
  set_panel_stiffness(model, 1, {});
  for (std::size_t h = 0; h < model.bend.size(); ++h) EXPECT_EQ(model.bend[h].kappa_N_m, built.bend[h].kappa_N_m);
  EXPECT_EQ(model.stiffness.at(1).k_shear, built.stiffness.at(0).k_shear);
}

TEST(PanelStiffness, PlatesOfOnePanelLeaveTheOtherAndComeBackToTheBit) {
  const Fabric fabric;
  const ClothModel built = build_model(two_panels().mesh, {&fabric, 1});
  ClothModel model = built;
  set_panel_stiffness(model, 1, {.bend = 4});
  for (std::size_t t = 0; t < model.plate_compliance.size(); ++t)
    EXPECT_EQ(model.plate_compliance[t], built.plate_compliance[t] / (model.mesh.panel[t] == 1 ? 4 : 1));
  set_panel_stiffness(model, 1, {});
  EXPECT_EQ(model.plate_compliance, built.plate_compliance);
  for (std::size_t h = 0; h < model.bend.size(); ++h) EXPECT_EQ(model.bend[h].plate_N_m, built.bend[h].plate_N_m);
}

TEST(PanelStiffness, WhatCannotBeMeantIsRefused) {
  const Fabric fabric;
  ClothModel model = build_model(two_panels().mesh, {&fabric, 1});
  EXPECT_THROW(set_panel_stiffness(model, 2, {}), InputError);
  EXPECT_THROW(set_panel_stiffness(model, -1, {}), InputError);
  EXPECT_THROW(set_panel_stiffness(model, 0, {0, 1, 1}), InputError);
  EXPECT_THROW(set_panel_stiffness(model, 0, {1, std::nan(""), 1}), InputError);
}

}  // namespace
}  // namespace toile::internal
