// Placement of panels, and points and lengths along their edges.
#include "core/error.hpp"
#include "garment/pattern.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

namespace toile::internal {
namespace {

constexpr double half_turn = std::numbers::pi;

class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : bits_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  Vec2 point() {
    const double x = (*this)(-1, 1), y = (*this)(-1, 1);
    return {x, y};
  }

 private:
  std::mt19937_64 bits_;
};

// A panel whose edge 0 is the given one, from corner 0 to corner 1.
Panel with_edge(const Vec2& start, const Vec2& end, CurveKind kind, const Vec2& c0 = {0, 0}, const Vec2& c1 = {0, 0}) {
  Panel panel;
  panel.corners = {start, end};
  PanelEdge edge;
  edge.start = 0;
  edge.end = 1;
  edge.kind = kind;
  edge.control = {c0, c1};
  panel.edges = {edge};
  return panel;
}

Panel with_arc(const Vec2& start, const Vec2& end, double radius, bool large, bool sweep) {
  Panel panel = with_edge(start, end, CurveKind::circle);
  panel.edges[0].radius_m = radius;
  panel.edges[0].large_arc = large;
  panel.edges[0].sweep = sweep;
  return panel;
}

PanelEdge reversed(PanelEdge edge) {
  std::swap(edge.start, edge.end);
  if (edge.kind == CurveKind::cubic) std::swap(edge.control[0], edge.control[1]);
  edge.sweep = !edge.sweep;
  return edge;
}

Vec2 bezier(const Panel& panel, double t) {
  const Vec2 &a = panel.corners[0], &b = panel.corners[1], &c = panel.edges[0].control[0],
             &d = panel.edges[0].control[1];
  const auto mix = [t](const Vec2& p, const Vec2& q) -> Vec2 { return (1 - t) * p + t * q; };
  if (panel.edges[0].kind == CurveKind::quadratic) return mix(mix(a, c), mix(c, b));
  const Vec2 ac = mix(a, c), cd = mix(c, d), db = mix(d, b);
  return mix(mix(ac, cd), mix(cd, db));
}

// Largest distance between the samples and points found along a fine polyline, and the polyline's length.
struct Reference {
  double length = 0, worst = 0;
};
Reference compare_with_polyline(const Panel& panel, int count) {
  constexpr std::size_t fine = 400'000;
  std::vector<double> length(fine + 1);
  Vec2 last = bezier(panel, 0);
  for (std::size_t k = 1; k <= fine; ++k) {
    const Vec2 p = bezier(panel, static_cast<double>(k) / fine);
    length[k] = length[k - 1] + (p - last).norm();
    last = p;
  }
  Reference result{length.back(), 0};
  const auto samples = sample_edge(panel, panel.edges[0], count);
  for (int k = 0; k <= count; ++k) {
    const double s = length.back() * k / count;
    const auto above = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::lower_bound(length.begin(), length.end(), s) - length.begin()), 1, fine);
    const double part = (s - length[above - 1]) / (length[above] - length[above - 1]);
    const Vec2 expected = bezier(panel, (static_cast<double>(above - 1) + part) / fine);
    result.worst = std::max(result.worst, (samples[static_cast<std::size_t>(k)] - expected).norm());
  }
  return result;
}

bool same_bits(const Vec2& a, const Vec2& b) { return std::memcmp(a.data(), b.data(), sizeof(double) * 2) == 0; }

TEST(PatternCurve, LineIsDividedEvenlyAndExactlyEnded) {
  const Panel panel = with_edge({0.1, 0.2}, {0.7, -0.3}, CurveKind::line);
  const auto points = sample_edge(panel, panel.edges[0], 3);
  ASSERT_EQ(points.size(), 4U);
  EXPECT_TRUE(same_bits(points[0], panel.corners[0]));
  EXPECT_TRUE(same_bits(points[3], panel.corners[1]));
  EXPECT_NEAR(points[1].x(), 0.3, 1e-15);
  EXPECT_NEAR(points[2].y(), -0.4 / 3, 1e-15);
  EXPECT_NEAR(edge_length_m(panel, panel.edges[0]), std::sqrt(0.61), 1e-15);
}

TEST(PatternCurve, QuadraticLengthMatchesTheClosedForm) {
  // A parabola y = x^2 from x = 0 to 1 has the length sqrt(5)/2 + asinh(2)/4; its control point is (1/2, 0).
  const Panel panel = with_edge({0, 0}, {1, 1}, CurveKind::quadratic, {0.5, 0});
  EXPECT_NEAR(edge_length_m(panel, panel.edges[0]), std::sqrt(5.0) / 2 + std::asinh(2.0) / 4, 1e-13);
}

