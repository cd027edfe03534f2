// body/implicit_shape.hpp: the pieces that a body is blended from: lofts, ellipsoids, round cones as signed distances.
//
// A shape is a function f with f < 0 inside and f = 0 on the surface; near the surface f is about the distance in
// metres, which is all that blending and Newton steps need.
//   loft          sections along a straight axis; their centre, half-widths and squareness are natural cubic splines
//   section       rho(u/a, v/b) = 1 in the norm of a squircle, rho^2 = (q + sqrt(q^2 - 4 s^2 U^2 V^2)) / 2 with
//                 q = U^2 + V^2: an ellipse for s = 0, a rectangle for s = 1.  b differs for v > 0 (front) and
//                 v < 0 (back): bellies and backs are not alike
//   blend         cubic smooth minimum of width k: min(a, b) - k h^3 / 6 with h = max(0, 1 - |a - b| / k)
// Only + - * / sqrt are used, so that every machine computes the same bits; nothing here calls sin, pow or exp.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace toile::internal {

// The axes of a body: to its left, up, to its front.
inline const Vec3 x_axis(1, 0, 0), y_axis(0, 1, 0), z_axis(0, 0, 1);
// Left for right.
inline Vec3 image(const Vec3& p) { return {-p.x(), p.y(), p.z()}; }

// One cross-section of a loft; all lengths in metres.
struct LoftSection {
  double t = 0;                       // along the axis; sections are given in ascending t
  double centre_u = 0, centre_v = 0;  // of the section, across the axis
  double half_u = 0;                  // half-width along u
  double front_v = 0, back_v = 0;     // half-depths for v > centre_v and v < centre_v
  double squareness = 0;              // 0 ellipse ... < 1 rectangle
};

class Loft {
 public:
  // `t_axis`, `u_axis`, `v_axis` are orthonormal.  The ends are flat, rounded by `cap_radius`.
  Loft(const Vec3& origin, const Vec3& t_axis, const Vec3& u_axis, const Vec3& v_axis, double cap_radius,
       std::span<const LoftSection> sections);
  double operator()(const Vec3& p) const;
  // The section's parameters at t (clamped to the ends).
  LoftSection section(double t) const;

 private:
  using Knot = std::array<double, 6>;  // centre_u, centre_v, half_u, front_v, back_v, squareness
  Vec3 origin_, t_axis_, u_axis_, v_axis_;
  double cap_radius_;
  double reach_u_ = 0, reach_v_ = 0;  // bound of |u|, |v| on the surface, for the early exit
  std::vector<double> t_;
  std::vector<Knot> value_, second_;  // second derivatives of the natural spline
};

// `far(p, d)` of a shape f, cheaper than f(p): true only if f(p) > d, by more than rounding.
struct Ellipsoid {
  Vec3 centre, radii;
  double operator()(const Vec3& p) const;
  bool far(const Vec3& p, double d) const;
};

struct RoundCone {  // the hull of two spheres, to first order in the difference of radii
  Vec3 a, b;
  double radius_a = 0, radius_b = 0;
  double operator()(const Vec3& p) const;
  bool far(const Vec3& p, double d) const;
};

// Between min(a, b) - k / 6 and min(a, b), and min(a, b) where they differ by k or more.
inline double smooth_min(double a, double b, double k) {
  const double difference = std::abs(a - b);
  if (difference >= k) return std::min(a, b);
  const double h = std::max(0.0, 1.0 - difference / k);
  return std::min(a, b) - h * h * h * k / 6.0;
}
inline double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

}  // namespace toile::internal
