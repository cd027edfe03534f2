// Stretch, shear, gap and speed against cases worked out by hand.
#include "verify/statistics.hpp"

#include "core/error.hpp"
#include "support/exact.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

using exact::Random;

// One unit right triangle per entry, each with its own three particles, mapped by (u, v) -> u du + v dv.
ClothMesh separate_triangles(int count) {
  ClothMesh mesh;
  mesh.particle_count = 3 * count;
  mesh.panel_names = {"front"};
  for (Index t = 0; t < count; ++t) {
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    mesh.uv.push_back({Vec2(0, 0), Vec2(0.02, 0), Vec2(0, 0.02)});
    mesh.panel.push_back(0);
  }
  return mesh;
}
void place(Vec3s& x, const Vec3& du, const Vec3& dv) {
  x.push_back(Vec3(1, 2, 3));
  x.push_back(Vec3(1, 2, 3) + 0.02 * du);
  x.push_back(Vec3(1, 2, 3) + 0.02 * dv);
}

TEST(NearestRank, IsAValueThatOccurs) {
  std::vector<double> values;
  EXPECT_EQ(nearest_rank(values, 50), 0);
  for (int n = 100; n >= 1; --n) values.push_back(n);
  EXPECT_EQ(nearest_rank(values, 50), 50);
  EXPECT_EQ(nearest_rank(values, 99), 99);
  EXPECT_EQ(nearest_rank(values, 100), 100);
  values.push_back(101);
  EXPECT_EQ(nearest_rank(values, 99), 100);  // ceil(0.99 * 101) = 100
  values = {7};
  EXPECT_EQ(nearest_rank(values, 1), 7);
}

TEST(Stretch, IsThatOfTheMoreStretchedThread) {
  const ClothMesh mesh = separate_triangles(3);
  Vec3s x;
  place(x, Vec3(0, 1, 0), Vec3(0, 0, 1));
  place(x, Vec3(0, 1.3, 0), Vec3(0, 0, 0.9));
  place(x, Vec3(0, 0.5, 0), Vec3(0, 0, 0.8));
  const auto s = measure_stretch(mesh, x, {});
  EXPECT_NEAR(s.max, 0.3, 1e-12);
  EXPECT_EQ(s.worst_triangle, 1);
  EXPECT_NEAR(s.p50, 0, 1e-12);
  EXPECT_NEAR(s.shear_max_deg, 0, 1e-9);
  EXPECT_EQ(s.elastic_triangles, 0);
  EXPECT_EQ(s.triangle_max, s.max);
}

TEST(Stretch, OfElasticIsRelativeToItsOwnRestLengthAndNotJudged) {
  const ClothMesh mesh = separate_triangles(3);
  Vec3s x;
  place(x, Vec3(0, 1, 0), Vec3(0, 0, 1));
  place(x, Vec3(0, 1.2, 0), Vec3(0, 0, 1));  // 1.2 / 0.8: stretched by half
  place(x, Vec3(0, 1.04, 0), Vec3(0, 0, 1));
  const std::vector<Vec2> b = {Vec2(1, 1), Vec2(0.8, 1), Vec2(1, 1)};
  const auto s = measure_stretch(mesh, x, b);
  EXPECT_NEAR(s.max, 0.5, 1e-12);
  EXPECT_EQ(s.worst_triangle, 1);
  EXPECT_EQ(s.elastic_triangles, 1);
  EXPECT_NEAR(s.triangle_max, 0.04, 1e-12);
  EXPECT_NEAR(s.triangle_p99, 0.04, 1e-12);
  EXPECT_EQ(s.triangle_worst, 2);
}

TEST(Stretch, OfAUniformlyShortenedSheetIsNegative) {
  const ClothMesh mesh = separate_triangles(1);
  Vec3s x;
  place(x, Vec3(0.9, 0, 0), Vec3(0, 0, 0.95));
  EXPECT_NEAR(measure_stretch(mesh, x, {}).max, -0.05, 1e-12);
}

TEST(Shear, IsTheDepartureFromARightAngleEitherWay) {
  const ClothMesh mesh = separate_triangles(2);
  const double degree = std::numbers::pi / 180;
  Vec3s x;
  place(x, Vec3(1, 0, 0), Vec3(std::cos(80 * degree), std::sin(80 * degree), 0));
  place(x, Vec3(1, 0, 0), Vec3(std::cos(115 * degree), std::sin(115 * degree), 0));
  const auto s = measure_stretch(mesh, x, {});
  EXPECT_NEAR(s.shear_p50_deg, 10, 1e-9);
  EXPECT_NEAR(s.shear_max_deg, 25, 1e-9);
  EXPECT_NEAR(s.max, 0, 1e-12);
}

