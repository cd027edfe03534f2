// Surfaces as files hold them: each fault is made in a good one, and mended.
#include "mesh/triangle_repair.hpp"

#include "mesh/surface_parts.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace toile::internal {
namespace {

constexpr Index around = 12;

// A barrel along y from 0 to 1, of radius 0.2, with two poles: rings 0 .. rings-1, then the lower and the upper pole.
struct Barrel {
  Vec3s x;
  MendedTriangles mesh;
  Index rings;

  explicit Barrel(Index ring_count = 6) : rings(ring_count) {
    for (Index r = 0; r < rings; ++r)
      for (Index k = 0; k < around; ++k) {
        const double angle = 2 * std::numbers::pi * k / around;
        x.emplace_back(0.2 * std::sin(angle), static_cast<double>(r + 1) / (rings + 1), 0.2 * std::cos(angle));
      }
    x.emplace_back(0, 0, 0);
    x.emplace_back(0, 1, 0);
    for (Index k = 0; k < around; ++k) {
      const Index next = (k + 1) % around;
      add({rings * around, next, k});
      add({rings * around + 1, (rings - 1) * around + k, (rings - 1) * around + next});
      for (Index r = 0; r + 1 < rings; ++r) {
        const Index a = r * around + k, b = r * around + next, c = a + around, d = b + around;
        add({a, b, d});
        add({a, d, c});
      }
    }
  }
  void add(const Triangle& t) {
    mesh.source.push_back(static_cast<Index>(mesh.triangles.size()));
    mesh.triangles.push_back(t);
  }
  // Without the triangles of a vertex.
  void cut_out(Index v) {
    MendedTriangles kept;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), v) > 0) continue;
      kept.triangles.push_back(mesh.triangles[t]);
      kept.source.push_back(mesh.source[t]);
    }
    mesh = kept;
  }
  SurfacePart only_part() const {
    const SurfaceParts found = surface_parts(mesh.triangles, x);
    EXPECT_EQ(found.parts.size(), 1u);
    return found.parts.at(0);
  }
  double volume() const { return only_part().volume_m3; }
};

const double full = Barrel().volume();

TEST(TriangleRepair, LeavesAGoodSurfaceAsItIs) {
  Barrel barrel;
  const auto before = barrel.mesh.triangles;
  ASSERT_TRUE(barrel.only_part().closed);
  ASSERT_GT(full, 0.09);
  const MendedCorners corners = mend_corners(barrel.mesh, barrel.x, 1e-5);
  EXPECT_EQ(corners.welded + corners.degenerate + corners.duplicate + corners.flat, 0u);
  const MendedPart part = mend_part(barrel.mesh, barrel.x);
  EXPECT_TRUE(part.closed());
  EXPECT_EQ(part.walls + part.turned + part.capped.size(), 0u);
  EXPECT_EQ(barrel.mesh.triangles, before);
}

TEST(TriangleRepair, WeldsASoupWhoseDigitsAreRoundedAndWhoseTrianglesFaceAnyWay) {
  const Barrel good;
  Barrel soup;
  soup.x.clear();
  soup.mesh.triangles.clear();
  for (std::size_t t = 0; t < good.mesh.triangles.size(); ++t) {
    const auto first = static_cast<Index>(soup.x.size());
    for (std::size_t k = 0; k < 3; ++k)
      soup.x.push_back(good.x[at(good.mesh.triangles[t][k])] + Vec3::Constant(t % 2 == 0 ? 2e-6 : -1e-6));
    soup.mesh.triangles.push_back({first, first + 1, first + 2});
    if (t % 5 == 0) std::swap(soup.mesh.triangles.back()[0], soup.mesh.triangles.back()[2]);
  }
  const MendedCorners corners = mend_corners(soup.mesh, soup.x, 1e-5);
  EXPECT_EQ(corners.welded, soup.x.size() - good.x.size());
  const MendedPart part = mend_part(soup.mesh, soup.x);
  EXPECT_TRUE(part.closed());
  EXPECT_EQ(part.turned, (good.mesh.triangles.size() + 4) / 5);
  EXPECT_TRUE(soup.only_part().closed);
  EXPECT_NEAR(soup.volume(), full, 1e-4 * full);
}

