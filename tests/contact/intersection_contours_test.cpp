// Contours of surfaces whose intersections are known, found here by trying every edge against every triangle.
#include "contact/intersection_contours.hpp"

#include "contact/contour_motion.hpp"
#include "contact/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace toile::internal {
namespace {

using contact_test::Mesh;
using contact_test::Random;

// Positions are shaken first, so nothing lies in a plane by design.
std::vector<SurfaceCrossing> all_crossings(const Mesh& mesh, const Topology& topology) {
  std::vector<SurfaceCrossing> found;
  for (const Edge& e : topology.edges) {
    const Vec3 &p = mesh.x[at(e.a)], &q = mesh.x[at(e.b)], d = q - p;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [i, j, k] = mesh.triangles[t];
      if (i == e.a || j == e.a || k == e.a || i == e.b || j == e.b || k == e.b) continue;
      const Vec3 &a = mesh.x[at(i)], &b = mesh.x[at(j)], &c = mesh.x[at(k)], n = (b - a).cross(c - a);
      const double above = n.dot(p - a), below = n.dot(q - a);
      if ((above > 0) == (below > 0)) continue;
      const double u = d.dot((a - p).cross(b - p)), v = d.dot((b - p).cross(c - p)), w = d.dot((c - p).cross(a - p));
      if ((u > 0) != (v > 0) || (v > 0) != (w > 0)) continue;
      found.push_back({{e.a, e.b}, static_cast<Index>(t), p + above / (above - below) * d});
    }
  }
  return found;
}

struct Traced {
  Mesh mesh;
  Topology topology;
  std::vector<SurfaceCrossing> crossings;
  std::vector<IntersectionContour> contours;

  explicit Traced(Mesh m, std::uint64_t seed = 1) : mesh(std::move(m)) {
    Random random(seed);
    for (Vec3& p : mesh.x) p += random.vector(3e-4);
    topology = build_topology(static_cast<Index>(mesh.x.size()), mesh.triangles);
    crossings = all_crossings(mesh, topology);
    contours = trace_contours(topology, mesh.triangles, crossings);
  }

  SurfaceRegions regions() const {
    std::vector<double> area(mesh.x.size(), 0);
    for (const Triangle& t : mesh.triangles) {
      const double a = (mesh.x[at(t[1])] - mesh.x[at(t[0])]).cross(mesh.x[at(t[2])] - mesh.x[at(t[0])]).norm() / 6;
      for (const Index i : t) area[at(i)] += a;
    }
    return SurfaceRegions(topology, mesh.x.size(), area);
  }
  double length() const {
    double sum = 0;
    for (const IntersectionContour& c : contours) sum += contour_length(c, crossings, mesh.x);
    return sum;
  }
};

constexpr double edge_m = 0.02;

template <class Map>
void add_mapped_sheet(Mesh& mesh, Index n, Map&& map) {
  const std::size_t first = mesh.x.size();
  contact_test::add_sheet(mesh, n, n, edge_m, Vec3(-n * edge_m / 2, 0, -n * edge_m * 0.433));
  for (std::size_t i = first; i < mesh.x.size(); ++i) mesh.x[i] = map(Vec3(mesh.x[i]));
}

Vec3 upright(const Vec3& p) { return {p.x(), p.z(), p.y()}; }

// The wide one lies, the narrow one stands through it and goes through it everywhere.
Mesh crossing_sheets(double lift_m = 0.03) {
  Mesh mesh;
  add_mapped_sheet(mesh, 20, [](const Vec3& p) { return p; });
  add_mapped_sheet(mesh, 12, [&](const Vec3& p) { return Vec3(upright(p) + Vec3(0.001, lift_m, 0.0013)); });
  return mesh;
}

Mesh dented() {
  Mesh mesh;
  add_mapped_sheet(mesh, 20, [](const Vec3& p) { return p; });
  add_mapped_sheet(mesh, 20, [](const Vec3& p) {
    return Vec3(p + Vec3(0.003, 0.01 - 0.05 * std::exp(-p.squaredNorm() / 0.0036), 0.004));
  });
  return mesh;
}

Mesh corner_through() {
  Mesh mesh;
  add_mapped_sheet(mesh, 20, [](const Vec3& p) { return p; });
  const Mat3 R = Eigen::AngleAxisd(0.8, Vec3::UnitZ()).toRotationMatrix();
  add_mapped_sheet(mesh, 12, [&](const Vec3& p) { return Vec3(R * upright(p) + Vec3(0.02, 0.11, 0.001)); });
  return mesh;
}

