// tests/garment/layering_test.cpp: panels that are drawn on top of each other get room between them.
#include "garment/layering.hpp"

#include "garments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>

namespace toile::internal {
namespace {

// Where along z the panel lies; it is flat.
double z_of(const GarmentMesh& garment, Index panel) {
  const std::vector<Index> panel_of = garment.panel_of_particle();
  std::optional<double> z;
  for (std::size_t i = 0; i < garment.x.size(); ++i) {
    if (panel_of[i] != panel) continue;
    if (!z) z = garment.x[i].z();
    EXPECT_NEAR(garment.x[i].z(), *z, 1e-12);
  }
  return z.value_or(0);
}

GarmentMesh separated(const std::vector<Panel>& panels) {
  Pattern pattern;
  pattern.name = "layers";
  pattern.panels = panels;
  for (std::size_t k = 0; k < panels.size(); ++k) pattern.panels[k].name += std::to_string(k);
  GarmentMesh garment = mesh_garment(pattern, 0.03);
  const Vec3s drawn = garment.x;
  separate_layers(garment, Vec3::Zero());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    EXPECT_EQ(garment.x[i].x(), drawn[i].x()) << "along its normal alone";
    EXPECT_EQ(garment.x[i].y(), drawn[i].y());
  }
  return garment;
}

TEST(Layers, TiersDrawnInOnePlaneLieOneOverTheOtherTheLowestOutside) {
  const auto tier = [](double y, double z) { return test::front_rectangle(0.3, 0.2, Vec3(0, y, z)); };
  // Front and back, the lowest first: what decides is where they hang, not their order in the file.
  const GarmentMesh garment =
      separated({tier(-0.2, 0.2), tier(-0.1, 0.2), tier(0, 0.2), tier(-0.2, -0.2), tier(0, -0.2), tier(-0.1, -0.2)});
  EXPECT_NEAR(z_of(garment, 2), 0.2, 1e-12);
  EXPECT_NEAR(z_of(garment, 1), 0.2 + layer_gap_m, 1e-12);
  // The first and the third share an edge, and lie on each other nowhere.
  EXPECT_NEAR(z_of(garment, 0), 0.2 + 2 * layer_gap_m, 1e-12);
  EXPECT_NEAR(z_of(garment, 4), -0.2, 1e-12);
  EXPECT_NEAR(z_of(garment, 5), -0.2 - layer_gap_m, 1e-12);
  EXPECT_NEAR(z_of(garment, 3), -0.2 - 2 * layer_gap_m, 1e-12);
}

TEST(Layers, APanelWithinTheOpeningOfAnotherStaysWhereItIs) {
  // A U, and a square between its legs.
  const Panel u = test::straight_panel(
      "u", {{-0.3, -0.3}, {0.3, -0.3}, {0.3, 0.3}, {0.1, 0.3}, {0.1, 0}, {-0.1, 0}, {-0.1, 0.3}, {-0.3, 0.3}},
      Vec3(0, 0, 0.2));
  const GarmentMesh beside = separated({u, test::front_rectangle(0.16, 0.2, Vec3(0, 0.15, 0.2))});
  EXPECT_EQ(z_of(beside, 0), 0.2);
  EXPECT_EQ(z_of(beside, 1), 0.2);
  const GarmentMesh over = separated({u, test::front_rectangle(0.3, 0.2, Vec3(0, 0.15, 0.2))});
  EXPECT_NEAR(z_of(over, 0), 0.2 + layer_gap_m, 1e-12) << "it hangs lower";
  EXPECT_EQ(z_of(over, 1), 0.2);
}

TEST(Layers, FlaredLegsWhoseHemsCrossLieOneOverTheOther) {
  // No corner of one lies within the other.  The hem of 2 mm is a cuff of trousers that somebody drew.
  const auto leg = [](double side, double high) {
    std::vector<Vec2> outline{{-0.02, 0}, {0.4, 0}, {0.4, high}, {0.36 * high - 0.02, high}};
    if (side < 0) {
      std::reverse(outline.begin(), outline.end());
      for (Vec2& p : outline) p.x() = -p.x();
    }
    return test::straight_panel("leg", outline, Vec3(0, 0, 0.2));
  };
  for (const double high : {0.5, 0.002}) {
    const GarmentMesh garment = separated({leg(-1, high), leg(1, high)});
    EXPECT_EQ(z_of(garment, 0), 0.2);
    EXPECT_NEAR(z_of(garment, 1), 0.2 + layer_gap_m, 1e-12) << high;
  }
}

TEST(Layers, WhatIsDrawnInAnOrderKeepsIt) {
  const auto tier = [](double y, double z) { return test::front_rectangle(0.3, 0.2, Vec3(0, y, z)); };
  const GarmentMesh inside = separated({tier(0, 0.2), tier(-0.1, 0.2 - 1.1 * layer_gap_m)});
  EXPECT_EQ(z_of(inside, 0), 0.2);
  EXPECT_EQ(z_of(inside, 1), 0.2 - 1.1 * layer_gap_m);
  const GarmentMesh across = separated({tier(0, 0.2), tier(-0.1, -0.2)});
  EXPECT_EQ(z_of(across, 1), -0.2) << "the body is between them";
}

}  // namespace
}  // namespace toile::internal
