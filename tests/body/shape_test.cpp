// The pieces under the mannequin: implicit shapes, polygonisation and the tape measure, on shapes with known answers.
#include "body/closed_mesh.hpp"
#include "body/implicit_shape.hpp"
#include "body/mannequin_shape.hpp"
#include "body/measure.hpp"
#include "body/polygonise.hpp"
#include "mesh/check.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

// The whole surface inside the cube of half-width `reach`; marched on cells of `cell`, remeshed to `edge` when
// sweeps > 0.
HalfSurface meshed(const ScalarField& field, double reach, double cell, double edge, int sweeps) {
  HalfSurface half = march_tetrahedra(field, Vec3(0, -reach, -reach), Vec3(reach, reach, reach), cell);
  const ScalarField edge_m = [edge](const Vec3&) { return edge; };
  if (sweeps > 0) remesh(half, field, edge_m, sweeps);
  return mirror(half);
}

TEST(ImplicitShape, LoftWithEqualSectionsIsAnEllipticTube) {
  const LoftSection sections[] = {
      {0, 0, 0, 0.3, 0.2, 0.1, 0}, {1, 0, 0, 0.3, 0.2, 0.1, 0}, {2, 0, 0, 0.3, 0.2, 0.1, 0}};
  const Loft tube(Vec3::Zero(), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), 0.01, sections);
  EXPECT_NEAR(tube(Vec3(0.3, 1, 0)), 0, 1e-12);
  EXPECT_NEAR(tube(Vec3(0, 0.5, 0.2)), 0, 1e-12);    // front
  EXPECT_NEAR(tube(Vec3(0, 1.5, -0.1)), 0, 1e-12);   // back
  EXPECT_NEAR(tube(Vec3(0.18, 1, 0.16)), 0, 1e-12);  // on the front's ellipse
  EXPECT_NEAR(tube(Vec3(0.35, 1, 0)), 0.05, 1e-12);
  EXPECT_LT(tube(Vec3(0, 1, 0)), -0.05);
  EXPECT_NEAR(tube(Vec3(0, 2.05, 0)), 0.05, 1e-12);  // beyond the end
}

TEST(ImplicitShape, SquarenessMovesTheDiagonalOutAndLeavesTheAxes) {
  const auto tube = [](double squareness) {
    const LoftSection sections[] = {{0, 0, 0, 1, 1, 1, squareness}, {1, 0, 0, 1, 1, 1, squareness}};
    return Loft(Vec3::Zero(), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), 0.01, sections);
  };
  const Vec3 diagonal(std::sqrt(0.5), 0.5, std::sqrt(0.5));
  EXPECT_NEAR(tube(0)(diagonal), 0, 1e-12);
  EXPECT_LT(tube(0.8)(diagonal), -0.05);
  EXPECT_NEAR(tube(0.8)(Vec3(1, 0.5, 0)), 0, 1e-12);
  // 2 t u^2 - s^2 t^2 u^4 = 1 on the diagonal u = v of the squircle, here with t = 1.
  const double s = 0.8, u = std::sqrt((1 - std::sqrt(1 - s * s)) / (s * s));
  EXPECT_NEAR(tube(s)(Vec3(u, 0.5, u)), 0, 1e-12);
}

TEST(ImplicitShape, SmoothMinimumIsSymmetricAndNeverAbove) {
  for (double a = -0.2; a < 0.2; a += 0.013)
    for (double b = -0.2; b < 0.2; b += 0.017) {
      const double m = smooth_min(a, b, 0.1);
      EXPECT_EQ(m, smooth_min(b, a, 0.1));
      EXPECT_LE(m, std::min(a, b));
      EXPECT_GE(m, std::min(a, b) - 0.1 / 6 - 1e-15);
      if (std::abs(a - b) >= 0.1) {
        EXPECT_EQ(m, std::min(a, b));
      }
    }
}

TEST(ImplicitShape, FarIsSaidOfWhatIsFartherAndOfMostThatIs) {
  const Ellipsoid ellipsoid{Vec3(0.1, 0.2, -0.1), Vec3(0.1, 0.06, 0.15)};
  const RoundCone cone{Vec3(0, 0.1, 0), Vec3(0.05, 0.12, 0.02), 0.03, 0.01};
  const auto check = [](const auto& shape) {
    int far = 0;
    for (double x = -0.8; x < 0.8; x += 0.11)
      for (double y = -0.8; y < 0.8; y += 0.09)
        for (double z = -0.8; z < 0.8; z += 0.1)
          for (const double d : {-0.05, 0.0, 0.02, 0.1}) {
            const Vec3 p(x, y, z);
            if (!shape.far(p, d)) continue;
            ++far;
            EXPECT_GT(shape(p), d) << p.transpose();
          }
    EXPECT_GT(far, 8000) << "of 18,000";
  };
  check(ellipsoid);
  check(cone);
}

