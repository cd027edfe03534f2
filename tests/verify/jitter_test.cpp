// Jitter of motions that are known in closed form, and of random ones against all pairs.
#include "verify/jitter.hpp"

#include "core/parallel.hpp"
#include "verify/nearest_point.hpp"
#include "verify/verify.hpp"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace toile::internal {
namespace {

constexpr double pi = std::numbers::pi, mm = 1e-3;

struct RandomPlaces {
  std::mt19937_64 bits{20260};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  Vec3 in_box(double half) { return {(*this)(-half, half), (*this)(-half, half), (*this)(-half, half)}; }
};

struct Surface {
  Vec3s x;
  std::vector<Triangle> triangles;
};

// A level square of 1 m around the origin, its corners displaced at random.
Surface ground() {
  constexpr int n = 20;
  RandomPlaces random;
  Surface s;
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c) s.x.push_back(Vec3(-0.5 + c * 1.0 / n, 0, -0.5 + r * 1.0 / n) + random.in_box(0.01));
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const Index i = r * (n + 1) + c;
      s.triangles.push_back({i, i + n + 1, i + 1});
      s.triangles.push_back({i + 1, i + n + 1, i + n + 2});
    }
  return s;
}

Vec3s over_the_ground(double height) {
  RandomPlaces random;
  Vec3s x;
  for (int k = 0; k < 50; ++k) x.push_back({random(-0.3, 0.3), height + 0.02, random(-0.3, 0.3)});
  return x;
}

using Motion = std::function<Vec3(double t)>;
constexpr auto no_motion = [](double) { return Vec3(0, 0, 0); };

Vec3s moved(Vec3s x, const Vec3& by) {
  for (Vec3& p : x) p += by;
  return x;
}

JitterStatistics jitter_of(double height, const Motion& of_cloth, const Motion& of_body, double fps = 30,
                           int frames = 90) {
  const Surface body = ground();
  const Vec3s cloth = over_the_ground(height);
  JitterMeter meter(body.triangles, fps);
  for (int f = 0; f < frames; ++f) meter.add(moved(cloth, of_cloth(f / fps)), moved(body.x, of_body(f / fps)));
  return meter.statistics();
}

// A point that goes round evenly is as fast in every frame.
Motion circle(double amplitude, double hertz) {
  return [=](double t) {
    return Vec3(amplitude * std::cos(2 * pi * hertz * t), 0, amplitude * std::sin(2 * pi * hertz * t));
  };
}

double response_mm_per_s(double amplitude, double hertz, double fps) {
  return 1000 * 2 * amplitude * fps * std::pow(std::sin(pi * hertz / fps), 5);
}

TEST(Jitter, OfAMillimetreAtTwelveHertzIsThatOfTheFormula) {
  const JitterStatistics jitter = jitter_of(0.003, circle(1 * mm, 12), no_motion);
  EXPECT_EQ(jitter.windows, 85);
  EXPECT_NEAR(jitter.max_mm_per_s, 46.6856, 1e-4);  // 60 sin^5(72 degrees)
  EXPECT_NEAR(jitter.p50_mm_per_s, 46.6856, 0.05);
  EXPECT_NEAR(jitter.p99_mm_per_s, 46.6856, 0.05);
}

TEST(Jitter, RespondsToEveryFrequencyAsDocumented) {
  for (const double fps : {24.0, 30.0, 60.0})
    for (const double hertz : {0.5, 3.0, 6.0, 9.0, 11.5})
      EXPECT_NEAR(jitter_of(0.003, circle(1 * mm, hertz), no_motion, fps).max_mm_per_s,
                  response_mm_per_s(1 * mm, hertz, fps), 1e-6)
          << hertz << " Hz at " << fps;
  // The filter alone passes one half at 0.318 fps.
  const double hertz = 0.318 * 30, difference_mm_per_s = 2 * 30 * std::sin(pi * 0.318);
  EXPECT_NEAR(jitter_of(0.003, circle(1 * mm, hertz), no_motion).max_mm_per_s / difference_mm_per_s, 0.5, 1e-3);
}