TEST(TriangleRepair, DropsTrianglesWithACornerTwiceAndThoseThatAreThereAlready) {
  Barrel barrel;
  const std::size_t good = barrel.mesh.triangles.size();
  barrel.add({3, 3, 4});
  const Triangle again = barrel.mesh.triangles[10];
  barrel.add({again[1], again[2], again[0]});
  barrel.add({again[1], again[0], again[2]});
  const MendedCorners corners = mend_corners(barrel.mesh, barrel.x, 1e-5);
  EXPECT_EQ(corners.degenerate, 1u);
  EXPECT_EQ(corners.duplicate, 2u);
  EXPECT_EQ(barrel.mesh.triangles.size(), good);
  EXPECT_TRUE(barrel.only_part().closed);
}

TEST(TriangleRepair, TurnsSingleTrianglesAndAllOfThem) {
  Barrel one;
  std::swap(one.mesh.triangles[7][0], one.mesh.triangles[7][1]);
  EXPECT_EQ(mend_part(one.mesh, one.x).turned, 1u);
  EXPECT_NEAR(one.volume(), full, 1e-12);
  Barrel all;
  for (Triangle& t : all.mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(mend_part(all.mesh, all.x).turned, all.mesh.triangles.size());
  EXPECT_TRUE(all.only_part().closed);
  EXPECT_NEAR(all.volume(), full, 1e-12);
}

TEST(TriangleRepair, TakesWallsOutWhicheverWayTheyFace) {
  for (const bool turned : {false, true}) {
    Barrel barrel;
    const std::size_t good = barrel.mesh.triangles.size();
    const auto before = barrel.mesh.triangles;
    for (Index k = 1; k + 1 < around; ++k) {  // across the third ring
      const Index first = 2 * around;
      barrel.add(turned ? Triangle{first, first + k, first + k + 1} : Triangle{first, first + k + 1, first + k});
    }
    const MendedPart part = mend_part(barrel.mesh, barrel.x);
    EXPECT_EQ(part.walls, at(around) - 2);
    EXPECT_TRUE(part.closed());
    EXPECT_EQ(barrel.mesh.triangles.size(), good);
    EXPECT_EQ(barrel.mesh.triangles, before);
  }
}

TEST(TriangleRepair, CapsSmallHolesAndSaysHowRoundTheyAre) {
  Barrel barrel(30);
  for (Vec3& p : barrel.x) p.y() *= 2;
  const double whole = barrel.volume();
  const Index upper_pole = barrel.rings * around + 1, on_side = 4 * around + 3;
  barrel.cut_out(upper_pole);
  barrel.cut_out(on_side);
  ASSERT_FALSE(barrel.only_part().closed);
  const MendedPart part = mend_part(barrel.mesh, barrel.x);
  ASSERT_TRUE(part.closed());
  ASSERT_EQ(part.capped.size(), 2u);
  const auto [side, top] = std::minmax_element(part.capped.begin(), part.capped.end(),
                                               [](const Hole& l, const Hole& r) { return l.girth < r.girth; });
  EXPECT_NEAR(top->girth, 24 * 0.2 * std::sin(std::numbers::pi / 12), 1e-12);
  EXPECT_NEAR(top->middle.y(), 60.0 / 31.0, 1e-12);
  EXPECT_EQ(side->loop.size(), 6u);
  EXPECT_TRUE(barrel.only_part().closed);
  EXPECT_NEAR(barrel.volume(), whole, 0.02 * whole);
  EXPECT_EQ(std::count(barrel.mesh.source.begin(), barrel.mesh.source.end(), -1), around - 2 + 4);
  for (const Triangle& t : barrel.mesh.triangles)
    EXPECT_FALSE(is_flat({barrel.x[at(t[0])], barrel.x[at(t[1])], barrel.x[at(t[2])]}));
}

TEST(TriangleRepair, CapsAHoleWhoseRimIsNotConvex) {
  // A box whose top lacks an L: rim (0,0) (3,0) (3,1) (1,1) (1,3) (0,3) in a lid of 10 by 10.
  Vec3s x;
  MendedTriangles mesh;
  constexpr Index n = 11;
  const auto top = [](Index i, Index j) { return i * n + j; };
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) x.emplace_back(i, 0, -j);
  x[at(top(5, 4))].x() = 4.5;  // the cut across the corner that is not convex is the shortest
  x[at(top(4, 5))].z() = -4.5;
  x.emplace_back(5, -8, -5);
  const Index apex = n * n;
  const auto add = [&](const Triangle& t) {
    mesh.triangles.push_back(t);
    mesh.source.push_back(static_cast<Index>(mesh.source.size()));
  };
  const auto in_hole = [](Index i, Index j) { return (i >= 3 && i < 6 && j == 3) || (i == 3 && j >= 3 && j < 6); };
  for (Index i = 0; i + 1 < n; ++i)
    for (Index j = 0; j + 1 < n; ++j) {
      if (in_hole(i, j)) continue;
      add({top(i, j), top(i + 1, j), top(i + 1, j + 1)});
      add({top(i, j), top(i + 1, j + 1), top(i, j + 1)});
    }
  for (Index k = 0; k + 1 < n; ++k) {
    add({apex, top(k + 1, 0), top(k, 0)});
    add({apex, top(k, n - 1), top(k + 1, n - 1)});
    add({apex, top(0, k), top(0, k + 1)});
    add({apex, top(n - 1, k + 1), top(n - 1, k)});
  }
  const MendedPart part = mend_part(mesh, x);
  ASSERT_TRUE(part.closed());
  ASSERT_EQ(part.capped.size(), 1u);
  EXPECT_NEAR(part.capped[0].girth, 12, 1e-12);
  const SurfaceParts found = surface_parts(mesh.triangles, x);
  EXPECT_TRUE(found.parts[0].closed);
  EXPECT_NEAR(found.parts[0].volume_m3, 100.0 * 8 / 3, 1e-9);
  double capped = 0;  // no part of the lid twice
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.source[t] >= 0) continue;
    const auto [a, b, c] = mesh.triangles[t];
    const Vec3 normal = 0.5 * (x[at(b)] - x[at(a)]).cross(x[at(c)] - x[at(a)]);
    EXPECT_GT(normal.y(), 0);
    capped += normal.norm();
  }
  EXPECT_NEAR(capped, 5, 1e-12);
}

