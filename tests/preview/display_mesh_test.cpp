#include "preview/display_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "preview/cloth_look.hpp"
#include "preview/pictures.hpp"

namespace toile::internal {
namespace {

// A square of `side` m in n x n cells, right side to +z; drawn in two panels that are sewn at x = 0 where `panels` is 2.
Sheet gridded(int n, double side, int panels = 1) {
  Sheet s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) s.positions.push_back(Vec3(side * (double(i) / n - 0.5), side * double(j) / n, 0));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      const double apart = panels == 2 && 2 * i >= n ? 0.5 : 0;
      for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
        s.triangles.push_back(t);
        std::array<Vec2, 3> uv;
        for (std::size_t k = 0; k < 3; ++k) uv[k] = s.positions[at(t[k])].head<2>() + Vec2(apart, 0);
        s.uv.push_back(uv);
      }
    }
  return s;
}

ClothLook plain_look() {
  ClothLook look;
  look.thickness_m = 1e-3f;
  look.hem_m = 0.02f;
  return look;
}

DisplayMesh shown(const Sheet& s, const ClothLook& look, double edge_m) {
  const std::vector<const ClothLook*> looks(s.triangles.size(), &look);
  return display_mesh(cloth_of(s), looks, edge_m);
}

TEST(DisplayMesh, IsClosedAndAsThickAsItsLayers) {
  const Sheet square = gridded(8, 0.2);
  const ClothLook look = plain_look();
  for (const double edge_m : {1.0, 0.01}) {
    const DisplayMesh mesh = shown(square, look, edge_m);
    // The two sheets face alike, so the inner one counts the other way round.
    std::map<std::array<double, 6>, int> sides;
    std::size_t border = 0;
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3 a = mesh.positions[at(t[k])], b = mesh.positions[at(t[(k + 1) % 3])];
        if (std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end())) std::swap(a, b);
        ++sides[{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
      }
    for (const auto& [edge, count] : sides) border += count != 2;
    EXPECT_EQ(border, 0u) << edge_m;
    double low = 1, high = -1, in_the_middle = 1;
    for (const Vec3& x : mesh.positions) {
      low = std::min(low, x.z());
      high = std::max(high, x.z());
      if (Vec2(x.x(), x.y() - 0.1).norm() < 0.05) in_the_middle = std::min(in_the_middle, x.z());
    }
    EXPECT_NEAR(high, 0.5e-3, 1e-9);
    EXPECT_NEAR(in_the_middle, -0.5e-3, 1e-9);
    EXPECT_NEAR(low, -2.5e-3, 1e-9) << "three layers where the hem is";
  }
}

TEST(DisplayMesh, SubdivisionSmoothsASphereAndKeepsTheDrawing) {
  Sheet ball = sphere(Vec3::Zero(), 0.1, 8);
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    ball.uv.push_back({Vec2(double(t), 0), Vec2(double(t) + 0.5, 0), Vec2(double(t), 0.5)});
  ClothLook look = plain_look();
  look.thickness_m = 0;
  const DisplayMesh mesh = shown(ball, look, 0.008);
  ASSERT_GE(mesh.triangles.size(), 2 * 16 * ball.triangles.size());
  double sharpest = 1;
  for (std::size_t t = 0; t < 16 * ball.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const Vec3 n = (mesh.positions[at(c[1])] - mesh.positions[at(c[0])])
                       .cross(mesh.positions[at(c[2])] - mesh.positions[at(c[0])]);
    const Vec3 middle = (mesh.positions[at(c[0])] + mesh.positions[at(c[1])] + mesh.positions[at(c[2])]) / 3;
    if (std::abs(middle.y()) < 0.05) sharpest = std::min(sharpest, n.normalized().dot(middle.normalized()));
    const Index source = mesh.source[t];
    for (const Vec2& uv : mesh.uv[t]) {
      EXPECT_GE(uv.x(), double(source));
      EXPECT_LE(uv.x() + uv.y(), double(source) + 0.5 + 1e-12);
    }
  }
  EXPECT_GT(sharpest, 0.99) << "rings of 22 degrees, four times finer";
}

// Folded along the middle: pressed, the crease stays where it is; a soft bend is rounded.
TEST(DisplayMesh, PressedFoldsStaySharpAndSoftOnesAreRounded) {
  const auto off_the_line = [](double fold_deg) {
    Sheet square = gridded(8, 0.2);
    const double angle = fold_deg * 3.14159265358979323846 / 180;
    for (Vec3& x : square.positions)
      if (x.x() > 0) x = Vec3(x.x() * std::cos(angle), x.y(), x.x() * std::sin(angle));
    ClothLook look = plain_look();
    look.thickness_m = 0;
    const DisplayMesh mesh = shown(square, look, 0.008);
    double off = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(mesh.uv[t][k].x()) < 1e-9)
          off = std::max(off, mesh.positions[at(mesh.triangles[t][k])].cwiseProduct(Vec3(1, 0, 1)).norm());
    return off;
  };
  EXPECT_LT(off_the_line(150), 1e-9);
  EXPECT_GT(off_the_line(40), 1e-3);
  EXPECT_GT(off_the_line(85), 1e-4) << "in between, both";
  EXPECT_LT(off_the_line(85), off_the_line(60));
}

TEST(DisplayMesh, DistancesAreThoseOfTheDrawing) {
  const Sheet square = gridded(10, 0.2, 2);
  const DisplayMesh mesh = shown(square, plain_look(), 1.0);
  int beside_the_seam = 0;
  for (std::size_t t = 0; t < square.triangles.size(); ++t) {
    // In the middle, and 1 to 2 mm from each corner.
    const auto inside = [&](std::size_t k, auto&& of) {
      const auto middle = ((of(0) + of(1) + of(2)) / 3).eval();
      return k == 3 ? middle : (0.9 * of(k) + 0.1 * middle).eval();
    };
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2 uv = inside(k, [&](std::size_t c) -> Vec2 { return square.uv[t][c]; });
      const Vec3 x = inside(k, [&](std::size_t c) -> Vec3 { return square.positions[at(square.triangles[t][c])]; });
      const double open_m = std::min(0.1 - std::abs(x.x()), std::min(x.y(), 0.2 - x.y()));
      const EdgeDistance distance = edge_distance(mesh, static_cast<Index>(t), uv);
      // Farther than its hem an edge may be left out.
      if (open_m < 0.02) {
        EXPECT_NEAR(distance.open_m, open_m, 1e-12) << t;
      }
      EXPECT_GE(distance.open_m, open_m - 1e-12) << t;
      if (std::abs(x.x()) < 0.003) {
        ++beside_the_seam;
        EXPECT_NEAR(distance.sewn_m, std::abs(x.x()), 1e-12) << t;
      }
      EXPECT_GE(distance.sewn_m, std::abs(x.x()) - 1e-12);
    }
  }
  EXPECT_GT(beside_the_seam, 20);
}

TEST(DisplayMesh, ACornerThatIsNotFiniteIsNotSpread) {
  Sheet square = gridded(4, 0.2);
  square.positions[12].x() = std::numeric_limits<double>::quiet_NaN();
  const DisplayMesh mesh = shown(square, plain_look(), 0.005);
  EXPECT_EQ(mesh.source.size(), mesh.triangles.size());
  std::size_t finite = 0;
  for (const Vec3& x : mesh.positions) finite += x.allFinite();
  EXPECT_GT(finite, mesh.positions.size() / 2);
}

}  // namespace
}  // namespace toile::internal
