#include "sim/cloth_ribbon.hpp"

#include "core/elementary.hpp"
#include "core/error.hpp"
#include "io/json.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

// The triangulation counts in 2^-20 m.
constexpr double nearest_points_m = 2e-6;

double length_of(const std::vector<Vec3>& path, bool closed) {
  double length = closed ? (path.front() - path.back()).norm() : 0;
  for (std::size_t k = 1; k < path.size(); ++k) length += (path[k] - path[k - 1]).norm();
  return length;
}

// A finely sampled curve, with the direction across the ribbon at each point.
struct Curve {
  Vec3s x, across;
  std::vector<double> s;  // arc length

  template <class Of>
  auto at_length(double length, const Of& of) const {
    const auto after = std::upper_bound(s.begin() + 1, s.end() - 1, length);
    const auto k = static_cast<std::size_t>(after - s.begin());
    const double share = (length - s[k - 1]) / (s[k] - s[k - 1]);
    return Vec3((1 - share) * of[k - 1] + share * of[k]);
  }
};

// Between b and c, knots at the square roots of the distances.
Vec3 catmull_rom(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double share) {
  const double tb = std::sqrt((b - a).norm()), tc = tb + std::sqrt((c - b).norm()), td = tc + std::sqrt((d - c).norm()),
               t = tb + share * (tc - tb);
  const auto mix = [t](const Vec3& p, double from, const Vec3& q, double to) {
    return Vec3((to - t) / (to - from) * p + (t - from) / (to - from) * q);
  };
  const Vec3 ab = mix(a, 0, b, tb), bc = mix(b, tb, c, tc), cd = mix(c, tc, d, td);
  return mix(mix(ab, 0, bc, tc), tb, mix(bc, tb, cd, td), tc);
}

Vec3s smooth_path(const std::vector<Vec3>& path, bool closed, double piece_m) {
  const std::size_t n = path.size(), spans = closed ? n : n - 1;
  const auto point = [&](std::ptrdiff_t k) -> Vec3 {
    const auto size = static_cast<std::ptrdiff_t>(n);
    if (closed) return path[static_cast<std::size_t>((k + size) % size)];
    if (k < 0) return 2 * path[0] - path[1];
    if (k >= size) return 2 * path[n - 1] - path[n - 2];
    return path[static_cast<std::size_t>(k)];
  };
  Vec3s x;
  for (std::size_t span = 0; span < spans; ++span) {
    const auto k = static_cast<std::ptrdiff_t>(span);
    const Vec3 a = point(k - 1), b = point(k), c = point(k + 1), d = point(k + 2);
    const int pieces = std::max(1, static_cast<int>(std::ceil((c - b).norm() / piece_m)));
    for (int i = 0; i < pieces; ++i) x.push_back(catmull_rom(a, b, c, d, static_cast<double>(i) / pieces));
  }
  x.push_back(point(static_cast<std::ptrdiff_t>(spans)));
  return x;
}

Vec3 tangent(const Vec3s& x, std::size_t k, bool closed) {
  const std::size_t last = x.size() - 1;
  const Vec3& before = k > 0 ? x[k - 1] : closed ? x[last - 1] : x[0];
  const Vec3& after = k < last ? x[k + 1] : closed ? x[1] : x[last];
  return (after - before).normalized();
}

Curve curve_of(const SceneRibbon& ribbon) {
  Curve curve;
  curve.x = smooth_path(ribbon.path_m, ribbon.closed, 0.25 * ribbon.edge_m);
  const std::size_t count = curve.x.size();
  curve.s.assign(1, 0);
  for (std::size_t k = 1; k < count; ++k) curve.s.push_back(curve.s.back() + (curve.x[k] - curve.x[k - 1]).norm());

  Vec3 t = tangent(curve.x, 0, ribbon.closed);
  Vec3 across = ribbon.across - ribbon.across.dot(t) * t;
  if (!(across.norm() > 1e-6 * ribbon.across.norm())) across = t.unitOrthogonal();
  across.normalize();
  curve.across.assign(1, across);
  for (std::size_t k = 1; k < count; ++k) {  // double reflection [Wang 2008, table I]
    const Vec3 v1 = curve.x[k] - curve.x[k - 1];
    const double c1 = v1.squaredNorm();
    const Vec3 across_left = across - 2 / c1 * v1.dot(across) * v1, t_left = t - 2 / c1 * v1.dot(t) * v1;
    t = tangent(curve.x, k, ribbon.closed);
    const Vec3 v2 = t - t_left;
    const double c2 = v2.squaredNorm();
    across = c2 > 0 ? Vec3(across_left - 2 / c2 * v2.dot(across_left) * v2) : across_left;
    curve.across.push_back(across);
  }
  if (!ribbon.closed) return curve;
  const Vec3 end = curve.across.back(), start = curve.across.front();
  const double gap = ieee_atan2(t.dot(end.cross(start)), end.dot(start));
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = gap * curve.s[k] / curve.s.back();
    const Vec3 axis = tangent(curve.x, k, true), a = curve.across[k];
    curve.across[k] = ieee_cos(angle) * a + ieee_sin(angle) * axis.cross(a);
  }
  return curve;
}

