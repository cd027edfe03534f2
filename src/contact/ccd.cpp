#include "contact/ccd.hpp"

#include "contact/distance.hpp"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

constexpr double advance_share = 0.9;  // of what the bound would allow: what is left stays well above rounding
constexpr int most_advances = 2000;    // a pair that has not been decided by then is an impact

// `l_m` bounds the change of the distance over the whole motion.
template <class Distance>
double first_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double l_m, double separation_m,
                    Distance&& distance) {
  double d = distance(x);
  const double room = d - separation_m;
  if (room <= 0) return 0;
  if (room > l_m) return no_impact;
  const double stop_m = std::min(0.1 * room, 0.2 * separation_m);
  double t = 0;
  std::array<Vec3, 4> moved;
  for (int i = 0; i < most_advances; ++i) {
    const double next = t + advance_share * (d - separation_m) / l_m;
    if (next > 1) return no_impact;
    for (std::size_t k = 0; k < 4; ++k) moved[k] = x[k] + next * u[k];
    d = distance(moved);
    t = next;
    if (d - separation_m < stop_m) return t;  // still farther apart than xi: a tenth of the room before is left
  }
  return t;
}

std::array<double, 4> relative_lengths(const std::array<Vec3, 4>& u) {
  const Vec3 mean = 0.25 * (u[0] + u[1] + u[2] + u[3]);
  return {(u[0] - mean).norm(), (u[1] - mean).norm(), (u[2] - mean).norm(), (u[3] - mean).norm()};
}

}  // namespace

double vertex_face_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double separation_m) {
  const std::array<double, 4> p = relative_lengths(u);
  return first_impact(x, u, p[0] + std::max({p[1], p[2], p[3]}), separation_m, [](const std::array<Vec3, 4>& at) {
    return std::sqrt(closest_vertex_triangle(at[0], at[1], at[2], at[3]).distance2);
  });
}

double edge_edge_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double separation_m) {
  const std::array<double, 4> p = relative_lengths(u);
  return first_impact(
      x, u, std::max(p[0], p[1]) + std::max(p[2], p[3]), separation_m,
      [](const std::array<Vec3, 4>& at) { return std::sqrt(closest_edge_edge(at[0], at[1], at[2], at[3]).distance2); });
}

}  // namespace toile
