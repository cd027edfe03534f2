// garment/pattern.cpp: where panels stand in the world, and points along their edges.
//
// Bezier:  B(t) of degree 2 or 3, arc length s(t) = int_0^t |B'| by Gauss-Legendre on intervals halved until it settles;
//          t(s) by Newton's method kept inside a bracket.
// Circle:  with half the opening angle phi, sin phi = chord / (2 r), the point at the fraction u of the arc is
//          start + 2 r sin(u phi) * direction of the chord turned by -+ (1 - u) phi.  No centre: a centre far away would
//          cost all digits of a nearly straight arc.
//
// Easily got wrong: floating point is not symmetric in the two ends of a curve.  Two edges that share a seam must
// give the same points whichever way they run, so every curve is first turned into ONE direction (the lower end first) and
// the result is turned back.
#include "garment/pattern.hpp"

#include "core/elementary.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace toile::internal {
namespace {

// An edge with its end points in a fixed order.
struct Curve {
  CurveKind kind = CurveKind::line;
  Vec2 from, to;
  std::array<Vec2, 2> control;
  double radius_m = 0;
  bool large_arc = false, counter_clockwise = false;
  bool reversed = false;  // against the edge
};

bool comes_before(const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); }

Curve canonical(const Panel& panel, const PanelEdge& edge) {
  Curve c;
  c.kind = edge.kind;
  c.from = panel.corners[static_cast<std::size_t>(edge.start)];
  c.to = panel.corners[static_cast<std::size_t>(edge.end)];
  c.control = edge.control;
  c.radius_m = std::max(edge.radius_m, 0.5 * (c.to - c.from).norm());  // a half circle's radius may be rounded down
  c.large_arc = edge.large_arc;
  c.counter_clockwise = edge.sweep;
  if (comes_before(c.to, c.from)) {
    c.reversed = true;
    std::swap(c.from, c.to);
    if (c.kind == CurveKind::cubic) std::swap(c.control[0], c.control[1]);
    c.counter_clockwise = !c.counter_clockwise;
  }
  return c;
}

// Arc length of a Bezier curve and its inverse.
class BezierLength {
 public:
  explicit BezierLength(const Curve& curve) : curve_(curve) {
    const bool cubic = curve.kind == CurveKind::cubic;
    if (cubic) {
      derivative_ = {3 * (curve.control[0] - curve.from), 3 * (curve.control[1] - curve.control[0]),
                     3 * (curve.to - curve.control[1])};
    } else {  // of degree 1, written with degree 2 so that one loop serves both
      const Vec2 d0 = 2 * (curve.control[0] - curve.from), d1 = 2 * (curve.to - curve.control[0]);
      derivative_ = {d0, 0.5 * (d0 + d1), d1};
    }
    // No part of the curve is longer than its control polygon: a scale for the tolerance that cannot be 0 by accident.
    const double scale = (derivative_[0].norm() + derivative_[1].norm() + derivative_[2].norm()) / 3;
    pieces_.push_back({0, 0});
    integrate(0, 1, gauss(0, 1), 1e-13 * scale, 0);
  }

  double total() const { return pieces_.back().length; }

  // The point at arc length `s` from the start of the curve.
  Vec2 point_at(double s) const {
    const auto above = std::upper_bound(pieces_.begin() + 1, pieces_.end() - 1, s,
                                        [](double value, const Piece& piece) { return value < piece.length; });
    const Piece& begin = *(above - 1);
    double low = begin.t, high = above->t;
    const double span = above->length - begin.length;
    double t = span > 0 ? low + (high - low) * (s - begin.length) / span : low;
    for (int iteration = 0; iteration < 60; ++iteration) {
      const double error = begin.length + gauss(begin.t, t) - s;
      if (std::abs(error) <= 1e-14 * total()) break;
      (error > 0 ? high : low) = t;
      const double slope = speed(t);
      double next = slope > 0 ? t - error / slope : low;
      if (!(next > low && next < high)) next = 0.5 * (low + high);  // Newton left the bracket: near a cusp
      if (next == t) break;
      t = next;
    }
    return point(t);
  }

 private:
  struct Piece {
    double t, length;  // from the start of the curve up to parameter t
  };

  double speed(double t) const {
    const double u = 1 - t;
    return (u * u * derivative_[0] + 2 * u * t * derivative_[1] + t * t * derivative_[2]).norm();
  }

  Vec2 point(double t) const {
    const double u = 1 - t;
    if (curve_.kind == CurveKind::cubic) {
      return u * u * u * curve_.from + 3 * u * u * t * curve_.control[0] + 3 * u * t * t * curve_.control[1] +
             t * t * t * curve_.to;
    }
    return u * u * curve_.from + 2 * u * t * curve_.control[0] + t * t * curve_.to;
  }

  double gauss(double a, double b) const {  // five points: exact to degree 9
    constexpr double node1 = 0.53846931010568309104, node2 = 0.90617984593866399280;
    constexpr double weight0 = 0.56888888888888888889, weight1 = 0.47862867049936646804,
                     weight2 = 0.23692688505618908751;
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    return half * (weight0 * speed(middle) + weight1 * (speed(middle - half * node1) + speed(middle + half * node1)) +
                   weight2 * (speed(middle - half * node2) + speed(middle + half * node2)));
  }