TEST(Stretch, RefusesATriangleWithoutAreaAndSizesThatDisagree) {
  ClothMesh mesh = separate_triangles(1);
  Vec3s x;
  place(x, Vec3(1, 0, 0), Vec3(0, 1, 0));
  EXPECT_THROW(measure_stretch(mesh, x, std::vector<Vec2>(2, Vec2(1, 1))), InputError);
  EXPECT_THROW(measure_stretch(mesh, x, std::vector<Vec2>(1, Vec2(0, 1))), InputError);
  EXPECT_THROW(measure_stretch(mesh, Vec3s(2, Vec3::Zero()), {}), InputError);
  mesh.uv[0][2] = Vec2(0.01, 0);
  EXPECT_THROW(measure_stretch(mesh, x, {}), InputError);
  mesh.uv.clear();
  EXPECT_THROW(measure_stretch(mesh, x, {}), InputError);
}

struct MeasuredMesh {
  std::vector<Triangle> triangles;
  Vec3s x;
};

// Axis-parallel box of two triangles per side.
MeasuredMesh box(const Vec3& low, const Vec3& high) {
  MeasuredMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.x.push_back(
        {(i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(), (i & 4) != 0 ? high.z() : low.z()});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

double gap_of(const Vec3& p, const MeasuredMesh& body) {
  const Vec3s x = {p};
  return measure_gap(x, body.triangles, body.x).min_mm;
}

// Distance to an axis-parallel box, negative inside.
double distance_to_box(const Vec3& p, const Vec3& low, const Vec3& high) {
  const Vec3 outside = (low - p).cwiseMax(p - high);
  return outside.maxCoeff() < 0 ? outside.maxCoeff() : outside.cwiseMax(0.0).norm();
}

TEST(Gap, IsTheSignedDistanceToABox) {
  const Vec3 low(-1, 0, -1), high(1, 2, 1);
  const MeasuredMesh body = box(low, high);
  Random random(31);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = random.point(-2, 3);
    ASSERT_NEAR(gap_of(p, body), 1000 * distance_to_box(p, low, high), 1e-9) << p.transpose();
  }
}

// Straight above these points lie particles, edges and diagonals of the box: the ray meets them exactly.
TEST(Gap, HasTheRightSignWhereTheRayMeetsEdgesAndParticles) {
  const Vec3 low(0, 0, 0), high(4, 4, 4);
  const MeasuredMesh body = box(low, high);
  for (int x = -2; x <= 6; ++x)
    for (int y = -2; y <= 6; ++y)
      for (int z = -2; z <= 6; ++z) {
        const Vec3 p(x, y, z);
        ASSERT_NEAR(std::abs(gap_of(p, body)), 1000 * std::abs(distance_to_box(p, low, high)), 1e-9);
        if (distance_to_box(p, low, high) == 0) continue;  // on the surface either sign is right
        ASSERT_EQ(gap_of(p, body) < 0, distance_to_box(p, low, high) < 0) << p.transpose();
      }
}

TEST(Gap, IsNegativeWhereTwoPartsOfTheBodyOverlap) {
  MeasuredMesh body = box({0, 0, 0}, {2, 2, 2});
  const MeasuredMesh arm = box({1, 0.5, 0.5}, {5, 1.5, 1.5});
  for (const Triangle& t : arm.triangles) body.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  body.x.insert(body.x.end(), arm.x.begin(), arm.x.end());
  EXPECT_LT(gap_of({1.5, 1, 1}, body), 0);  // in both: winding number 2, an even number of crossings
  EXPECT_LT(gap_of({0.5, 1, 1}, body), 0);  // in one
  EXPECT_LT(gap_of({4, 1, 1}, body), 0);    // in the other
  EXPECT_GT(gap_of({3, 1.8, 1}, body), 0);  // above the arm
  EXPECT_GT(gap_of({3, 0.2, 1}, body), 0);  // below the arm: the ray goes through it
}

TEST(Gap, TreatsAHoleOfTheBodyAsClosed) {
  MeasuredMesh body = box({0, 0, 0}, {2, 2, 2});
  body.triangles.erase(body.triangles.begin() + 6, body.triangles.begin() + 8);  // the lid, y = 2
  EXPECT_LT(gap_of({1, 0.5, 1}, body), 0);
  EXPECT_LT(gap_of({1.1, 1.9, 0.9}, body), 0);
  EXPECT_GT(gap_of({1.1, 2.1, 0.9}, body), 0);
  // The distance is to the surface that is there, not to the lid.
  EXPECT_NEAR(gap_of({1, 2.5, 1}, body), 1000 * std::hypot(1, 0.5), 1e-9);
  const MeasuredMesh floor = {{{0, 1, 2}}, {{0, 0, 0}, {0, 0, 9}, {9, 0, 0}}};
  EXPECT_NEAR(gap_of({1, 0.25, 1}, floor), 250, 1e-9);
  EXPECT_NEAR(gap_of({1, -0.25, 1}, floor), 250, 1e-9);
}

TEST(Gap, IsTheLeastOverAllTriangles) {
  Random random(32);
  MeasuredMesh body;
  for (Index t = 0; t < 200; ++t) {
    const Vec3 centre = random.point(-1, 1);
    for (int k = 0; k < 3; ++k) body.x.push_back(centre + random.point(-0.2, 0.2));
    body.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  for (int n = 0; n < 300; ++n) {
    const Vec3 p = random.point(-1.5, 1.5);
    // By sampling: the true distance is at most that of any sample, and at least it minus half the spacing.
    double sampled = 1e9;
    for (const Triangle& t : body.triangles) {
      const auto at = [&](std::size_t k) { return body.x[static_cast<std::size_t>(t[k])]; };
      constexpr int steps = 24;
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j)
          sampled = std::min(sampled, (at(0) + i * (at(1) - at(0)) / steps + j * (at(2) - at(0)) / steps - p).norm());
    }
    const double gap = 1e-3 * std::abs(gap_of(p, body));
    ASSERT_LE(gap, sampled + 1e-12);
    ASSERT_GE(gap, sampled - 0.025);
  }
}

TEST(Gap, HoversOnlyWhereTheClothLiesOnTheBodyFromOutside) {
  const MeasuredMesh body = box({-1, -1, -1}, {1, 1, 1});
  Vec3s x = {{0, 1.0055, 0}, {0.2, 0.999, 0}, {0, 2, 0}};  // beyond the reach, inside, far away
  for (int k = 1; k <= 10; ++k) x.push_back({0.01 * k, 1 + 0.00045 * k, 0.3});
  const auto gap = measure_gap(x, body.triangles, body.x);
  EXPECT_EQ(gap.hovering, 10);
  EXPECT_NEAR(gap.hover_p50_mm, 5 * 0.45, 1e-9);
  EXPECT_NEAR(gap.hover_p90_mm, 9 * 0.45, 1e-9);
}

TEST(Gap, GivesTheMedianAndTheDeepestVertex) {
  const MeasuredMesh body = box({-1, -1, -1}, {1, 1, 1});
  const Vec3s x = {{0, 1.1, 0}, {0, 1.3, 0}, {0, 0.9, 0}, {0, 1.2, 0}};
  const auto gap = measure_gap(x, body.triangles, body.x);
  EXPECT_NEAR(gap.min_mm, -100, 1e-9);
  EXPECT_EQ(gap.nearest_vertex, 2);
  EXPECT_NEAR(gap.p50_mm, 100, 1e-9);
  EXPECT_EQ(gap.hovering, 0);
  EXPECT_EQ(measure_gap({}, body.triangles, body.x).nearest_vertex, -1);
  EXPECT_THROW(measure_gap(x, std::vector<Triangle>{{0, 1, 8}}, body.x), InputError);
}

TEST(Speed, IsTheNinetyNinthPercentileOfTheVertices) {
  Vec3s before(100, Vec3(1, 1, 1)), after = before;
  for (std::size_t i = 0; i < 100; ++i) after[i].z() += 1e-4 * static_cast<double>(i + 1);
  EXPECT_NEAR(speed_p99_mm_per_s(before, after, 30), 1000 * 30 * 99e-4, 1e-9);
  EXPECT_THROW(speed_p99_mm_per_s(before, Vec3s(3), 30), InputError);
}

}  // namespace
}  // namespace toile::internal
