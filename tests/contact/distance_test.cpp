#include "contact/distance.hpp"

#include "contact/meshes.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

using contact_test::Random;

// z = p - c is the shortest vector to a convex set exactly if no corner w of the set lies nearer to p: z . (w - c) <=
// 0.
void expect_closest(const Vec3& p, const std::array<Vec3, 3>& corner, double tolerance) {
  const VertexTriangle at = closest_vertex_triangle(p, corner[0], corner[1], corner[2]);
  ASSERT_NEAR(at.barycentric.sum(), 1, 1e-14);
  ASSERT_GE(at.barycentric.minCoeff(), 0);
  const Vec3 c = at.barycentric[0] * corner[0] + at.barycentric[1] * corner[1] + at.barycentric[2] * corner[2];
  ASSERT_NEAR((p - c).squaredNorm(), at.distance2, tolerance);
  for (const Vec3& w : corner) ASSERT_LE((p - c).dot(w - c), tolerance);

  const int zeros = static_cast<int>((at.barycentric.array() == 0).count());
  if (at.feature == Feature::edge) {
    ASSERT_EQ(at.barycentric[(at.index + 2) % 3], 0);
  } else if (at.feature == Feature::vertex) {
    ASSERT_EQ(at.barycentric[at.index], 1);
    ASSERT_EQ(zeros, 2);
  } else {
    ASSERT_EQ(zeros, 0);
  }
}

void expect_closest(const std::array<Vec3, 4>& x, double tolerance) {
  const EdgeEdge at = closest_edge_edge(x[0], x[1], x[2], x[3]);
  ASSERT_GE(std::min(at.s, at.t), 0);
  ASSERT_LE(std::max(at.s, at.t), 1);
  const Vec3 z = x[0] + at.s * (x[1] - x[0]) - x[2] - at.t * (x[3] - x[2]);
  ASSERT_NEAR(z.squaredNorm(), at.distance2, tolerance);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 2; j < 4; ++j) ASSERT_GE(z.dot(x[i] - x[j] - z), -tolerance);
  }
  if (at.interior) {
    ASSERT_GT(std::min(at.s, at.t), 0);
    ASSERT_LT(std::max(at.s, at.t), 1);
  }
}

TEST(Distance, TheClosestPointOfATriangleIsNearerThanEveryOther) {
  Random random(1);
  std::array<int, 3> seen{};
  for (int n = 0; n < 100000; ++n) {
    const std::array<Vec3, 3> corner{random.vector(1), random.vector(1), random.vector(1)};
    const Vec3 p = random.vector(1.5);
    ASSERT_NO_FATAL_FAILURE(expect_closest(p, corner, 1e-12));
    ++seen[static_cast<std::size_t>(closest_vertex_triangle(p, corner[0], corner[1], corner[2]).feature)];
  }
  for (const int count : seen) EXPECT_GT(count, 5000);
}

TEST(Distance, AgreesWithDenseSamplingOfATriangle) {
  Random random(2);
  constexpr int n = 40;
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 a = random.vector(1), b = random.vector(1), c = random.vector(1), p = random.vector(1.5);
    double least = 1e9;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const double u = double(i) / n, v = double(j) / n;
        least = std::min(least, (u * a + v * b + (1 - u - v) * c - p).norm());
      }
    }
    const double d = std::sqrt(closest_vertex_triangle(p, a, b, c).distance2);
    ASSERT_LE(d, least + 1e-12);
    ASSERT_GE(d, least - 4.0 / n);
  }
}

TEST(Distance, TheClosestPointsOfTwoEdgesAreNearerThanAllOthers) {
  Random random(3);
  int interior = 0;
  for (int n = 0; n < 100000; ++n) {
    const std::array<Vec3, 4> x{random.vector(1), random.vector(1), random.vector(1), random.vector(1)};
    ASSERT_NO_FATAL_FAILURE(expect_closest(x, 1e-11));
    interior += closest_edge_edge(x[0], x[1], x[2], x[3]).interior;
  }
  EXPECT_GT(interior, 10000);
}

TEST(Distance, TheQuickFormAgreesOnInteriorPairsAndRefusesTheRest) {
  Random random(4);
  for (int n = 0; n < 20000; ++n) {
    const std::array<Vec3, 4> x{random.vector(1), random.vector(1), random.vector(1), random.vector(1)};
    const EdgeEdge whole = closest_edge_edge(x[0], x[1], x[2], x[3]);
    EdgeEdge quick;
    ASSERT_EQ(interior_edge_edge(x[0], x[1], x[2], x[3], quick), whole.interior);
    if (whole.interior) {
      ASSERT_EQ(quick.distance2, whole.distance2);
    }
  }
}

