#include "mesh/topology.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace toile::internal {
namespace {

// An n by m grid of squares, each cut in two.
std::vector<Triangle> grid(Index n, Index m) {
  std::vector<Triangle> triangles;
  for (Index j = 0; j < m; ++j) {
    for (Index i = 0; i < n; ++i) {
      const Index p = j * (n + 1) + i;
      triangles.push_back({p, p + 1, p + n + 2});
      triangles.push_back({p, p + n + 2, p + n + 1});
    }
  }
  return triangles;
}

std::string complaint(Index particles, const std::vector<Triangle>& triangles) {
  try {
    build_topology(particles, triangles);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

// The formula of topology.hpp.
double theta(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  const Vec3 e = x1 - x0;
  const Vec3 n_a = e.cross(x2 - x0);
  const Vec3 n_b = (x3 - x0).cross(e);
  return std::atan2(n_a.cross(n_b).dot(e) / e.norm(), n_a.dot(n_b));
}

TEST(Topology, OfTwoTrianglesIsAsDrawn) {
  const Topology topology = build_topology(4, std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}});
  ASSERT_EQ(topology.edges.size(), 5u);
  ASSERT_EQ(topology.hinges.size(), 1u);
  EXPECT_EQ(topology.hinges[0].particle, (std::array<Index, 4>{0, 1, 2, 3}));
  EXPECT_EQ(topology.hinges[0].triangle, (std::array<Index, 2>{0, 1}));
  EXPECT_EQ(topology.edges[0].a, 0);
  EXPECT_EQ(topology.edges[0].b, 1);
  EXPECT_EQ(topology.edges[0].triangle, (std::array<Index, 2>{0, 1}));
  EXPECT_EQ(topology.edges[1].triangle, (std::array<Index, 2>{0, -1}));    // 0-2
  EXPECT_EQ(topology.edges[2].triangle, (std::array<Index, 2>{1, -1}));    // 0-3
  EXPECT_EQ(topology.triangle_edges[0], (std::array<Index, 3>{0, 3, 1}));  // 0-1, 1-2, 2-0
  EXPECT_EQ(topology.triangle_edges[1], (std::array<Index, 3>{0, 2, 4}));  // 1-0, 0-3, 3-1
}

TEST(Topology, TakesTheDirectionOfAHingeFromTheTriangleWithTheLowerIndex) {
  // The same two triangles in the other order: the edge is walked from particle 1 to 0.
  const Topology topology = build_topology(4, std::vector<Triangle>{{1, 0, 3}, {0, 1, 2}});
  ASSERT_EQ(topology.hinges.size(), 1u);
  EXPECT_EQ(topology.hinges[0].particle, (std::array<Index, 4>{1, 0, 3, 2}));
  EXPECT_EQ(topology.hinges[0].triangle, (std::array<Index, 2>{0, 1}));
  // Whichever corner a triangle begins with.
  const Topology rotated = build_topology(4, std::vector<Triangle>{{3, 1, 0}, {1, 2, 0}});
  EXPECT_EQ(rotated.hinges[0].particle, (std::array<Index, 4>{1, 0, 3, 2}));
}

TEST(Topology, SortsEdgesAndHingesAndConnectsThemToTheirTriangles) {
  const Index n = 7, m = 5;
  std::vector<Triangle> triangles = grid(n, m);
  // Shuffled and rotated, reproducibly.
  std::mt19937_64 random(2);
  for (std::size_t t = triangles.size(); t > 1; --t) std::swap(triangles[t - 1], triangles[random() % t]);
  for (Triangle& triangle : triangles) {
    std::rotate(triangle.begin(), triangle.begin() + static_cast<std::ptrdiff_t>(random() % 3), triangle.end());
  }
  const Index particles = (n + 1) * (m + 1);
  const Topology topology = build_topology(particles, triangles);

  // Euler: particles - edges + triangles = 1 for a disk.
  EXPECT_EQ(particles - static_cast<Index>(topology.edges.size()) + static_cast<Index>(triangles.size()), 1);
  EXPECT_EQ(topology.edges.size() - topology.hinges.size(), static_cast<std::size_t>(2 * (n + m)));

  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const Edge& edge = topology.edges[e];
    EXPECT_LT(edge.a, edge.b);
    if (e > 0) {
      const Edge& before = topology.edges[e - 1];
      EXPECT_TRUE(before.a < edge.a || (before.a == edge.a && before.b < edge.b));
    }
    for (const Index t : edge.triangle) {
      if (t < 0) continue;
      const auto& edges = topology.triangle_edges[static_cast<std::size_t>(t)];
      EXPECT_EQ(std::count(edges.begin(), edges.end(), static_cast<Index>(e)), 1);
    }
    EXPECT_TRUE(edge.triangle[1] == -1 || edge.triangle[0] < edge.triangle[1]);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge& edge = topology.edges[static_cast<std::size_t>(topology.triangle_edges[t][k])];
      EXPECT_EQ(std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]), std::minmax(edge.a, edge.b));
    }
  }
  std::pair<Index, Index> before{-1, -1};
  for (const Hinge& hinge : topology.hinges) {
    const auto [x0, x1, x2, x3] = hinge.particle;
    const std::pair<Index, Index> edge = std::minmax({x0, x1});
    EXPECT_LT(before, edge);
    before = edge;
    EXPECT_LT(hinge.triangle[0], hinge.triangle[1]);
    const auto is_rotation = [](Triangle triangle, const Triangle& of) {
      for (int r = 0; r < 3; ++r) {
        if (triangle == of) return true;
        std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
      }
      return false;
    };
    EXPECT_TRUE(is_rotation(triangles[static_cast<std::size_t>(hinge.triangle[0])], {x0, x1, x2}));
    EXPECT_TRUE(is_rotation(triangles[static_cast<std::size_t>(hinge.triangle[1])], {x1, x0, x3}));
  }
}