// Where the middle line turns back, or has a radius of curvature in the ribbon's plane below half its width, the ribbon would
// overlap itself.  `!(... > 0)` also holds for NaN.
void check_bends(const Curve& curve, double width_m) {
  const auto fail = [&](std::size_t k, const char* expected, const char* got) {
    const Vec3& x = curve.x[k];
    throw InputError("", "path_m", expected, fmt::sprintf("%s near (%.3g, %.3g, %.3g) m", got, x.x(), x.y(), x.z()));
  };
  for (std::size_t k = 1; k < curve.x.size(); ++k) {
    const Vec3 piece = curve.x[k] - curve.x[k - 1];
    if (k > 1 && !(piece.dot(curve.x[k - 1] - curve.x[k - 2]) > 0))
      fail(k - 1, "a line that goes on within a quarter of edge_m", "one that turns back");
    for (const double side : {-0.5 * width_m, 0.5 * width_m})
      if (!((piece + side * (curve.across[k] - curve.across[k - 1])).dot(piece) > 0))
        fail(k - 1, "bends wider than half of width_m", "a ribbon that folds onto itself");
  }
}

}  // namespace

void settle(const Json& value, SceneRibbon& ribbon) {
  const Json& path = value.at("path_m");
  for (std::size_t k = 1; k < ribbon.path_m.size(); ++k)
    if (!((ribbon.path_m[k] - ribbon.path_m[k - 1]).norm() >= nearest_points_m))
      path.array()[k].fail(fmt::sprintf("another place than the point before, by at least %g m", nearest_points_m),
                           fmt::sprintf("%g m", (ribbon.path_m[k] - ribbon.path_m[k - 1]).norm()));
  const std::size_t least = ribbon.closed ? 3 : 2;
  if (ribbon.path_m.size() < least)
    path.fail("at least " + std::to_string(least) + " points [x, y, z]", std::to_string(ribbon.path_m.size()));
  if (ribbon.closed && !((ribbon.path_m.front() - ribbon.path_m.back()).norm() >= nearest_points_m))
    path.fail("the first point only once: a closed ribbon goes back to it", "the first point again at the end");
  if (ribbon.closed && length_of(ribbon.path_m, true) < 6 * ribbon.edge_m)
    value.fail("an edge_m of at most a sixth of the way round", path.describe());
  if (const double along = length_of(ribbon.path_m, ribbon.closed); along > longest_drawn_m)
    path.fail(fmt::sprintf("at most %g m along it", longest_drawn_m), fmt::sprintf("%.4g m", along));
  if (!(ribbon.across.squaredNorm() >= std::numeric_limits<double>::min()))
    value.at("across").fail("a direction", "zero");
}

ClothSize size_of(const SceneRibbon& ribbon) {
  const double length_m = length_of(ribbon.path_m, ribbon.closed);
  return {length_m * ribbon.width_m, 2 * length_m};
}

MeshedCloth load(const SceneRibbon& ribbon, const SceneCloth& whole, const TextSource&) {
  const Curve curve = curve_of(ribbon);
  check_length("path_m", "along it", curve.s.back());
  check_bends(curve, ribbon.width_m);
  const auto along = [](const Vec2& p) { return p; };
  return drawn({curve.s.back(), ribbon.width_m, ribbon.edge_m, ribbon.closed}, whole, along, [&](const Vec2& p) {
    return Vec3(curve.at_length(p.x(), curve.x) +
                (p.y() - 0.5 * ribbon.width_m) * curve.at_length(p.x(), curve.across));
  });
}

ClothCost cost(const SceneRibbon& ribbon, const SceneCloth& whole, const TextSource&) {
  return cost_of_drawing(SceneRibbon::key, size_of(ribbon), ribbon.edge_m, whole);
}

}  // namespace toile::internal
