// Additive CCD against a dense sampling of the motion: nothing missed, and little called an impact that is none.
#include "contact/ccd.hpp"

#include "contact/distance.hpp"
#include "contact/meshes.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

using contact_test::Random;
using Four = std::array<Vec3, 4>;

double vertex_face(const Four& x) { return std::sqrt(closest_vertex_triangle(x[0], x[1], x[2], x[3]).distance2); }
double edge_edge(const Four& x) { return std::sqrt(closest_edge_edge(x[0], x[1], x[2], x[3]).distance2); }

Four moved(const Four& x, const Four& u, double t) {
  return {x[0] + t * u[0], x[1] + t * u[1], x[2] + t * u[2], x[3] + t * u[3]};
}

struct Sampled {
  double least_m = 1e300, first_below = no_impact;  // the first sample nearer than xi
};

template <class Distance>
Sampled sample(const Four& x, const Four& u, double separation_m, Distance&& distance) {
  constexpr int samples = 2000;
  Sampled result;
  for (int i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples, d = distance(moved(x, u, t));
    result.least_m = std::min(result.least_m, d);
    if (d < separation_m && result.first_below > 1) result.first_below = t;
  }
  return result;
}

// Cloth-like: features of about a centimetre, up to 1 cm apart, moving by up to 3 cm, some nearly flat or parallel.
Four features(Random& random) {
  Four x{random.vector(0.006), random.vector(0.01), random.vector(0.01), random.vector(0.01)};
  const double flat = std::pow(10.0, random.in(-6, 0));
  for (Vec3& p : x) p.y() *= flat;
  x[0].y() += random.in(0, 0.004);
  return x;
}

template <class Impact, class Distance>
void expect_agreement(std::uint64_t seed, Impact&& impact, Distance&& distance) {
  Random random(seed);
  int impacts = 0, frees = 0;
  for (int i = 0; i < 6000; ++i) {
    const Four x = features(random);
    const double size = std::pow(10.0, random.in(-3, -1.5));
    Four u{random.vector(size), random.vector(size), random.vector(size), random.vector(size)};
    const Vec3 together = random.vector(0.05);
    for (Vec3& p : u) p += together;
    const double xi = std::min(2.5e-4, 0.5 * distance(x));
    if (xi < 1e-9) continue;
    const double t = impact(x, u, xi);
    const Sampled sampled = sample(x, u, xi, distance);
    // A sample may fall just short of the true minimum; the motion between two is at most this long.
    const double between = 2 * std::sqrt(3.0) * size / 2000;
    if (t > 1) {
      ++frees;
      ASSERT_GT(sampled.least_m, xi) << i;
    } else {
      ++impacts;
      ASSERT_GE(t, 0);
      ASSERT_LT(sampled.least_m, 1.2 * xi + between) << i << ": called an impact, yet nothing comes near";
      ASSERT_LE(t, sampled.first_below) << i << ": later than the first sample that is too near";
      ASSERT_GT(distance(moved(x, u, t)), xi * (1 - 1e-9)) << i << ": the time itself must still be free";
    }
  }
  EXPECT_GT(impacts, 400);
  EXPECT_GT(frees, 400);
}

TEST(Ccd, VertexAndFaceAgreeWithADenseSampling) { expect_agreement(11, vertex_face_impact, vertex_face); }
TEST(Ccd, TwoEdgesAgreeWithADenseSampling) { expect_agreement(12, edge_edge_impact, edge_edge); }