TEST(TriangleRepair, LeavesTheRimOfASheetAndOfABowlOpen) {
  Vec3s x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 1), Vec3(0, 0, 1)};
  MendedTriangles sheet{{{0, 2, 1}, {0, 3, 2}}, {0, 1}};
  const MendedPart part = mend_part(sheet, x);
  EXPECT_FALSE(part.closed());
  ASSERT_EQ(part.open.size(), 1u);
  EXPECT_NEAR(part.open[0].girth, 4, 1e-12);
  EXPECT_EQ(sheet.triangles.size(), 2u);
  Barrel bowl(2);
  bowl.cut_out(2 * around + 1);
  EXPECT_FALSE(mend_part(bowl.mesh, bowl.x).closed());
}

TEST(TriangleRepair, ASheetLooksWhereMostOfItsTrianglesDid) {
  for (const std::size_t flipped : {0u, 5u}) {  // the first triangle is one of them, or is not
    Vec3s x;
    MendedTriangles sheet;
    for (Index i = 0; i < 4; ++i)
      for (Index j = 0; j < 2; ++j) x.emplace_back(i, 0, -j);
    for (Index a = 0; a < 6; a += 2) {
      sheet.triangles.insert(sheet.triangles.end(), {Triangle{a, a + 2, a + 3}, Triangle{a, a + 3, a + 1}});
      sheet.source.insert(sheet.source.end(), {a, a + 1});
    }
    const std::vector<Triangle> good = sheet.triangles;
    std::swap(sheet.triangles[flipped][1], sheet.triangles[flipped][2]);
    const MendedPart mended = mend_part(sheet, x);
    EXPECT_EQ(mended.open.size(), 1u);
    EXPECT_EQ(mended.turned, 1u);
    for (std::size_t t = 0; t < good.size(); ++t) {
      const auto& [a, b, c] = sheet.triangles[t];
      EXPECT_GT((x[at(b)] - x[at(a)]).cross(x[at(c)] - x[at(a)]).y(), 0) << t;
    }
  }
}