TEST(PatternCurve, CurvesAreSampledEvenlyByArcLength) {
  const Panel panels[] = {
      with_edge({0, 0}, {1, 0}, CurveKind::quadratic, {0.1, 0.6}),
      with_edge({0, 0}, {1, 0}, CurveKind::quadratic, {0, 0}),                         // speed 0 at the start
      with_edge({0, 0}, {0.6, 0.1}, CurveKind::cubic, {0.05, 0.4}, {0.9, -0.7}),       // S
      with_edge({0, 0}, {1, 0}, CurveKind::cubic, {1.0001, 0.8}, {0, 0.8}),            // nearly a cusp
      with_edge({0, 0}, {0.3, 0.002}, CurveKind::cubic, {0.29, 0.001}, {0.295, 0.0}),  // crowded at one end
  };
  for (const Panel& panel : panels) {
    const Reference reference = compare_with_polyline(panel, 37);
    const double length = edge_length_m(panel, panel.edges[0]);
    EXPECT_NEAR(length, reference.length, 1e-9 * length);
    EXPECT_LT(reference.worst, 1e-4 * length / 37) << "the stated accuracy is 1e-4 of the spacing";
    EXPECT_LT(reference.worst, 1e-8 * length) << "and it is much better";
  }
}

TEST(PatternCurve, ReversedEdgeGivesTheSamePointsToTheBit) {
  Uniform uniform(20240611);
  const CurveKind kinds[] = {CurveKind::line, CurveKind::quadratic, CurveKind::cubic, CurveKind::circle};
  int compared = 0;
  for (int round = 0; round < 400; ++round) {
    const CurveKind kind = kinds[round % 4];
    const Vec2 a = uniform.point(), b = uniform.point(), c = uniform.point(), d = uniform.point();
    Panel panel = with_edge(a, round % 20 < 16 ? b : Vec2{a.x(), b.y()}, kind, c, d);  // equal x now and then
    PanelEdge& edge = panel.edges[0];
    edge.radius_m = (panel.corners[1] - panel.corners[0]).norm() * uniform(0.5, 2.0);
    edge.large_arc = round / 4 % 2 == 0;
    edge.sweep = round / 8 % 2 == 0;
    const auto forward = sample_edge(panel, edge, 1 + round % 23);
    auto backward = sample_edge(panel, reversed(edge), 1 + round % 23);
    std::reverse(backward.begin(), backward.end());
    ASSERT_EQ(forward.size(), backward.size());
    for (std::size_t k = 0; k < forward.size(); ++k) ASSERT_TRUE(same_bits(forward[k], backward[k])) << round;
    EXPECT_EQ(edge_length_m(panel, edge), edge_length_m(panel, reversed(edge)));
    EXPECT_TRUE(same_bits(forward.front(), panel.corners[0]));
    EXPECT_TRUE(same_bits(forward.back(), panel.corners[1]));
    compared += static_cast<int>(forward.size());
  }
  EXPECT_GT(compared, 4000);
}

TEST(PatternCurve, SweepTurnsCounterClockwiseWithYUp) {
  // Counter-clockwise from left to right goes through the bottom.
  const Panel panel = with_arc({0, 0}, {1, 0}, 0.5, false, true);
  const auto points = sample_edge(panel, panel.edges[0], 2);
  EXPECT_NEAR(points[1].x(), 0.5, 1e-15);
  EXPECT_NEAR(points[1].y(), -0.5, 1e-15);
}

// The conversion from end points to centre that SVG prescribes (SVG 1.1, F.6.5), with both radii equal and no rotation.
Vec2 svg_arc_point(const Vec2& start, const Vec2& end, double r, bool large, bool sweep, double u) {
  const Vec2 h = 0.5 * (start - end);
  const double sign = large == sweep ? -1 : 1;
  const double scale = sign * std::sqrt(std::max(0.0, r * r / h.squaredNorm() - 1));
  const Vec2 centre_from_middle{scale * h.y(), -scale * h.x()};
  const Vec2 centre = centre_from_middle + 0.5 * (start + end);
  const Vec2 from = start - centre, to = end - centre;
  const double first = std::atan2(from.y(), from.x());
  double turn = std::atan2(to.y(), to.x()) - first;
  if (sweep && turn < 0) turn += 2 * half_turn;
  if (!sweep && turn > 0) turn -= 2 * half_turn;
  return centre + r * Vec2{std::cos(first + u * turn), std::sin(first + u * turn)};
}

