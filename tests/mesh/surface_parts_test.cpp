#include "mesh/surface_parts.hpp"

#include "support/box.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace toile::internal {
namespace {

// A box of the given edge, its smallest corner at `low`; inside out if asked.
void add_box(std::vector<Vec3>& x, std::vector<Triangle>& triangles, const Vec3& low, double edge_m, bool inwards) {
  const auto first = static_cast<Index>(x.size());
  for (const double y : {0.0, edge_m})
    for (const double z : {0.0, edge_m})
      for (const double u : {0.0, edge_m}) x.push_back(low + Vec3(u, y, z));
  for (auto [a, b, c] : test::box_triangles) {
    if (inwards) std::swap(b, c);
    triangles.push_back({a + first, b + first, c + first});
  }
}

TEST(SurfaceParts, SayWhatEachEnclosesAndWhetherItIsClosed) {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  add_box(x, triangles, Vec3(100, 0, 0), 0.5, false);
  add_box(x, triangles, Vec3(0, 0, 0), 2, true);
  add_box(x, triangles, Vec3(5, 0, 0), 1, false);
  triangles.pop_back();
  x.push_back(Vec3(7, 7, 7));  // of no triangle
  const SurfaceParts found = surface_parts(triangles, x);
  ASSERT_EQ(found.parts.size(), 3u);
  EXPECT_NEAR(found.parts[0].volume_m3, 0.125, 1e-12);
  EXPECT_NEAR(found.parts[1].volume_m3, -8, 1e-12);
  EXPECT_TRUE(found.parts[0].closed && found.parts[1].closed);
  EXPECT_FALSE(found.parts[2].closed);
  ASSERT_EQ(found.of.size(), triangles.size());
  EXPECT_EQ(found.of.front(), 0);
  EXPECT_EQ(found.of[12], 1);
  EXPECT_EQ(found.of.back(), 2);
}

TEST(SurfaceParts, AFlippedTriangleOrASecondOneIsNotClosed) {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  add_box(x, triangles, Vec3::Zero(), 1, false);
  std::vector<Triangle> flipped = triangles, doubled = triangles;
  std::swap(flipped[3][0], flipped[3][1]);
  doubled.push_back(doubled[3]);
  EXPECT_TRUE(surface_parts(triangles, x).parts[0].closed);
  EXPECT_FALSE(surface_parts(flipped, x).parts[0].closed);
  EXPECT_FALSE(surface_parts(doubled, x).parts[0].closed);
}

}  // namespace
}  // namespace toile::internal