  void integrate(double a, double b, double whole, double tolerance, int depth) {
    constexpr int least_depth = 2, most_depth = 24;  // least: five points may agree by luck on an S-shaped curve
    const double middle = 0.5 * (a + b), left = gauss(a, middle), right = gauss(middle, b);
    const bool settled = std::abs(left + right - whole) <= tolerance;
    if ((settled && depth >= least_depth) || depth == most_depth) {
      pieces_.push_back({middle, pieces_.back().length + left});
      pieces_.push_back({b, pieces_.back().length + right});
      return;
    }
    integrate(a, middle, left, tolerance, depth + 1);
    integrate(middle, b, right, tolerance, depth + 1);
  }

  Curve curve_;
  std::array<Vec2, 3> derivative_;
  std::vector<Piece> pieces_;
};

// Half the opening angle of a circle's arc: at most a right angle for the small arc, the rest of pi for the large one.
double half_opening(const Curve& c) {
  const double sine = std::min(1.0, 0.5 * (c.to - c.from).norm() / c.radius_m);  // not 1 + rounding
  return c.large_arc ? std::numbers::pi - ieee_asin(sine) : ieee_asin(sine);
}

Vec2 arc_point(const Curve& c, double phi, double u) {
  const Vec2 chord = (c.to - c.from).normalized();
  // Counter-clockwise from `from` to `to` the arc bulges to the right of the chord.
  const double turn = (c.counter_clockwise ? -1 : 1) * (1 - u) * phi;
  const double cosine = ieee_cos(turn), sine = ieee_sin(turn);
  const Vec2 direction{cosine * chord.x() - sine * chord.y(), sine * chord.x() + cosine * chord.y()};
  return c.from + 2 * c.radius_m * ieee_sin(u * phi) * direction;
}

// Cosine and sine of an angle in degrees; exact at multiples of 90, so that panels turned to the back stay flat in z.
std::array<double, 2> cosine_sine(double degrees) {
  const double reduced = std::remainder(degrees, 360.0);  // exact, in [-180, 180]
  if (reduced == 0) return {1, 0};
  if (reduced == 90) return {0, 1};
  if (reduced == -90) return {0, -1};
  if (std::abs(reduced) == 180) return {-1, 0};
  const double radians = reduced * std::numbers::pi / 180;
  return {ieee_cos(radians), ieee_sin(radians)};
}

}  // namespace

Mat3 Panel::rotation() const {
  const auto [cx, sx] = cosine_sine(rotation_deg.x());
  const auto [cy, sy] = cosine_sine(rotation_deg.y());
  const auto [cz, sz] = cosine_sine(rotation_deg.z());
  Mat3 about_x, about_y, about_z;
  about_x << 1, 0, 0, 0, cx, -sx, 0, sx, cx;
  about_y << cy, 0, sy, 0, 1, 0, -sy, 0, cy;
  about_z << cz, -sz, 0, sz, cz, 0, 0, 0, 1;
  return about_z * about_y * about_x;
}

Vec3 Panel::place(const Vec2& p) const { return rotation() * Vec3{p.x(), p.y(), 0} + translation_m; }

Index Panel::file_number(Index edge) const {
  const Index number = edges[static_cast<std::size_t>(edge)].file_number;
  return number >= 0 ? number : edge;
}

double edge_length_m(const Panel& panel, const PanelEdge& edge) {
  const Curve c = canonical(panel, edge);
  switch (c.kind) {
    case CurveKind::line:
      return (c.to - c.from).norm();
    case CurveKind::circle:
      return 2 * c.radius_m * half_opening(c);
    case CurveKind::quadratic:
    case CurveKind::cubic:
      break;
  }
  return BezierLength(c).total();
}

void finish_other_edges(Pattern& pattern, const EdgeFinish& finish) {
  std::vector<std::vector<char>> sewn;
  for (const Panel& panel : pattern.panels) sewn.emplace_back(panel.edges.size(), 0);
  for (const Stitch& stitch : pattern.stitches)
    for (const StitchSide& side : {stitch.a, stitch.b}) sewn[at(side.panel)][at(side.edge)] = 1;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    for (std::size_t e = 0; e < sewn[p].size(); ++e) {
      PanelEdge& edge = pattern.panels[p].edges[e];
      if (edge.finish_given) continue;
      edge.finish = sewn[p][e] ? EdgeFinish{0, 0, finish.allowance_m, finish.topstitched}
                               : EdgeFinish{finish.hem_m, edge.label.empty() ? 0 : finish.tape_m};
    }
  }
}

std::vector<Vec2> sample_edge(const Panel& panel, const PanelEdge& edge, int count) {
  if (count < 1) throw InputError("", "sample_edge", "a count of at least 1", std::to_string(count));
  const Curve c = canonical(panel, edge);
  const auto n = static_cast<std::size_t>(count);
  std::vector<Vec2> points(n + 1);
  points.front() = c.from;
  points.back() = c.to;
  switch (c.kind) {
    case CurveKind::line:
      for (std::size_t k = 1; k < n; ++k) {
        points[k] = c.from + (static_cast<double>(k) / static_cast<double>(n)) * (c.to - c.from);
      }
      break;
    case CurveKind::circle: {
      const double phi = half_opening(c);
      for (std::size_t k = 1; k < n; ++k) {
        points[k] = arc_point(c, phi, static_cast<double>(k) / static_cast<double>(n));
      }
      break;
    }
    case CurveKind::quadratic:
    case CurveKind::cubic: {
      const BezierLength length(c);
      for (std::size_t k = 1; k < n; ++k) {
        points[k] = length.point_at(length.total() * (static_cast<double>(k) / static_cast<double>(n)));
      }
      break;
    }
  }
  if (c.reversed) std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace toile::internal