TEST(PatternCurve, ArcsFollowTheSvgRuleForAllFlags) {
  const Vec2 start{0.2, -0.1}, end{-0.3, 0.35};
  for (const double radius : {0.34, 0.5, 2.0}) {
    for (int flags = 0; flags < 4; ++flags) {
      const bool large = (flags & 1) != 0, sweep = (flags & 2) != 0;
      const Panel panel = with_arc(start, end, radius, large, sweep);
      const auto points = sample_edge(panel, panel.edges[0], 10);
      double polyline = 0;
      for (std::size_t k = 0; k <= 10; ++k) {
        const Vec2 expected = svg_arc_point(start, end, radius, large, sweep, static_cast<double>(k) / 10);
        EXPECT_LT((points[k] - expected).norm(), 1e-13) << radius << " " << large << sweep << " " << k;
        if (k > 0) polyline += (points[k] - points[k - 1]).norm();
      }
      EXPECT_GT(edge_length_m(panel, panel.edges[0]), polyline);
      EXPECT_LT(edge_length_m(panel, panel.edges[0]), polyline * 1.02);
    }
  }
}

TEST(PatternCurve, NearlyStraightArcKeepsItsDigits) {
  // Sagitta of a chord c: c^2 / (8 r) = 1.25e-10 m here; a centre 1e9 m away would lose it in rounding.
  const Panel panel = with_arc({0, 0}, {1, 0}, 1e9, false, false);
  const auto points = sample_edge(panel, panel.edges[0], 2);
  EXPECT_NEAR(points[1].y(), 1.25e-10, 1e-15);
  EXPECT_NEAR(points[1].x(), 0.5, 1e-15);
  EXPECT_NEAR(edge_length_m(panel, panel.edges[0]), 1.0, 1e-14);
}

TEST(PatternCurve, HalfCircleSurvivesARoundedRadius) {
  const Panel panel = with_arc({0, 0}, {0.2, 0}, 0.1 * (1 - 1e-9), false, true);
  for (const Vec2& p : sample_edge(panel, panel.edges[0], 8)) EXPECT_NEAR((p - Vec2{0.1, 0}).norm(), 0.1, 1e-9);
}

TEST(PatternCurve, RefusesACountOfNone) {
  const Panel panel = with_edge({0, 0}, {1, 0}, CurveKind::line);
  EXPECT_THROW(sample_edge(panel, panel.edges[0], 0), InputError);
}

TEST(PatternPlacement, TurnsAboutXThenYThenZ) {
  Panel panel;
  panel.rotation_deg = {90, 90, 0};
  panel.translation_m = {1, 2, 3};
  // About x: (0, 1, 0) -> (0, 0, 1); about y: (0, 0, 1) -> (1, 0, 0).  The other order would give (0, 0, 1).
  EXPECT_EQ(panel.place({0, 1}), Vec3(2, 2, 3));
  panel.rotation_deg = {30, 0, 90};
  // About x: (0, 1, 0) -> (0, cos 30, sin 30); about z: -> (-cos 30, 0, sin 30).
  EXPECT_LT((panel.place({0, 1}) - Vec3(1 - std::sqrt(0.75), 2, 3.5)).norm(), 1e-15);
}

TEST(PatternPlacement, QuarterTurnsAreExact) {
  Panel panel;
  panel.rotation_deg = {180, -180, 540};
  EXPECT_EQ(panel.rotation(), Mat3(Mat3::Identity()));
  panel.rotation_deg = {0, 180, 0};
  EXPECT_EQ(panel.place({0.3, 0.7}), Vec3(-0.3, 0.7, 0));
  panel.rotation_deg = {0, 0, -270};
  EXPECT_EQ(panel.place({0.3, 0.7}), Vec3(-0.7, 0.3, 0));
}

TEST(PatternPlacement, IsARotation) {
  Uniform uniform(7);
  Panel panel;
  for (int round = 0; round < 50; ++round) {
    panel.rotation_deg = {uniform(-400, 400), uniform(-400, 400), uniform(-400, 400)};
    const Mat3 r = panel.rotation();
    EXPECT_LT((r.transpose() * r - Mat3(Mat3::Identity())).norm(), 1e-15 * 10);
    EXPECT_NEAR(r.col(0).cross(r.col(1)).dot(r.col(2)), 1, 1e-14);
  }
}

}  // namespace
}  // namespace toile::internal