TEST(Jitter, HardlyKnowsASlowSwing) {
  const JitterStatistics jitter = jitter_of(0.003, circle(100 * mm, 1), no_motion);
  EXPECT_NEAR(jitter.max_mm_per_s, 0.0749, 1e-4);  // of a swing of 628 mm/s
}

TEST(Jitter, IsNoneWhereClothFollowsTheBodyHoweverItJumps) {
  RandomPlaces random;
  std::vector<Vec3> jumps;
  for (int f = 0; f < 90; ++f) jumps.push_back(random.in_box(0.02));
  const Motion jump = [&](double t) { return jumps[static_cast<std::size_t>(std::lround(30 * t))]; };
  EXPECT_LT(jitter_of(0.003, jump, jump).max_mm_per_s, 1e-6);
  EXPECT_GT(jitter_of(0.003, no_motion, jump).p50_mm_per_s, 100);
  EXPECT_GT(jitter_of(0.003, jump, no_motion).p50_mm_per_s, 100);
}

TEST(Jitter, OfAGarmentThatTurnsWithItsBodyIsNone) {
  const Surface body = ground();
  const Vec3s cloth = over_the_ground(0.003);
  JitterMeter meter(body.triangles, 30);
  for (int f = 0; f < 60; ++f) {  // a turn a second, 2 m/s at the rim
    const auto turned = [&](Vec3s x) {
      const double angle = 2 * pi * f / 30;
      for (Vec3& p : x)
        p = Vec3(std::cos(angle) * p.x() - std::sin(angle) * p.y(), std::sin(angle) * p.x() + std::cos(angle) * p.y(),
                 p.z());
      return x;
    };
    meter.add(turned(cloth), turned(body.x));
  }
  EXPECT_LT(meter.statistics().max_mm_per_s, 0.05);
}

TEST(Jitter, BeyondReachIsThatOfTheClothAlone) {
  const Motion body = circle(1 * mm, 12);
  EXPECT_NEAR(jitter_of(0.02, no_motion, body).p50_mm_per_s, 46.7, 0.06);
  EXPECT_LT(jitter_of(0.06, no_motion, body).max_mm_per_s, 1e-6);
  EXPECT_NEAR(jitter_of(0.06, body, body).p50_mm_per_s, 46.7, 0.06);
  EXPECT_LT(jitter_of(0.02, body, body).max_mm_per_s, 1e-6);
}

// Two plates 8 mm apart, and cloth that goes evenly from one to the other: the nearest point jumps on the way.
TEST(Jitter, FollowsOnePointOfTheBodyThroughItsWindow) {
  Surface body;
  for (const double z : {-4 * mm, 4 * mm})
    for (const Vec3& p : {Vec3(-1, -1, z), Vec3(1, -1, z), Vec3(0, 1, z)}) body.x.push_back(p);
  body.triangles = {{0, 1, 2}, {3, 4, 5}};
  JitterMeter meter(body.triangles, 30);
  for (int f = -10; f <= 10; ++f) meter.add(Vec3s{{0, 0, 0.3 * mm * f}}, body.x);
  EXPECT_LT(meter.statistics().max_mm_per_s, 1e-6);
}

TEST(Jitter, OfADrapeIsForgottenWhenTheBodyBeginsToMove) {
  const Motion tremble = circle(1 * mm, 12);
  const auto starts = [](double t) { return Vec3(std::max(0.0, t - 2), 0, 0); };  // after frame 60
  const auto calms = [&](double t) -> Vec3 { return t < 1.99 ? tremble(t) : starts(t) + tremble(1.98); };
  const JitterStatistics jitter = jitter_of(0.003, calms, starts);
  EXPECT_EQ(jitter.windows, 25);  // 30 frames, the first of them the last in which the body stood
  EXPECT_LT(jitter.max_mm_per_s, 1e-6);
  EXPECT_GE(jitter.worst_frame, 62);
  EXPECT_GT(jitter_of(0.003, calms, no_motion).p50_mm_per_s, 40);  // a body that never moves
  // Percentiles forget it too: here one jump is the largest of a calm motion.
  const auto jumps_once = [&](double t) -> Vec3 { return calms(t) + Vec3(0, t > 2.95 ? 0.01 : 0, 0); };
  EXPECT_GT(jitter_of(0.003, jumps_once, starts).max_mm_per_s, 15);
  EXPECT_EQ(jitter_of(0.003, jumps_once, starts).p50_mm_per_s, 0);
}

