// body/implicit_shape.cpp: distances of lofts, ellipsoids and round cones.
//
// The distance to a section is first-order exact: (rho - 1) / |grad rho|, with rho homogeneous of degree one in (u, v).
#include "body/implicit_shape.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {

namespace {

// A shape farther than this from a point has no part in any blend there; its exact distance does not matter.
constexpr double far_m = 0.12;
constexpr double rounding_m = 1e-9;  // far more than that of any distance here

// Second derivatives of the natural cubic spline through (t, y): the usual tridiagonal system, solved forwards and
// back.
std::vector<double> natural_spline(std::span<const double> t, std::span<const double> y) {
  const std::size_t n = t.size();
  std::vector<double> second(n, 0.0), upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = t[i] - t[i - 1], right = t[i + 1] - t[i];
    const double rhs = 6.0 * ((y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left);
    const double pivot = 2.0 * (left + right) - left * upper[i - 1];
    upper[i] = right / pivot;
    second[i] = (rhs - left * second[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) second[i] -= upper[i] * second[i + 1];
  return second;
}

}  // namespace

Loft::Loft(const Vec3& origin, const Vec3& t_axis, const Vec3& u_axis, const Vec3& v_axis, double cap_radius,
           std::span<const LoftSection> sections)
    : origin_(origin), t_axis_(t_axis), u_axis_(u_axis), v_axis_(v_axis), cap_radius_(cap_radius) {
  TOILE_ASSERT(sections.size() >= 2);
  for (const LoftSection& s : sections) {
    TOILE_ASSERT(t_.empty() || s.t > t_.back());
    t_.push_back(s.t);
    value_.push_back({s.centre_u, s.centre_v, s.half_u, s.front_v, s.back_v, s.squareness});
    reach_u_ = std::max(reach_u_, std::abs(s.centre_u) + s.half_u);
    reach_v_ = std::max(reach_v_, std::abs(s.centre_v) + std::max(s.front_v, s.back_v));
  }
  reach_u_ *= 1.1;  // a spline may swing past its knots
  reach_v_ *= 1.1;
  second_.resize(value_.size());
  std::vector<double> column(value_.size());
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < value_.size(); ++i) column[i] = value_[i][k];
    const std::vector<double> second = natural_spline(t_, column);
    for (std::size_t i = 0; i < value_.size(); ++i) second_[i][k] = second[i];
  }
}

LoftSection Loft::section(double t) const {
  t = std::clamp(t, t_.front(), t_.back());
  std::size_t i = 0;
  while (i + 2 < t_.size() && t > t_[i + 1]) ++i;
  const double h = t_[i + 1] - t_[i];
  const double b = (t - t_[i]) / h, a = 1.0 - b;
  const double ca = (a * a * a - a) * h * h / 6.0, cb = (b * b * b - b) * h * h / 6.0;
  Knot k;
  for (std::size_t j = 0; j < 6; ++j)
    k[j] = a * value_[i][j] + b * value_[i + 1][j] + ca * second_[i][j] + cb * second_[i + 1][j];
  return {t, k[0], k[1], k[2], k[3], k[4], k[5]};
}

double Loft::operator()(const Vec3& p) const {
  const Vec3 q = p - origin_;
  const double t = q.dot(t_axis_), u = q.dot(u_axis_), v = q.dot(v_axis_);
  const double beyond = std::max(t_.front() - t, t - t_.back());  // of the end planes
  const double away = std::max({beyond, std::abs(u) - reach_u_, std::abs(v) - reach_v_});
  if (away > far_m) return away;

  const LoftSection s = section(t);
  const double du = u - s.centre_u, dv = v - s.centre_v;
  const double depth = dv >= 0 ? s.front_v : s.back_v;
  const double U = du / s.half_u, V = dv / depth;
  const double s2 = s.squareness * s.squareness;
  const double sum = U * U + V * V;
  double across = -std::min(s.half_u, depth);  // the centre line, where the gradient has no direction
  if (sum > 1e-12) {
    const double root = std::sqrt(std::max(sum * sum - 4.0 * s2 * U * U * V * V, 0.0));
    const double rho = std::sqrt(0.5 * (sum + root));
    double gu = U / rho, gv = V / rho;  // of an ellipse
    if (root > 1e-12) {                 // 4 rho d(rho) = d(sum) + d(root)
      gu = (2.0 * U + (2.0 * sum * U - 4.0 * s2 * U * V * V) / root) / (4.0 * rho);
      gv = (2.0 * V + (2.0 * sum * V - 4.0 * s2 * V * U * U) / root) / (4.0 * rho);
    }
    gu /= s.half_u;
    gv /= depth;
    across = (rho - 1.0) / std::sqrt(gu * gu + gv * gv);
  }
  // The intersection of the tube with the slab between the end planes, its edge rounded.
  const double r = cap_radius_;
  const double x = across + r, y = beyond + r;
  const double outside = std::sqrt(std::max(x, 0.0) * std::max(x, 0.0) + std::max(y, 0.0) * std::max(y, 0.0));
  return std::min(std::max(x, y), 0.0) + outside - r;
}

double Ellipsoid::operator()(const Vec3& p) const {
  const Vec3 q = p - centre;
  const double ux = q.x() / radii.x(), uy = q.y() / radii.y(), uz = q.z() / radii.z();
  const double k0 = std::sqrt(ux * ux + uy * uy + uz * uz);
  if (k0 < 1e-6) return -std::min({radii.x(), radii.y(), radii.z()});
  const double gx = ux / radii.x(), gy = uy / radii.y(), gz = uz / radii.z();
  return k0 * (k0 - 1.0) / std::sqrt(gx * gx + gy * gy + gz * gz);
}

// f = k0 (k0 - 1) / |grad k0^2 / 2| >= r_min (k0 - 1), and k0 >= |q| / r_max.
bool Ellipsoid::far(const Vec3& p, double d) const {
  const double least = std::min({radii.x(), radii.y(), radii.z()}), most = std::max({radii.x(), radii.y(), radii.z()});
  const double reach = most * (least + std::max(d, 0.0) + rounding_m);
  return (p - centre).squaredNorm() * (least * least) > reach * reach;
}

double RoundCone::operator()(const Vec3& p) const {
  const Vec3 axis = b - a, q = p - a;
  const double t = std::clamp(q.dot(axis) / axis.dot(axis), 0.0, 1.0);
  const Vec3 d = q - t * axis;
  return std::sqrt(d.dot(d)) - (radius_a + t * (radius_b - radius_a));
}

// The axis ends nearer to p than |q| - |axis|, and (a + b)^2 <= 2 a^2 + 2 b^2.
bool RoundCone::far(const Vec3& p, double d) const {
  const double reach = std::max(radius_a, radius_b) + std::max(d, 0.0) + rounding_m;
  return (p - a).squaredNorm() > 2 * ((b - a).squaredNorm() + reach * reach);
}

}  // namespace toile::internal