TEST(TriangleRepair, NamesTheEdgeOfAMoebiusStripAndOneWhereTwoSolidsTouch) {
  Vec3s x;
  MendedTriangles strip;
  constexpr Index n = 20;
  for (Index i = 0; i < n; ++i)
    for (const double s : {-0.1, 0.1}) {
      const double a = 2 * std::numbers::pi * i / n;
      const Vec3 out(std::cos(a), 0, std::sin(a));
      x.push_back(out + s * (std::cos(a / 2) * Vec3::UnitY() + std::sin(a / 2) * out));
    }
  for (Index i = 0; i < n; ++i) {
    const Index a = 2 * i, b = 2 * i + 1;
    const Index c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? b + 2 : 0;
    strip.triangles.push_back({a, c, d});
    strip.triangles.push_back({a, d, b});
    strip.source.insert(strip.source.end(), {2 * i, 2 * i + 1});
  }
  EXPECT_GE(mend_part(strip, x).one_sided[0], 0);

  // Two tetrahedra on one edge.
  x = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(1, 0, 1), Vec3(-1, 0, 0), Vec3(-1, 0, -1)};
  MendedTriangles touching{{{0, 1, 2}, {1, 0, 3}, {0, 2, 3}, {1, 3, 2}, {0, 1, 4}, {1, 0, 5}, {0, 4, 5}, {1, 5, 4}},
                           {0, 1, 2, 3, 4, 5, 6, 7}};
  const MendedPart part = mend_part(touching, x);
  EXPECT_FALSE(part.closed());
  EXPECT_EQ(part.crowded, (std::array<Index, 2>{0, 1}));
}

TEST(TriangleRepair, GivesAFlatTriangleAnotherDiagonal) {
  // The middle of side 0-1 is a vertex of the triangle below, and of a flat one above.
  Barrel barrel;
  const Triangle cut = barrel.mesh.triangles[2];
  const auto [a, b, c] = cut;
  const auto m = static_cast<Index>(barrel.x.size());
  barrel.x.push_back(0.5 * (barrel.x[at(a)] + barrel.x[at(b)]));
  barrel.mesh.triangles[2] = {a, m, c};
  barrel.add({m, b, c});
  barrel.add({a, b, m});  // flat
  ASSERT_TRUE(barrel.only_part().closed);
  const double volume = barrel.volume();
  const MendedCorners corners = mend_corners(barrel.mesh, barrel.x, 1e-5);
  EXPECT_EQ(corners.flat, 1u);
  EXPECT_TRUE(barrel.only_part().closed);
  EXPECT_NEAR(barrel.volume(), volume, 1e-12);
  for (const Triangle& t : barrel.mesh.triangles)
    EXPECT_FALSE(is_flat({barrel.x[at(t[0])], barrel.x[at(t[1])], barrel.x[at(t[2])]}));
  // Without the flat one there is a crack, which is a hole that is closed likewise.
  Barrel cracked;
  cracked.x.push_back(barrel.x[at(m)]);
  cracked.mesh.triangles[2] = {a, m, c};
  cracked.add({m, b, c});
  const MendedPart part = mend_part(cracked.mesh, cracked.x);
  EXPECT_TRUE(part.closed());
  EXPECT_TRUE(cracked.only_part().closed);
  for (const Triangle& t : cracked.mesh.triangles)
    EXPECT_FALSE(is_flat({cracked.x[at(t[0])], cracked.x[at(t[1])], cracked.x[at(t[2])]}));
}

}  // namespace
}  // namespace toile::internal