TEST(ImplicitShape, MannequinsFieldIsAboutADistanceNearTheSkin) {
  // Newton's steps rely on it: the gradient is neither flat nor steep where the surface is.
  const MannequinShape shape;
  const HalfSurface rough =
      march_tetrahedra([&](const Vec3& p) { return shape(p); }, Vec3(0, -0.04, -0.24), Vec3(0.8, 1.78, 0.28), 0.03);
  double least = 10, most = 0;
  for (const Vec3& p : rough.positions) {
    Vec3 g;
    for (int d = 0; d < 3; ++d) {
      Vec3 up = p, down = p;
      up[d] += 1e-5;
      down[d] -= 1e-5;
      g[d] = (shape(up) - shape(down)) / 2e-5;
    }
    least = std::min(least, g.norm());
    most = std::max(most, g.norm());
  }
  EXPECT_GT(least, 0.3);
  EXPECT_LT(most, 3.0);
}

TEST(Polygonise, MarchedBallIsClosedAndOutwardEvenOnACoarseGrid) {
  const ScalarField ball = [](const Vec3& p) { return (p - Vec3(0, 0.01, 0.02)).norm() - 0.5; };
  for (const double cell : {0.24, 0.09, 0.04}) {
    const HalfSurface whole = meshed(ball, 0.8, cell, 0, 0);
    EXPECT_NO_THROW(check_closed("ball", whole.positions, whole.triangles));
    EXPECT_EQ(test::euler_characteristic(whole.positions.size(), whole.triangles), 2);
  }
}

TEST(Polygonise, RemeshedBallLiesOnTheBallWithWellShapedTriangles) {
  const ScalarField ball = [](const Vec3& p) { return (p - Vec3(0, 0.01, 0.02)).norm() - 0.5; };
  for (const double cell : {0.02, 0.04, 0.11}) {  // from finer and from coarser than asked
    const HalfSurface whole = meshed(ball, 0.8, cell, 0.05, 8);
    EXPECT_NO_THROW(check_closed("ball", whole.positions, whole.triangles));
    EXPECT_EQ(test::euler_characteristic(whole.positions.size(), whole.triangles), 2);
    EXPECT_GT(test::smallest_angle_degrees(whole.positions, whole.triangles), 30);
    double off = 0, length = 0, edges = 0;
    for (const Vec3& p : whole.positions) off = std::max(off, std::abs(ball(p)));
    for (const Triangle& t : whole.triangles)
      for (std::size_t k = 0; k < 3; ++k, ++edges)
        length += (whole.positions[at(t[k])] - whole.positions[at(t[(k + 1) % 3])]).norm();
    EXPECT_LT(off, 1e-7);
    EXPECT_NEAR(length / edges, 0.05, 0.006) << "cell " << cell;
  }
}

TEST(Polygonise, RemeshedTorusKeepsItsHole) {
  const ScalarField torus = [](const Vec3& p) {
    const double ring = std::sqrt(p.x() * p.x() + p.z() * p.z()) - 0.5;
    return std::sqrt(ring * ring + p.y() * p.y()) - 0.15;
  };
  const HalfSurface whole = meshed(torus, 0.8, 0.05, 0.06, 8);
  EXPECT_NO_THROW(check_closed("torus", whole.positions, whole.triangles));
  EXPECT_EQ(test::euler_characteristic(whole.positions.size(), whole.triangles), 0);
  EXPECT_GT(test::smallest_angle_degrees(whole.positions, whole.triangles), 25);
  EXPECT_EQ(test::self_intersection_count(whole.positions, whole.triangles), 0);
}