TEST(Jitter, IsNotMeasuredOverASkippedFrame) {
  const Surface body = ground();
  const Vec3s cloth = over_the_ground(0.003);
  JitterMeter meter(body.triangles, 30);
  for (int f = 0; f < 20; ++f) {
    if (f == 10) {
      meter.skip();
    } else {
      meter.add(moved(cloth, Vec3(f < 10 ? 0 : 0.5, 0, 0)), body.x);
    }
  }
  EXPECT_EQ(meter.statistics().windows, 5 + 4);
  EXPECT_LT(meter.statistics().max_mm_per_s, 1e-6);
}

struct RandomRun {
  Surface body;
  std::vector<Vec3s> cloth_frames, body_frames;
};

RandomRun random_run() {
  RandomRun run{ground(), {}, {}};
  RandomPlaces random;
  Vec3s cloth = over_the_ground(0.03), body_x = run.body.x;
  for (int f = 0; f < 40; ++f) {
    for (Vec3& p : cloth) p += random.in_box(0.01);
    if (f > 3)
      for (Vec3& p : body_x) p += random.in_box(0.01);
    run.cloth_frames.push_back(cloth);
    run.body_frames.push_back(body_x);
  }
  return run;
}

JitterStatistics measure(const RandomRun& run) {
  JitterMeter meter(run.body.triangles, 30);
  for (std::size_t f = 0; f < run.cloth_frames.size(); ++f) meter.add(run.cloth_frames[f], run.body_frames[f]);
  return meter.statistics();
}

TEST(Jitter, OfARandomRunIsThatOfAllPairsWrittenOut) {
  const RandomRun run = random_run();
  std::vector<double> speeds;
  double max = 0;
  Index worst_vertex = -1;
  int worst_frame = -1;
  for (std::size_t first = 3; first + 6 <= run.cloth_frames.size(); ++first)  // the body moves from frame 3 on
    for (std::size_t i = 0; i < run.cloth_frames[0].size(); ++i) {
      const auto& m = run.body_frames[first + 2];
      const Vec3& p = run.cloth_frames[first + 2][i];
      double least = 0.05 * 0.05;
      Triangle corners{-1, -1, -1};
      for (const Triangle& t : run.body.triangles) {
        const double d = squared_distance_to_triangle(
            p, m[static_cast<std::size_t>(t[0])], m[static_cast<std::size_t>(t[1])], m[static_cast<std::size_t>(t[2])]);
        if (d < least) least = d, corners = t;
      }
      std::array<Vec3, 6> u;
      for (std::size_t k = 0; k < 6; ++k) {
        u[k] = run.cloth_frames[first + k][i];
        if (corners[0] < 0) continue;
        const auto at = [&](std::size_t c) { return static_cast<std::size_t>(corners[c]); };
        const Vec3 w = nearest_weights(p, m[at(0)], m[at(1)], m[at(2)]);
        const auto& b = run.body_frames[first + k];
        u[k] -= w[0] * b[at(0)] + w[1] * b[at(1)] + w[2] * b[at(2)];
      }
      std::array<Vec3, 5> v;
      for (std::size_t k = 0; k < 5; ++k) v[k] = 30 * (u[k + 1] - u[k]);
      speeds.push_back(1000 * ((v[0] + v[4]) - 4 * (v[1] + v[3]) + 6 * v[2]).norm() / 16);
      if (speeds.back() > max) {
        max = speeds.back();
        worst_vertex = static_cast<Index>(i);
        worst_frame = static_cast<int>(first + 2);
      }
    }
  const JitterStatistics jitter = measure(run);
  EXPECT_NEAR(jitter.max_mm_per_s, max, 1e-9 * max);
  EXPECT_EQ(jitter.worst_vertex, worst_vertex);
  EXPECT_EQ(jitter.worst_frame, worst_frame);
  EXPECT_NEAR(jitter.p50_mm_per_s, nearest_rank(speeds, 50), 0.051);
  EXPECT_NEAR(jitter.p99_mm_per_s, nearest_rank(speeds, 99), 0.051);
  EXPECT_GT(jitter.p50_mm_per_s, 100);
}