TEST(Topology, HasAHingeOnEveryEdgeOfAClosedSurface) {
  const std::vector<Triangle> tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const Topology topology = build_topology(4, tetrahedron);
  EXPECT_EQ(topology.edges.size(), 6u);
  EXPECT_EQ(topology.hinges.size(), 6u);
}

TEST(Topology, OfNothingIsEmpty) {
  const Topology topology = build_topology(0, {});
  EXPECT_TRUE(topology.edges.empty());
  EXPECT_TRUE(topology.triangle_edges.empty());
  EXPECT_TRUE(topology.hinges.empty());
}

TEST(HingeAngle, IsZeroWhenFlatAndTheAngleOfTheNormalsOtherwise) {
  const Vec3 x0(0, 0, 0), x1(1, 0, 0), x2(0.4, 1, 0);
  for (const double bend : {-3.0, -1.5, -0.1, 0.0, 0.1, 1.5, 3.0}) {
    // Triangle B turned about the edge, by `bend` away from the normals (which point to +z).
    const Vec3 x3(0.6, -std::cos(bend), -std::sin(bend));
    EXPECT_NEAR(theta(x0, x1, x2, x3), bend, 1e-14);
  }
}

TEST(HingeAngle, IsPositiveOnEveryEdgeOfAConvexBodyWhicheverTriangleComesFirst) {
  const Vec3s x = {Vec3(1, 1, 1), Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1)};
  std::vector<Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::sort(triangles.begin(), triangles.end());
  do {
    // Outward: the volume is positive.
    double volume = 0;
    for (const auto& [i, j, k] : triangles) {
      volume +=
          x[static_cast<std::size_t>(i)].dot(x[static_cast<std::size_t>(j)].cross(x[static_cast<std::size_t>(k)]));
    }
    ASSERT_GT(volume, 0);
    for (const Hinge& hinge : build_topology(4, triangles).hinges) {
      const auto at = [&](std::size_t corner) { return x[static_cast<std::size_t>(hinge.particle[corner])]; };
      // The dihedral angle of a regular tetrahedron is acos(1/3).
      EXPECT_NEAR(theta(at(0), at(1), at(2), at(3)), std::numbers::pi - std::acos(1.0 / 3), 1e-14);
    }
  } while (std::next_permutation(triangles.begin(), triangles.end()));
}

TEST(Topology, NamesTheEdgeOfAThirdTriangle) {
  EXPECT_EQ(complaint(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}),
            "edge 0-1: expected one or two triangles, got 3: triangles 0, 1, 2");
}

TEST(Topology, NamesTheEdgeThatTwoTrianglesWalkInTheSameDirection) {
  EXPECT_EQ(complaint(4, {{0, 1, 2}, {0, 1, 3}}),
            "edge 0-1: expected two triangles that walk it in opposite directions, got triangles 0 and 1 in the same "
            "direction (one of them is flipped)");
}

TEST(Topology, NamesTheTriangleWithABadCorner) {
  EXPECT_EQ(complaint(3, {{0, 1, 2}, {0, 2, 3}}), "triangle 1: expected a corner in 0..2, got 3");
  EXPECT_EQ(complaint(3, {{0, -1, 2}}), "triangle 0: expected a corner in 0..2, got -1");
  EXPECT_EQ(complaint(3, {{0, 1, 1}}), "triangle 0: expected three different corners, got 0, 1, 1");
}

}  // namespace
}  // namespace toile::internal
