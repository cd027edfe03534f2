#include "mesh/check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace toile::internal {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string complaint(const std::function<void()>& check) {
  try {
    check();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

// Two triangles of a unit square.
struct Square {
  Vec3s x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};

  std::string complaint() const {
    return toile::internal::complaint([&] { check_triangles("m.obj", x, triangles); });
  }
};

TEST(CheckTriangles, AcceptsASquare) { EXPECT_EQ(Square().complaint(), "none"); }

TEST(CheckTriangles, RefusesNoTriangles) {
  EXPECT_EQ(complaint([] { check_triangles("m.obj", {}, {}); }),
            "m.obj: mesh: expected at least one triangle, got none");
}

TEST(CheckTriangles, NamesTheTriangleWhoseCornerDoesNotExist) {
  Square square;
  square.triangles[1][2] = 4;
  EXPECT_EQ(square.complaint(), "m.obj: triangle 1: expected a corner in 0..3, got 4");
  square.triangles[1][2] = -1;
  EXPECT_EQ(square.complaint(), "m.obj: triangle 1: expected a corner in 0..3, got -1");
  square.triangles[1][2] = std::numeric_limits<Index>::max();
  EXPECT_EQ(square.complaint(), "m.obj: triangle 1: expected a corner in 0..3, got 2147483647");
}

TEST(CheckTriangles, NamesTheTriangleThatUsesACornerTwice) {
  Square square;
  square.triangles[1] = {0, 2, 0};
  EXPECT_EQ(square.complaint(), "m.obj: triangle 1: expected three different corners, got 0, 2, 0");
}

TEST(CheckTriangles, NamesTheParticleThatIsNowhere) {
  Square square;
  square.x[2].y() = nan;
  EXPECT_EQ(square.complaint(), "m.obj: particle 2: expected a finite position, got (1, nan, 0)");
  square.x[2].y() = -infinity;
  EXPECT_EQ(square.complaint(), "m.obj: particle 2: expected a finite position, got (1, -inf, 0)");
}

TEST(CheckTriangles, NamesTheFirstRepetitionOfATriangle) {
  Square square;
  square.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 0, 2}, {1, 2, 0}};
  EXPECT_EQ(
      square.complaint(),
      "m.obj: triangle 2: expected three corners that no other triangle joins, got 3, 0, 2 again, as in triangle 1");
}

TEST(CheckTriangles, NamesTheFirstOfSeveralRepetitions) {
  Square square;
  square.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 3}, {0, 1, 2}};
  EXPECT_NE(square.complaint().find("triangle 2: "), std::string::npos);
  square.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}};
  EXPECT_NE(square.complaint().find("triangle 2: "), std::string::npos);
}

TEST(CheckTriangles, FindsARepetitionInTheOtherWinding) {
  Square square;
  square.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}};
  EXPECT_EQ(
      square.complaint(),
      "m.obj: triangle 2: expected three corners that no other triangle joins, got 2, 1, 0 again, as in triangle 0");
}

TEST(CheckTriangles, NamesTheEdgeOfThreeTriangles) {
  Square square;
  square.x.push_back(Vec3(0.5, 0.5, 1));
  square.triangles.push_back({0, 2, 4});
  EXPECT_EQ(square.complaint(), "m.obj: edge 0-2: expected one or two triangles, got 3: triangles 0, 1, 2");
}

TEST(CheckTriangles, NamesFourTrianglesOfACrowdedEdgeAtMost) {
  Square square;
  for (Index i = 4; i < 10; ++i) {
    square.x.push_back(Vec3(0.5, 0.5, i));
    square.triangles.push_back({0, 2, i});
  }
  EXPECT_EQ(square.complaint(), "m.obj: edge 0-2: expected one or two triangles, got 8: triangles 0, 1, 2, 3, ...");
}

TEST(CheckTriangles, NamesTheEdgeBetweenAFlippedTriangleAndItsNeighbour) {
  Square square;
  square.triangles[1] = {0, 3, 2};
  EXPECT_EQ(square.complaint(),
            "m.obj: edge 0-2: expected two triangles that walk it in opposite directions, got triangles 0 and 1 in the "
            "same direction (one of them is flipped)");
}

TEST(CheckTriangles, NamesAParticleOutsideAllTriangles) {
  Square square;
  square.x.insert(square.x.begin() + 1, Vec3(5, 5, 5));
  square.triangles = {{0, 2, 3}, {0, 3, 4}};
  EXPECT_EQ(square.complaint(),
            "m.obj: particle 1: expected a particle that some triangle uses, got one in no triangle");
}

struct Cloth : Square {
  ClothMesh mesh;

  Cloth() {
    mesh.particle_count = 4;
    mesh.triangles = triangles;
    mesh.uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}, {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)}};
    mesh.panel = {0, 1};
    mesh.panel_names = {"front", "back"};
  }
  std::string complaint() const {
    return toile::internal::complaint([&] { check_cloth("shirt", mesh, x); });
  }
};

TEST(CheckCloth, AcceptsASquare) { EXPECT_EQ(Cloth().complaint(), "none"); }

TEST(CheckCloth, ChecksTheSurfaceToo) {
  Cloth cloth;
  cloth.x[3].z() = nan;
  EXPECT_EQ(cloth.complaint(), "shirt: particle 3: expected a finite position, got (0, 1, nan)");
}