TEST(Jitter, IsTheSameOnAnyNumberOfThreads) {
  const RandomRun run = random_run();
  JitterStatistics one, five;
  with_threads(1, [&] { one = measure(run); });
  with_threads(5, [&] { five = measure(run); });
  EXPECT_EQ(one.max_mm_per_s, five.max_mm_per_s);
  EXPECT_EQ(one.p50_mm_per_s, five.p50_mm_per_s);
  EXPECT_EQ(one.p99_mm_per_s, five.p99_mm_per_s);
  EXPECT_EQ(one.worst_vertex, five.worst_vertex);
}

TEST(Jitter, BeyondTheHistogramIsReportedAsTheLargest) {
  const JitterStatistics jitter = jitter_of(0.2, circle(0.1, 12), no_motion);
  EXPECT_NEAR(jitter.max_mm_per_s, 4668.56, 0.01);
  EXPECT_EQ(jitter.p50_mm_per_s, jitter.max_mm_per_s);
}

TEST(NearestPoint, OfATriangleIsNearerThanADenseSampling) {
  RandomPlaces random;
  for (int trial = 0; trial < 2000; ++trial) {
    Vec3 a = random.in_box(1), b = random.in_box(1), c = random.in_box(1);
    if (trial % 10 == 0) c = 0.5 * (a + b);  // no area
    if (trial % 10 == 1) c = a + 1e-3 * random.in_box(1);
    const Vec3 p = random.in_box(1.5);
    const Vec3 w = nearest_weights(p, a, b, c);
    EXPECT_NEAR(w.sum(), 1, 1e-12);
    EXPECT_GE(w.minCoeff(), -1e-12);
    const double squared = (p - w[0] * a - w[1] * b - w[2] * c).squaredNorm();
    EXPECT_NEAR(squared, squared_distance_to_triangle(p, a, b, c), 1e-9);
    constexpr int n = 20;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const double s = static_cast<double>(i) / n, t = static_cast<double>(j) / n;
        ASSERT_LE(squared, (p - (1 - s - t) * a - s * b - t * c).squaredNorm() + 1e-9);
      }
  }
}

TEST(RunAudit, MeasuresJitterFromSixFramesOn) {
  RunDescription description;
  description.mesh.particle_count = 3;
  description.mesh.triangles = {{0, 1, 2}};
  description.mesh.uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}};
  description.mesh.panel = {0};
  RunAudit audit(description);
  const Vec3s x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int f = 0; f < 12; ++f) {
    EXPECT_EQ(audit.report().jitter.windows, std::max(0, f - 5));
    audit.add(moved(x, (f % 2 == 0 ? 0.5 : -0.5) * mm * Vec3::UnitZ()), {});
  }
  EXPECT_NEAR(audit.report().jitter.max_mm_per_s, 30, 1e-9);  // 2 A fps: half the rate of frames passes whole
  audit.add(Vec3s(3, Vec3::Constant(std::nan(""))), {});
  EXPECT_EQ(audit.report().jitter.windows, 7) << "what was measured before a bad frame stays";
  for (int f = 0; f < 6; ++f) audit.add(x, {});
  EXPECT_EQ(audit.report().jitter.windows, 8) << "no window reaches over a bad frame";
}

}  // namespace
}  // namespace toile::internal
