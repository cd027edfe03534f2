// tests/garment/flares_test.cpp: rings that are drawn flat hang down from where they are sewn.
#include "garment/flares.hpp"

#include "contact/crossing_finder.hpp"
#include "core/elementary.hpp"
#include "garment/placement.hpp"
#include "garments.hpp"
#include "support/bodies.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

namespace toile::internal {
namespace {

// A ring of `degrees` about `centre`, open above if `turned` is 0.  Counter-clockwise: edges 0 outside, 1 side at +x, 2 inside, 3 side at -x.
Panel ring(double degrees, double inner_m, double outer_m, const Vec3& centre, double turned = 0) {
  const double half = 0.5 * degrees / 180 * std::numbers::pi;
  const auto on = [&](double r, double a) { return Vec2(r * ieee_sin(a), -r * ieee_cos(a)); };
  Panel panel = test::straight_panel(
      "ring", {on(outer_m, -half), on(outer_m, half), on(inner_m, half), on(inner_m, -half)}, centre);
  panel.rotation_deg.z() = turned;
  for (const int k : {0, 2}) {
    PanelEdge& edge = panel.edges[static_cast<std::size_t>(k)];
    edge.kind = CurveKind::circle;
    edge.radius_m = k == 0 ? outer_m : inner_m;
    edge.large_arc = degrees > 180;
    const Vec2 below(0, -edge.radius_m);
    if ((sample_edge(panel, edge, 2)[1] - below).norm() > 1e-6) edge.sweep = true;
    EXPECT_LT((sample_edge(panel, edge, 2)[1] - below).norm(), 1e-6);
  }
  return panel;
}

GarmentMesh garment_of(const std::vector<Panel>& panels, const std::vector<Stitch>& stitches = {}) {
  Pattern pattern;
  pattern.name = "flares";
  pattern.panels = panels;
  pattern.stitches = stitches;
  for (std::size_t k = 0; k < panels.size(); ++k) pattern.panels[k].name += std::to_string(k);
  return mesh_garment(pattern, 0.02);
}

struct Extent {
  double low_m = 1e300, high_m = -1e300, nearest_m = 1e300;  // heights; how far before the plane z = 0
};
Extent extent_of(const GarmentMesh& garment, Index panel) {
  const std::vector<Index> panel_of = garment.panel_of_particle();
  Extent extent;
  for (std::size_t i = 0; i < garment.x.size(); ++i) {
    if (panel_of[i] != panel) continue;
    extent.low_m = std::min(extent.low_m, garment.x[i].y());
    extent.high_m = std::max(extent.high_m, garment.x[i].y());
    extent.nearest_m = std::min(extent.nearest_m, std::abs(garment.x[i].z()));
  }
  return extent;
}

std::size_t crossings(const GarmentMesh& garment) {
  return find_crossings(garment.mesh.triangles, garment.x, {}, {}).all.size();
}

class FlareOf : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Degrees, FlareOf, testing::Values(210, 270, 330));

TEST_P(FlareOf, HangsDownBeforeItsPlaneWithoutStretchOrACrossing) {
  GarmentMesh garment =
      garment_of({ring(GetParam(), 0.1, 0.5, Vec3(0.02, 1, 0.2)), ring(GetParam(), 0.1, 0.5, Vec3(0.02, 1, -0.2))});
  const Vec3s drawn = garment.x;
  EXPECT_GT(extent_of(garment, 0).high_m, 1);
  EXPECT_EQ(hang_flares(garment, Vec3::Zero()), 2);
  for (const Index panel : {0, 1}) {
    EXPECT_LT(extent_of(garment, panel).high_m, 1) << "its sides stood up beside the trunk";
    EXPECT_GT(extent_of(garment, panel).nearest_m, 0.2 - 1e-9) << "away from the body";
  }
  EXPECT_EQ(crossings(garment), 0u);
  for (const Triangle& t : garment.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      const double was = (drawn[at(b)] - drawn[at(a)]).norm(), is = (garment.x[at(b)] - garment.x[at(a)]).norm();
      EXPECT_LT(is, was * (1 + 1e-4)) << "bent, an edge is a chord";
      EXPECT_GT(is, 0.7 * was) << "the tips of waves are the narrowest";
    }
}

TEST(Flares, OnlyRingsThatAreOpenAboveAreBent) {
  GarmentMesh garment =
      garment_of({ring(180, 0.1, 0.5, Vec3(0, 1, 0.2)), ring(270, 0.1, 0.5, Vec3(0, 1, 0.4), 90),
                  ring(270, 0.1, 0.5, Vec3(0, 1, -0.2), 180), test::front_rectangle(0.4, 0.6, Vec3(0, 1, 0.3))});
  const Vec3s drawn = garment.x;
  EXPECT_EQ(hang_flares(garment, Vec3::Zero()), 0);
  for (std::size_t i = 0; i < drawn.size(); ++i) EXPECT_EQ(garment.x[i], drawn[i]);
  GarmentMesh again = garment_of({ring(270, 0.1, 0.5, Vec3(0, 1, 0.2))});
  EXPECT_EQ(hang_flares(again, Vec3::Zero()), 1);
  const Vec3s bent = again.x;
  EXPECT_EQ(hang_flares(again, Vec3::Zero()), 0) << "it is bent already";
  for (std::size_t i = 0; i < bent.size(); ++i) EXPECT_EQ(again.x[i], bent[i]);
}

// The crotch of trousers is a hollow of nearly half a turn, as a ring's inside is.
TEST(Flares, NoPanelOfOurOwnGarmentsIsBent) {
  for (const char* name : {"man_pants", "man_shirt", "tshirt", "skirt", "blouse"}) {
    GarmentMesh garment = mesh_garment(load_pattern(test::source_path("patterns/") + name + ".json"), 0.02);
    EXPECT_EQ(hang_flares(garment, Vec3(0, 1, 0)), 0) << name;
  }
}

// Half a turn inside, three quarters with what stands beside it.
TEST(Flares, APanelWithARoundHollowIsNoRing) {
  Panel panel = ring(220, 0.1, 0.5, Vec3(0, 1, 0.2));
  panel.corners.insert(panel.corners.begin() + 2, {Vec2(0.3, 0.3), Vec2(0.1, 0.3)});
  panel.corners.insert(panel.corners.end(), {Vec2(-0.1, 0.3), Vec2(-0.3, 0.3)});
  panel.edges = {panel.edges[0], {}, {}, {}, panel.edges[2], {}, {}, {}};
  for (std::size_t k = 0; k < panel.edges.size(); ++k) {
    panel.edges[k].start = static_cast<Index>(k);
    panel.edges[k].end = static_cast<Index>((k + 1) % panel.edges.size());
  }
  GarmentMesh garment = garment_of({panel});
  EXPECT_EQ(hang_flares(garment, Vec3::Zero()), 0);
}

// Where the crotch of these trousers meets the inner leg; three points are always on a circle.
TEST(Flares, ANotchIsNoRing) {
  const std::string file = test::shared_path("patterns/random/g085_mean_female.json");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  GarmentMesh garment = mesh_garment(load_pattern(file), 0.02);
  EXPECT_EQ(hang_flares(garment, Vec3(0, 1, 0)), 0);
}

// Outside of the upper sewn to the inside of the lower, as GarmentCode draws its levels: each a little below the one before.
TEST(Flares, TiersThatCanAreOneConeAndOthersHangBelow) {
  const Panel upper = ring(300, 0.1, 0.3, Vec3(0, 1, 0.2));
  for (const double degrees : {300.0, 250.0}) {
    const bool alike = degrees == 300;
    const double inner_m = 0.3 * 300 / degrees;
    GarmentMesh garment =
        garment_of({ring(degrees, inner_m, inner_m + 0.1, Vec3(0.01, 0.9, 0.21)), upper}, {test::stitch(1, 0, 0, 2)});
    EXPECT_EQ(hang_flares(garment, Vec3::Zero()), 2);
    EXPECT_EQ(crossings(garment), 0u);
    double widest_m = 0;
    for (const SeamPair& pair : garment.pairs)
      widest_m = std::max(widest_m, (garment.x[at(pair.a)] - garment.x[at(pair.b)]).norm());
    if (alike) {
      EXPECT_LT(widest_m, 0.0201) << "one continues the other, a centimetre away from it";
    } else {
      EXPECT_LT(extent_of(garment, 0).high_m, extent_of(garment, 1).low_m);
    }
  }
}

TEST(Flares, PlacingHangsThem) {
  GarmentMesh garment = garment_of({ring(270, 0.1, 0.5, Vec3(0, 1, 0.2)), ring(270, 0.1, 0.5, Vec3(0, 1, -0.2))});
  std::vector<Vec3> x;
  for (const double y : {0.0, 1.7})
    for (const double z : {-0.1, 0.1})
      for (const double u : {-0.1, 0.1}) x.emplace_back(u, y, z);
  const Placement placement =
      place_garment(garment, BodySurface(std::move(x), {test::box_triangles.begin(), test::box_triangles.end()}));
  EXPECT_EQ(placement.panel_crossings, 0);
  EXPECT_LT(extent_of(garment, 0).high_m, 1 + placement.shift_m.y());
}

}  // namespace
}  // namespace toile::internal