TEST(CheckCloth, NamesTheTriangleWithoutPatternCoordinates) {
  Cloth cloth;
  cloth.mesh.uv[1][2].x() = infinity;
  EXPECT_EQ(cloth.complaint(),
            "shirt: triangle 1 of panel \"back\": expected finite pattern coordinates, got (inf, 1) at corner 2");
}

TEST(CheckCloth, NamesTheTriangleThatIsFlippedInThePattern) {
  Cloth cloth;
  std::swap(cloth.mesh.uv[1][1], cloth.mesh.uv[1][2]);
  EXPECT_EQ(cloth.complaint(),
            "shirt: triangle 1 of panel \"back\": expected a positive area in the pattern, got -0.5 m^2 (clockwise: "
            "flipped)");
}

TEST(CheckCloth, NamesTheTriangleWithoutArea) {
  Cloth cloth;
  cloth.mesh.uv[0] = {Vec2(0, 0), Vec2(0.5, 0.5), Vec2(1, 1)};
  EXPECT_EQ(
      cloth.complaint(),
      "shirt: triangle 0 of panel \"front\": expected a positive area in the pattern, got 0 m^2 (its corners lie on "
      "one line)");
  cloth.mesh.uv[0] = {Vec2(0.1, 0.1), Vec2(0.1, 0.1), Vec2(0.1, 0.1)};
  EXPECT_NE(cloth.complaint(), "none");
  // Rounding noise of an area, in whatever units.
  for (const double unit : {1e-6, 1.0, 1e6}) {
    cloth.mesh.uv[0] = {Vec2(0, 0), Vec2(unit, 0), Vec2(0.5 * unit, 1e-14 * unit)};
    EXPECT_NE(cloth.complaint(), "none") << unit;
  }
}

TEST(CheckCloth, AcceptsASmallTriangle) {
  Cloth cloth;
  for (auto& uv : cloth.mesh.uv) {
    for (Vec2& corner : uv) corner *= 1e-9;
  }
  EXPECT_EQ(cloth.complaint(), "none");
}

TEST(CheckCloth, RefusesAnAreaThatOverflows) {
  Cloth cloth;
  for (Vec2& corner : cloth.mesh.uv[0]) corner *= 1e200;
  EXPECT_NE(cloth.complaint(), "none");
}

TEST(CheckCloth, NamesTheArrayOfTheWrongLength) {
  Cloth cloth;
  cloth.mesh.particle_count = 5;
  EXPECT_EQ(cloth.complaint(), "shirt: positions: expected 5 entries, got 4");
  cloth = Cloth();
  cloth.mesh.uv.pop_back();
  EXPECT_EQ(cloth.complaint(), "shirt: uv: expected 2 entries, got 1");
  cloth = Cloth();
  cloth.mesh.panel.clear();
  EXPECT_EQ(cloth.complaint(), "shirt: panel: expected 2 entries, got 0");
  cloth = Cloth();
  cloth.mesh.panel[1] = 2;
  EXPECT_EQ(cloth.complaint(), "shirt: triangle 1: expected one of the 2 panels, got panel 2");
}

struct Tetrahedron {
  Vec3s x = {Vec3(1, 1, 1), Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1)};
  std::vector<Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

  std::string complaint() const {
    return toile::internal::complaint([&] { check_closed("body.obj", x, triangles); });
  }
};

TEST(CheckClosed, AcceptsATetrahedronWhereverItIs) {
  Tetrahedron body;
  EXPECT_EQ(body.complaint(), "none");
  for (int direction = 0; direction < 8;
       ++direction) {  // the volume from the origin would be rounding noise of any sign
    const Vec3 far(direction & 1 ? 1e5 : -1e5, direction & 2 ? 1e5 : -1e5, direction & 4 ? 1e5 : -1e5);
    body = Tetrahedron();
    for (Vec3& x : body.x) x = 1e-3 * x + far / 3;
    EXPECT_EQ(body.complaint(), "none") << direction;
  }
}

TEST(CheckClosed, NamesTheEdgeOfAHole) {
  Tetrahedron body;
  body.triangles.pop_back();
  EXPECT_EQ(body.complaint(),
            "body.obj: edge 0-2: expected two triangles, got only triangle 0 (the surface has a hole)");
}

TEST(CheckClosed, RefusesABodyTurnedInsideOut) {
  Tetrahedron body;
  for (Triangle& triangle : body.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(
      body.complaint(),
      "body.obj: mesh: expected triangles that face outwards around a positive volume, got -2.66667 (turned inside "
      "out)");
}

TEST(CheckClosed, RefusesAFlatBody) {
  for (int slope = 0; slope < 20; ++slope) {  // the noise of some is positive
    Tetrahedron body;
    for (Vec3& x : body.x) x = Vec3(x.x() / 3, x.y() / 7, 0.1 * slope * x.x() + x.y() / 3);
    EXPECT_NE(body.complaint().find("mesh: expected triangles that face outwards"), std::string::npos)
        << body.complaint();
  }
}

TEST(CheckClosed, ChecksTheSurfaceToo) {
  Tetrahedron body;
  body.x[1].x() = nan;
  EXPECT_EQ(body.complaint(), "body.obj: particle 1: expected a finite position, got (nan, -1, 1)");
}

}  // namespace
}  // namespace toile::internal
