// How near layers lie to each other, of layers that were put where they lie.
#include "step/layer_gap.hpp"

#include "step/contact_rows.hpp"

#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace toile::internal {
namespace {

using test::Sheet;

constexpr double edge_m = 0.02;

LayerGap gap_of(const ClothModel& model, const Vec3s& x) {
  return ContactRows(model, nullptr, {}, {0, 0}, {}).layer_gap(x);
}

struct Layers {
  // Sheets of 12 cm, one over the other, each of its own thickness.
  Layers(double gap_m, const std::array<double, 2>& thickness_m) : sheet(test::stack(0.12, edge_m, gap_m, 2)) {
    std::array<Fabric, 2> fabrics;
    for (std::size_t k = 0; k < 2; ++k) fabrics[k].thickness_m = thickness_m[k];
    model = build_model(sheet.mesh, fabrics, {});
  }
  LayerGap gap() const { return gap_of(model, sheet.x); }
  Sheet sheet;
  ClothModel model;
};

TEST(LayerGap, OfFlatSheetsIsTheirDistance) {
  Layers layers(3e-3, {2.5e-3, 2.5e-3});
  const LayerGap found = layers.gap();
  EXPECT_GT(found.particles, layers.model.particle_count() / 2) << "all but rims that hang over";
  EXPECT_NEAR(found.least_m, 3e-3, 1e-12);
  EXPECT_NEAR(found.median_m, 3e-3, 1e-12);
  EXPECT_NEAR(found.least_share, 1.2, 1e-9);
  EXPECT_NEAR(found.median_share, 1.2, 1e-9);
}

TEST(LayerGap, OneVertexThatIsPressedFlatterIsTheLeastAndNotTheMedian) {
  Layers layers(3e-3, {2.5e-3, 2.5e-3});
  Vec3s& x = layers.sheet.x;
  const auto upper = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
  const Vec3 middle = (x.front() + *(upper - 1)) / 2;
  std::min_element(x.begin(), upper, [&](const Vec3& a, const Vec3& b) {
    return (a - middle).squaredNorm() < (b - middle).squaredNorm();
  })->y() += 1e-3;
  const LayerGap found = layers.gap();
  EXPECT_NEAR(found.least_m, 2e-3, 1e-5);
  EXPECT_NEAR(found.median_m, 3e-3, 1e-12);
}

TEST(LayerGap, TheThinnerFabricSaysWhatIsAsked) {
  const LayerGap found = Layers(1.5e-3, {1e-3, 4e-3}).gap();
  EXPECT_NEAR(found.median_share, 1.5, 1e-9);
}

TEST(LayerGap, WhatIsTwiceAsFarDoesNotLieOnTheOther) {
  const LayerGap found = Layers(5.1e-3, {2.5e-3, 2.5e-3}).gap();
  EXPECT_EQ(found.pairs, 0);
  EXPECT_EQ(found.particles, 0);
  EXPECT_EQ(found.least_m, 0);
}

// Two strips that cross: no vertex of either is near the other.
TEST(LayerGap, WhereOnlyEdgesLieOnEdgesThereIsALeastAndNoMedian) {
  Sheet strips;
  for (const bool across : {false, true}) {
    Sheet one;
    one.mesh.particle_count = 4;
    one.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    const std::array<Vec2, 4> uv = {Vec2(-0.1, -0.005), Vec2(0.1, -0.005), Vec2(0.1, 0.005), Vec2(-0.1, 0.005)};
    for (const Triangle& t : one.mesh.triangles) one.mesh.uv.push_back({uv[at(t[0])], uv[at(t[1])], uv[at(t[2])]});
    one.mesh.panel = {0, 0};
    for (const Vec2& p : uv) one.x.push_back(across ? Vec3(p.y(), 3e-3, p.x()) : Vec3(p.x(), 0, p.y()));
    test::add_sheet(strips, one, Vec3::Zero(), across ? "across" : "along");
  }
  const Fabric fabric;
  const LayerGap found = gap_of(build_model(strips.mesh, {&fabric, 1}, {}), strips.x);
  EXPECT_GT(found.pairs, 0);
  EXPECT_EQ(found.particles, 0);
  EXPECT_NEAR(found.least_m, 3e-3, 1e-12);
  EXPECT_EQ(found.median_m, 0);
}

TEST(LayerGap, OfASingleSheetThereIsNone) {
  const Sheet sheet = test::equilateral_sheet(0.12, 0.12, edge_m);
  const Fabric fabric;
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1}, {});
  EXPECT_EQ(gap_of(model, sheet.x).particles, 0);
}

}  // namespace
}  // namespace toile::internal
