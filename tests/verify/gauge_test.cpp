// tests/verify/gauge_test.cpp: stretch over a gauge length, and rings of cloth.
#include "verify/gauge.hpp"

#include "body/solid_shapes.hpp"
#include "verify/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

// A flat sheet of `columns` x `rows` squares of `edge` m, in two triangles each.
struct Sheet {
  ClothMesh mesh;
  Vec3s x;
};
Sheet sheet(int columns, int rows, double edge) {
  Sheet s;
  const auto at = [&](int i, int j) { return static_cast<Index>(j * (columns + 1) + i); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) s.x.emplace_back(i * edge, j * edge, 0);
  const auto uv = [&](Index k) {
    return Vec2(s.x[static_cast<std::size_t>(k)].x(), s.x[static_cast<std::size_t>(k)].y());
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      for (const Triangle& t :
           {Triangle{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, Triangle{at(i, j), at(i + 1, j + 1), at(i, j + 1)}}) {
        s.mesh.triangles.push_back(t);
        s.mesh.uv.push_back({uv(t[0]), uv(t[1]), uv(t[2])});
        s.mesh.panel.push_back(0);
      }
  s.mesh.particle_count = static_cast<Index>(s.x.size());
  s.mesh.panel_names = {"sheet"};
  return s;
}

TEST(Gauge, OfEvenlyStretchedClothIsItsStretchAtAnyMesh) {
  for (const double edge : {0.003, 0.01, 0.03}) {
    Sheet s = sheet(12, 9, edge);
    for (Vec3& p : s.x) p.x() *= 1.07;
    const StretchStatistics measured = measure_stretch(s.mesh, s.x, {});
    EXPECT_NEAR(measured.gauge_max, 0.07, 1e-12) << edge;
    EXPECT_NEAR(measured.gauge_p99, 0.07, 1e-12) << edge;
    EXPECT_NEAR(measured.ring.worn_m / measured.ring.cut_m, 1.07, 1e-12);
    EXPECT_NEAR(measured.ring.cut_m, 12 * edge, 1e-12);
    EXPECT_FALSE(measured.ring.closed);
  }
}

TEST(Gauge, OneSmallTriangleIsNotTheClothAndASqueezedOneHidesNothing) {
  Sheet s = sheet(20, 20, 0.002);
  std::vector<double> stretch(s.mesh.triangles.size(), 0);
  stretch[400] = 0.4;
  EXPECT_LT(gauge_stretch(s.mesh, stretch, {})[400], 0.02);
  std::vector<double> even(stretch.size(), 0.1);
  even[401] = -0.9;
  EXPECT_GT(gauge_stretch(s.mesh, even, {})[400], 0.095);
  std::vector<char> left_out(stretch.size(), 1);
  left_out[10] = 0;
  stretch[10] = 0.3;
  const std::vector<double> alone = gauge_stretch(s.mesh, stretch, left_out);
  EXPECT_DOUBLE_EQ(alone[10], 0.3);
  EXPECT_EQ(alone[400], 0) << "left out";
  s.mesh.panel[11] = 1;  // another panel is another cloth
  EXPECT_DOUBLE_EQ(gauge_stretch(s.mesh, stretch, left_out)[10], 0.3);
}

TEST(Gauge, TheRingOfATubeComesRoundAndIsItsGirth) {
  const int around = 24;
  Sheet s = sheet(around, 4, 0.02);
  for (Triangle& t : s.mesh.triangles)
    for (Index& i : t)
      if (i % (around + 1) == around) i -= around;
  const double radius = 1.1 * around * 0.02 / (2 * std::acos(-1.0));
  for (Vec3& p : s.x) {
    const double angle = p.x() / (around * 0.02) * 2 * std::acos(-1.0);
    p = Vec3(radius * std::cos(angle), p.y(), radius * std::sin(angle));
  }
  const ClothRing ring = cloth_ring(s.mesh, s.x, 50, Vec3::UnitY());
  EXPECT_TRUE(ring.closed);
  EXPECT_NEAR(ring.cut_m, around * 0.02, 1e-9);
  EXPECT_NEAR(ring.worn_m, 1.1 * around * 0.02, 5e-3);
  EXPECT_EQ(cloth_ring(s.mesh, s.x, 50, Vec3::Zero()).cut_m, 0);

  const auto block_at = [&](const Vec3& middle) {
    SolidMesh body = block({0.1, 1, 0.12});
    for (Vec3& p : body.positions) p += middle;
    return body;
  };
  const SolidMesh within = block_at({0.01, 0, 0}), beside = block_at({0.3, 0, 0});
  EXPECT_NEAR(girth_within_m(ring, within.positions, within.triangles), 0.44, 1e-9);
  EXPECT_EQ(girth_within_m(ring, beside.positions, beside.triangles), 0) << "a trunk beside a sleeve";
  SolidMesh legs;
  for (const double aside : {-0.05, 0.05}) {
    const SolidMesh leg = block({0.04, 1, 0.12});
    const auto first = static_cast<Index>(legs.positions.size());
    for (const Vec3& p : leg.positions) legs.positions.push_back(p + Vec3(aside, 0, 0));
    for (const auto& [i, j, k] : leg.triangles) legs.triangles.push_back({i + first, j + first, k + first});
  }
  EXPECT_NEAR(girth_within_m(ring, legs.positions, legs.triangles), 2 * (0.14 + 0.12), 1e-9);
  ClothRing open = ring;
  open.closed = false;
  EXPECT_EQ(girth_within_m(open, within.positions, within.triangles), 0) << "a cape goes round nothing";
}

}  // namespace
}  // namespace toile::internal