TEST(Ccd, AVertexThatFliesThroughAFaceIsMetJustBeforeIt) {
  const Four x{Vec3(0.2, 0.1, -0.2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
  const Four u{Vec3(0, -1, 0), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const double t = vertex_face_impact(x, u, 1e-4);
  EXPECT_LT(t, 0.1 - 1e-4);
  EXPECT_GT(t, 0.1 - 2e-4);
}

TEST(Ccd, ATinyFeatureIsNotFlownThroughByALongStep) {
  // A hundred times its own size per step, at a right angle and grazing.
  const Four x{Vec3(0, 1, 0), Vec3(-1e-3, 0, 1e-3), Vec3(1e-3, 0, 1e-3), Vec3(0, 0, -1e-3)};
  Four u{Vec3(0, -2, 0), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  EXPECT_NEAR(vertex_face_impact(x, u, 1e-5), 0.5, 1e-4);
  u[0].x() = 4e-3;  // passes 2 mm beside it
  EXPECT_EQ(vertex_face_impact(x, u, 1e-5), no_impact);
}

TEST(Ccd, AMotionInCommonIsNone) {
  const Four x{Vec3(0.2, 1e-3, -0.2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
  Four u;
  u.fill(Vec3(3, -40, 5));
  EXPECT_EQ(vertex_face_impact(x, u, 2e-4), no_impact);
  EXPECT_EQ(edge_edge_impact(x, u, 2e-4), no_impact);
}

TEST(Ccd, APairThatIsTooNearAtTheStartMeetsAtOnce) {
  const Four x{Vec3(0.2, 1e-4, -0.2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
  Four u;
  u.fill(Vec3::Zero());
  EXPECT_EQ(vertex_face_impact(x, u, 2e-4), 0);
}

TEST(Ccd, WhatHasHardlyRoomMayPartAndSlideAndNotCome) {
  const double xi = 1e-6, gap = 1.001e-6;
  const Four face{Vec3(0.2, gap, -0.2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
  const Four edges{Vec3(0.5, gap, -0.5), Vec3(0.5, gap, 0.5), Vec3(0, 0, 0), Vec3(1, 0, 0)};
  const auto moved = [](const Vec3& by, std::size_t count) {
    Four u{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < count; ++k) u[k] = by;
    return u;
  };
  for (const Vec3& by : {Vec3(0, 0.1, 0), Vec3(0.3, 0, 0.1), Vec3(-0.2, 1e-5, 0.05)}) {
    EXPECT_EQ(vertex_face_impact(face, moved(by, 1), xi), no_impact) << by.transpose();
    EXPECT_EQ(edge_edge_impact(edges, moved(by, 2), xi), no_impact) << by.transpose();
  }
  // A turn that begins by parting, and comes back on the other side.
  EXPECT_LE(vertex_face_impact(face, moved(Vec3(0.1, -1e-5, 0), 1), xi), 1);
  EXPECT_LE(edge_edge_impact(edges, moved(Vec3(0.1, -1e-5, 0), 2), xi), 1);
  EXPECT_LE(edge_edge_impact(edges, {Vec3(0, 0.5, 0), Vec3(0, -0.6, 0), Vec3::Zero(), Vec3::Zero()}, xi), 1);
}

TEST(Ccd, ALongSlideCloseByIsFree) {
  // 166,000 advances along, and the pair would count as an impact after 2000.
  const double xi = 1e-6, gap = 3e-6;
  const Four face{Vec3(0.2, gap, -0.2), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
  const Four edges{Vec3(0.5, gap, -0.5), Vec3(0.5, gap, 0.5), Vec3(0, 0, 0), Vec3(1, 0, 0)};
  const Vec3 by(0.3, 0, -0.1), zero = Vec3::Zero();
  EXPECT_EQ(vertex_face_impact(face, {by, zero, zero, zero}, xi), no_impact);
  EXPECT_EQ(edge_edge_impact(edges, {by, by, zero, zero}, xi), no_impact);
  // Not all of the way: it comes down at the end.
  const Vec3 down(0.3, -4e-6, -0.1);
  EXPECT_LE(vertex_face_impact(face, {down, zero, zero, zero}, xi), 1);
  EXPECT_LE(edge_edge_impact(edges, {down, down, zero, zero}, xi), 1);
}

TEST(Ccd, ParallelEdgesThatSlideThroughEachOtherMeet) {
  const Four x{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0.01, 0), Vec3(1, 0.01, 0)};
  const Four u{Vec3::Zero(), Vec3::Zero(), Vec3(0, -0.02, 0), Vec3(0, -0.02, 0)};
  EXPECT_NEAR(edge_edge_impact(x, u, 1e-4), 0.5, 0.01);
}

}  // namespace
}  // namespace toile::internal