TEST(Polygonise, RemeshingNeverPinchesAThinRod) {
  // Edges much longer than the rod is thick: collapses and flips would close it or join the two halves of the border.
  for (const double x : {0.0, 0.02, 0.3}) {
    const ScalarField rods = [x](const Vec3& p) {
      return RoundCone{Vec3(x, -0.5, 0.013), Vec3(x, 0.5, 0.013), 0.04, 0.03}(Vec3(std::abs(p.x()), p.y(), p.z()));
    };
    for (const double edge : {0.04, 0.08, 0.16}) {
      const HalfSurface whole = meshed(rods, 0.8, 0.02, edge, 8);
      const int rod_count = x < 0.1 ? 1 : 2;
      EXPECT_NO_THROW(check_closed("rod", whole.positions, whole.triangles)) << "x " << x << " edge " << edge;
      EXPECT_EQ(test::piece_count(whole.positions.size(), whole.triangles), rod_count);
      EXPECT_EQ(test::euler_characteristic(whole.positions.size(), whole.triangles), 2 * rod_count);
    }
  }
}

TEST(TapeMeasure, TheWaistIsTheNarrowestPartOfTheTrunk) {
  // Three stacked frusta of height 1, narrowest at 0.62.
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  constexpr Index sides = 32;
  const std::array<std::array<double, 2>, 4> rings{{{0, 0.2}, {0.62, 0.1}, {0.9, 0.2}, {1, 0.05}}};
  for (const auto& [height, radius] : rings)
    for (Index k = 0; k < sides; ++k)
      x.emplace_back(radius * std::cos(2 * M_PI * k / sides), height, -radius * std::sin(2 * M_PI * k / sides));
  for (Index r = 0; r + 1 < 4; ++r) {
    for (Index k = 0; k < sides; ++k) {
      const Index a = r * sides + k, b = r * sides + (k + 1) % sides;
      triangles.push_back({a, b, b + sides});
      triangles.push_back({a, b + sides, a + sides});
    }
  }
  for (Index k = 1; k + 1 < sides; ++k) {
    triangles.push_back({0, k + 1, k});
    triangles.push_back({3 * sides, 3 * sides + k, 3 * sides + k + 1});
  }
  EXPECT_NEAR(waist_height_m(x, triangles), 0.62, 1e-9);
  EXPECT_EQ(waist_height_m({}, {}), 0);
  const Level widest = hips(x, triangles);
  EXPECT_GE(widest.height_m, 0.45 - 1e-9);
  EXPECT_LE(widest.height_m, 0.55 + 1e-9);
  for (int percent = 45; percent <= 55; ++percent)
    EXPECT_LE(girth_at_m(x, triangles, Vec3(0, 0.01 * percent, 0), Vec3::UnitY()), widest.girth_m + 1e-9) << percent;
  EXPECT_EQ(hips({}, {}).girth_m, 0);
}

TEST(TapeMeasure, GirthOfABallIsItsCircumference) {
  const ScalarField ball = [](const Vec3& p) { return p.norm() - 0.5; };
  const HalfSurface whole = meshed(ball, 0.8, 0.025, 0.03, 6);
  EXPECT_NEAR(girth_at_m(whole.positions, whole.triangles, Vec3::Zero(), Vec3(0, 1, 0)), M_PI, 0.005);
  const Vec3 tilted = Vec3(1, 2, -1).normalized();
  EXPECT_NEAR(girth_at_m(whole.positions, whole.triangles, 0.3 * tilted, tilted), 0.8 * M_PI, 0.005);
  EXPECT_EQ(girth_at_m(whole.positions, whole.triangles, Vec3(0, 2, 0), Vec3(0, 1, 0)), 0.0);
}

TEST(TapeMeasure, DoesNotFollowHollowsAndTakesTheCurveAsked) {
  const std::vector<Vec3> notched = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0.5, 0, 0.2}, {0, 0, 1}};
  EXPECT_NEAR(girth_m(notched, Vec3(0, 1, 0)), 4, 1e-12);
  // Two balls side by side: the section has two curves.
  const ScalarField balls = [](const Vec3& p) {
    return (Vec3(std::abs(p.x()), p.y(), p.z()) - Vec3(0.4, 0, 0)).norm() - 0.25;
  };
  const HalfSurface whole = meshed(balls, 0.8, 0.025, 0.03, 4);
  EXPECT_EQ(section(whole.positions, whole.triangles, Vec3::Zero(), Vec3(0, 1, 0)).size(), 2U);
  EXPECT_NEAR(girth_at_m(whole.positions, whole.triangles, Vec3(-0.4, 0, 0), Vec3(0, 1, 0)), 0.5 * M_PI, 0.005);
}

}  // namespace
}  // namespace toile::internal