TEST(Distance, ATriangleWithoutAreaIsItsEdges) {
  Random random(5);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 a = random.vector(1), b = random.vector(1), p = random.vector(1.5);
    const double s = random.in(-1, 2);
    ASSERT_NO_FATAL_FAILURE(expect_closest(p, {a, b, a + s * (b - a)}, 1e-12));  // on one line
    ASSERT_NO_FATAL_FAILURE(expect_closest(p, {a, a, b}, 1e-12));                // two corners coincide
    ASSERT_NO_FATAL_FAILURE(expect_closest(p, {a, b, a}, 1e-12));
    ASSERT_NO_FATAL_FAILURE(expect_closest(p, {b, a, a}, 1e-12));
    ASSERT_NO_FATAL_FAILURE(expect_closest(p, {a, a, a}, 1e-12));  // all three
    ASSERT_NO_FATAL_FAILURE(expect_closest(a, {a, a, a}, 1e-12));
  }
}

TEST(Distance, NeedlesCostLittleAccuracy) {
  Random random(6);
  for (int n = 0; n < 50000; ++n) {
    const Vec3 a = random.vector(1), b = random.vector(1), p = random.vector(1.5);
    const double thin = std::pow(10.0, random.in(-16, -1));
    ASSERT_NO_FATAL_FAILURE(expect_closest(p, {a, b, a + random.in(-0.5, 1.5) * (b - a) + random.vector(thin)}, 2e-6));
  }
}

TEST(Distance, ParallelEdgesHaveADistanceAndNoInterior) {
  Random random(7);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 a = random.vector(1), e = random.vector(1), offset = random.vector(0.5);
    const double from = random.in(-3, 3), length = random.in(-2, 2);
    const std::array<Vec3, 4> x{a, a + e, a + offset + from * e, a + offset + (from + length) * e};
    ASSERT_NO_FATAL_FAILURE(expect_closest(x, 1e-11));
    ASSERT_FALSE(closest_edge_edge(x[0], x[1], x[2], x[3]).interior);
  }
}

TEST(Distance, NearlyParallelEdgesAreExactToAMicrometreAMetre) {
  Random random(8);
  for (int n = 0; n < 50000; ++n) {
    const Vec3 a = random.vector(1), e = random.vector(1);
    const Vec3 tilt = random.vector(std::pow(10.0, random.in(-17, -2)));
    const Vec3 b = a + random.vector(1e-2) + random.in(-0.5, 0.5) * e;
    ASSERT_NO_FATAL_FAILURE(expect_closest({a, a + e, b, b + e + tilt}, 1e-7));
  }
}

TEST(Distance, AnEdgeWithoutLengthIsAPoint) {
  Random random(9);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 a = random.vector(1), b = random.vector(1), c = random.vector(1);
    ASSERT_NO_FATAL_FAILURE(expect_closest({a, a, b, c}, 1e-12));
    ASSERT_NO_FATAL_FAILURE(expect_closest({b, c, a, a}, 1e-12));
    ASSERT_NO_FATAL_FAILURE(expect_closest({a, a, b, b}, 1e-12));
    ASSERT_NO_FATAL_FAILURE(expect_closest({a, a, a, a}, 1e-12));
    ASSERT_FALSE(closest_edge_edge(a, a, b, c).interior);
  }
}

TEST(Distance, ScaleDoesNotChangeTheRegion) {
  Random random(10);
  for (int n = 0; n < 5000; ++n) {
    const Vec3 a = random.vector(1), b = random.vector(1), c = random.vector(1), p = random.vector(1.5);
    const VertexTriangle at = closest_vertex_triangle(p, a, b, c);
    for (const double scale : {0x1p-20, 0x1p20}) {  // powers of two: the same bits but for the exponent
      const VertexTriangle scaled = closest_vertex_triangle(scale * p, scale * a, scale * b, scale * c);
      ASSERT_EQ(scaled.feature, at.feature);
      ASSERT_EQ(scaled.distance2, scale * scale * at.distance2);
    }
  }
}

}  // namespace
}  // namespace toile::internal