Mesh tube_through() {
  Mesh mesh;
  add_mapped_sheet(mesh, 20, [](const Vec3& p) { return p; });
  const auto first = static_cast<Index>(mesh.x.size());
  constexpr Index around = 18, rows = 10;
  for (Index r = 0; r <= rows; ++r)
    for (Index k = 0; k < around; ++k) {
      const double a = 2 * contact_test::pi * k / around;
      mesh.x.push_back(Vec3(0.06 * std::cos(a), 0.02 * r - 0.05, -0.06 * std::sin(a)));
    }
  const auto id = [&](Index r, Index k) { return first + r * around + k % around; };
  for (Index r = 0; r < rows; ++r)
    for (Index k = 0; k < around; ++k) {
      mesh.triangles.push_back({id(r, k), id(r, k + 1), id(r + 1, k)});
      mesh.triangles.push_back({id(r, k + 1), id(r + 1, k + 1), id(r + 1, k)});
    }
  return mesh;
}

Mesh through_sphere() {
  Mesh mesh;
  add_mapped_sheet(mesh, 24, [](const Vec3& p) { return p; });
  Mesh ball = contact_test::ball(24, 14, [](const Vec3&) { return 0.1; });
  const auto first = static_cast<Index>(mesh.x.size());
  for (const Vec3& p : ball.x) mesh.x.push_back(p + Vec3(0.002, 0.025, 0.001));
  for (Triangle t : ball.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

void expect_all_used_once(const Traced& traced) {
  std::vector<int> used(traced.crossings.size(), 0);
  for (const IntersectionContour& contour : traced.contours) {
    for (const ContourPoint& point : contour.points) ++used[at(point.crossing)];
    EXPECT_EQ(contour.triangles.size() + (contour.closed ? 0 : 1), contour.points.size());
  }
  for (const int count : used) EXPECT_EQ(count, 1);
}

TEST(IntersectionContours, TwoSheetsThatCrossHaveOneOpenContourFromRimToRim) {
  const Traced traced(crossing_sheets());
  ASSERT_EQ(traced.contours.size(), 1u);
  const IntersectionContour& contour = traced.contours[0];
  EXPECT_FALSE(contour.closed);
  EXPECT_EQ(contour.end_particle, (std::array<Index, 2>{-1, -1}));
  for (const ContourPoint& end : {contour.points.front(), contour.points.back()}) {
    const Edge& e = traced.topology.edges[at(find_edge(traced.topology, traced.crossings[at(end.crossing)].edge))];
    EXPECT_EQ(e.triangle[1], -1) << "it ends at an edge of the boundary";
  }
  EXPECT_NEAR(traced.length(), 12.5 * edge_m, 0.6 * edge_m);
  expect_all_used_once(traced);
}

TEST(IntersectionContours, ItCutsTheNarrowSheetAndNotTheWideOne) {
  const Traced traced(crossing_sheets());
  SurfaceRegions regions = traced.regions();
  const Index wide = 21 * 21;
  // Which side is whose: an edge of the narrow sheet has particles from `wide` on.
  for (int side = 0; side < 2; ++side) {
    const auto& points = traced.contours[0].points;
    const auto own =
        std::find_if(points.begin(), points.end(), [&](const ContourPoint& p) { return p.edge_side == side; });
    ASSERT_NE(own, points.end());
    const bool narrow = traced.crossings[at(own->crossing)].edge[0] >= wide;
    const CutRegion region = regions.cut_off(traced.contours[0], traced.crossings, side);
    EXPECT_EQ(region.separates, narrow);
    if (!narrow) continue;
    EXPECT_FALSE(region.particles.empty());
    EXPECT_LT(region.area_m2, region.rest_m2);
    for (const Index i : region.particles) EXPECT_LT(traced.mesh.x[at(i)].y(), 1e-3) << "the shorter part hangs below";
    for (Index i = wide; i < static_cast<Index>(traced.mesh.x.size()); ++i)
      EXPECT_EQ(std::binary_search(region.particles.begin(), region.particles.end(), i), traced.mesh.x[at(i)].y() < 0);
  }
}

TEST(IntersectionContours, ADentThroughASheetIsOneClosedContourThatCutsBoth) {
  const Traced traced(dented());
  ASSERT_EQ(traced.contours.size(), 1u);
  EXPECT_TRUE(traced.contours[0].closed);
  EXPECT_FALSE(traced.contours[0].sides_joined);
  // 0.01 = 0.05 exp(-r^2/0.06^2)
  EXPECT_NEAR(traced.length(), 2 * contact_test::pi * 0.06 * std::sqrt(std::log(5.0)), 0.03);
  SurfaceRegions regions = traced.regions();
  for (int side = 0; side < 2; ++side) {
    const CutRegion region = regions.cut_off(traced.contours[0], traced.crossings, side);
    EXPECT_TRUE(region.separates);
    EXPECT_FALSE(region.particles.empty());
    EXPECT_LT(region.area_m2, 0.3 * region.rest_m2);
    for (const Index i : region.particles)
      EXPECT_LT(Vec2(traced.mesh.x[at(i)].x(), traced.mesh.x[at(i)].z()).norm(), 0.09);
  }
  expect_all_used_once(traced);
}

TEST(IntersectionContours, ACornerThroughASheetCutsTheCornerOnly) {
  const Traced traced(corner_through());
  ASSERT_EQ(traced.contours.size(), 1u);
  EXPECT_FALSE(traced.contours[0].closed);
  SurfaceRegions regions = traced.regions();
  const CutRegion first = regions.cut_off(traced.contours[0], traced.crossings, 0),
                  second = regions.cut_off(traced.contours[0], traced.crossings, 1);
  EXPECT_NE(first.separates, second.separates);
  const CutRegion& corner = first.separates ? first : second;
  ASSERT_FALSE(corner.particles.empty());
  for (const Index i : corner.particles) EXPECT_LT(traced.mesh.x[at(i)].y(), 1e-3);
}

TEST(IntersectionContours, ATubeThroughASheetIsClosedOnBothAndOnlyTheTubeCanLeave) {
  const Traced traced(tube_through());
  ASSERT_EQ(traced.contours.size(), 1u);
  EXPECT_TRUE(traced.contours[0].closed);
  EXPECT_NEAR(traced.length(), 2 * contact_test::pi * 0.06, 0.02);
  SurfaceRegions regions = traced.regions();
  for (int side = 0; side < 2; ++side) {
    const CutRegion region = regions.cut_off(traced.contours[0], traced.crossings, side);
    ASSERT_TRUE(region.separates);
    ASSERT_FALSE(region.particles.empty());
    const bool tube = region.particles.front() >= 21 * 21;
    const Sweep way = sweep(traced.contours[0], traced.mesh.triangles, traced.topology, traced.crossings, traced.mesh.x,
                            side, region.particles);
    if (tube) {
      EXPECT_GT(way.coherence, 0.99) << "the sheet's normal is the same all around";
      for (const ContourPull& pull : way.pulls) EXPECT_GT(pull.vector.y() * (pull.side == side ? 1 : -1), 0.9);
    } else {
      EXPECT_LT(way.coherence, 0.1) << "the tube's normals point everywhere: the disc cannot leave";
    }
  }
}

TEST(IntersectionContours, ASheetThroughASphereIsOneClosedContour) {
  const Traced traced(through_sphere());
  ASSERT_EQ(traced.contours.size(), 1u);
  EXPECT_TRUE(traced.contours[0].closed);
  EXPECT_NEAR(traced.length(), 2 * contact_test::pi * std::sqrt(0.01 - 0.025 * 0.025), 0.02);
  expect_all_used_once(traced);
}

// A triangle strip folded so that its last triangle passes through its first, of which it shares a particle.
TEST(IntersectionContours, AnOpenContourMayEndAtASharedParticle) {
  Mesh mesh;
  mesh.x = {{0, 0, 0}, {1, 0, -1}, {1, 0, 1}, {0.9, 0.8, 0.3}, {0.9, -0.8, 0.2}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 4}};
  const Traced traced(mesh);
  ASSERT_EQ(traced.contours.size(), 1u);
  const IntersectionContour& contour = traced.contours[0];
  EXPECT_FALSE(contour.closed);
  ASSERT_EQ(contour.points.size(), 1u);
  EXPECT_TRUE(contour.end_particle[0] == 0 || contour.end_particle[1] == 0);
  EXPECT_NEAR(traced.length(), Vec3(0.9, 0, 0.25).norm(), 0.01);
}

// With the same crossings at slightly other positions.
double length_at(const Traced& traced, const Vec3s& x) {
  std::vector<SurfaceCrossing> crossings = traced.crossings;
  for (SurfaceCrossing& c : crossings) {
    const Triangle& t = traced.mesh.triangles[at(c.triangle)];
    const Vec3 &p = x[at(c.edge[0])], &q = x[at(c.edge[1])], &a = x[at(t[0])];
    const Vec3 n = (x[at(t[1])] - a).cross(x[at(t[2])] - a);
    c.position = p + n.dot(p - a) / n.dot(p - q) * (q - p);
  }
  double sum = 0;
  for (const IntersectionContour& contour : traced.contours) sum += contour_length(contour, crossings, x);
  return sum;
}

void expect_gradient_matches(const Traced& traced) {
  Vec3s gradient(traced.mesh.x.size(), Vec3::Zero());
  for (const IntersectionContour& contour : traced.contours)
    for (const ContourPull& pull : length_gradient(contour, traced.mesh.triangles, traced.crossings, traced.mesh.x, 0))
      for (std::size_t k = 0; k < 3; ++k)
        if (pull.particle[k] >= 0) gradient[at(pull.particle[k])] += pull.weight[k] * pull.vector;
  double largest = 0;
  for (const Vec3& g : gradient) largest = std::max(largest, g.norm());
  EXPECT_GT(largest, 0.1);
  constexpr double eps = 1e-7;
  for (std::size_t i = 0; i < traced.mesh.x.size(); ++i)
    for (Eigen::Index k = 0; k < 3; ++k) {
      Vec3s more = traced.mesh.x, less = more;
      more[i][k] += eps;
      less[i][k] -= eps;
      const double slope = (length_at(traced, more) - length_at(traced, less)) / (2 * eps);
      EXPECT_NEAR(gradient[i][k], slope, 1e-4 * (1 + largest)) << "particle " << i;
    }
}

TEST(ContourMotion, TheGradientOfTheLengthIsThatOfDifferences) {
  expect_gradient_matches(Traced(crossing_sheets(), 2));
  expect_gradient_matches(Traced(dented(), 3));
  expect_gradient_matches(Traced(corner_through(), 4));
  Mesh folded;
  folded.x = {{0, 0, 0}, {1, 0, -1}, {1, 0, 1}, {0.9, 0.8, 0.3}, {0.9, -0.8, 0.2}};
  folded.triangles = {{0, 2, 1}, {0, 3, 4}};
  expect_gradient_matches(Traced(folded, 5));
}

// Moving what the sweep says by a little makes the part that is cut off smaller: fewer particles beyond the other sheet.
TEST(ContourMotion, TheSweepMakesWhatIsCutOffSmaller) {
  for (const Mesh& mesh : {crossing_sheets(), dented(), corner_through()}) {
    const Traced traced(mesh, 6);
    SurfaceRegions regions = traced.regions();
    for (int side = 0; side < 2; ++side) {
      const CutRegion region = regions.cut_off(traced.contours[0], traced.crossings, side);
      if (!region.separates) continue;
      const Sweep way = sweep(traced.contours[0], traced.mesh.triangles, traced.topology, traced.crossings,
                              traced.mesh.x, side, region.particles);
      // The whole sheets move apart, along the mean of the pulls.
      Vec3 mean = Vec3::Zero();
      for (const ContourPull& pull : way.pulls) mean += pull.side == side ? pull.vector : Vec3(-pull.vector);
      const bool second = region.particles.front() >= 21 * 21;
      Mesh moved = traced.mesh;
      const std::size_t begin = second ? 21 * 21 : 0, end = second ? moved.x.size() : 21 * 21;
      for (std::size_t i = begin; i < end; ++i) moved.x[i] += 0.012 * mean.normalized();
      const Traced after(moved, 7);
      ASSERT_FALSE(after.contours.empty());
      double area = 1e9;
      for (int s = 0; s < 2; ++s) {
        SurfaceRegions again = after.regions();
        const CutRegion now = again.cut_off(after.contours[0], after.crossings, s);
        if (now.separates && (now.particles.front() >= 21 * 21) == second) area = now.area_m2;
      }
      EXPECT_LT(area, 0.95 * region.area_m2);
    }
  }
}

}  // namespace
}  // namespace toile::internal
