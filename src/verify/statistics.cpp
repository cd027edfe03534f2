// verify/statistics.cpp: stretch, shear and speed; see the header.
#include "verify/statistics.hpp"

#include "core/elementary.hpp"
#include "core/error.hpp"
#include "verify/surface.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace toile::internal {

double nearest_rank(std::vector<double>& values, int percent) {
  if (values.empty()) return 0;
  // ceil(percent n / 100) in integers: 0.99 n in double may land beyond a whole number.
  const std::size_t rank = (static_cast<std::size_t>(percent) * values.size() + 99) / 100;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

StretchStatistics measure_stretch(const ClothMesh& mesh, std::span<const Vec3> x, std::span<const Vec2> b) {
  const std::size_t count = mesh.triangles.size();
  if (mesh.uv.size() != count)
    throw InputError("cloth", "uv", std::to_string(count) + " triangles", std::to_string(mesh.uv.size()));
  if (!b.empty() && b.size() != count)
    throw InputError("cloth", "b", std::to_string(count) + " triangles or none", std::to_string(b.size()));
  check_surface("cloth", mesh.triangles, x);

  StretchStatistics result;
  std::vector<double> all(count), judged, shear(count);
  std::vector<char> elastic(count, 0);
  std::vector<Vec3> ring_normal(count);  // of the plane of the more stretched thread and the cloth's normal
  judged.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    const auto& uv = mesh.uv[t];
    const Vec2 e1 = uv[1] - uv[0], e2 = uv[2] - uv[0];
    const double twice_area = e1.x() * e2.y() - e2.x() * e1.y();
    if (!std::isfinite(twice_area) || twice_area == 0)
      throw InputError("cloth", "triangle " + std::to_string(t), "an area in the pattern other than 0",
                       std::to_string(0.5 * twice_area) + " m2");
    const Vec2 rest = b.empty() ? Vec2(1, 1) : b[t];
    if (!(rest.minCoeff() > 0) || !rest.allFinite())
      throw InputError("cloth", "triangle " + std::to_string(t), "b_u, b_v > 0",
                       std::to_string(rest.x()) + ", " + std::to_string(rest.y()));

    const MaterialFrame frame = material_frame(uv);
    Vec3 w_u = Vec3::Zero(), w_v = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& corner = x[static_cast<std::size_t>(mesh.triangles[t][k])];
      w_u += frame.alpha[static_cast<int>(k)] * corner;
      w_v += frame.beta[static_cast<int>(k)] * corner;
    }
    all[t] = std::max(w_u.norm() / rest.x(), w_v.norm() / rest.y()) - 1;
    // The complement of the angle, from sine and cosine: accurate near 90 degrees, where acos of a quotient is not.
    shear[t] = ieee_atan2(std::abs(w_u.dot(w_v)), w_u.cross(w_v).norm()) * 180 / std::numbers::pi;

    const auto index = static_cast<Index>(t);
    if (result.worst_triangle < 0 || all[t] > result.max) result.max = all[t], result.worst_triangle = index;
    const Vec3& thread = w_u.norm() / rest.x() > w_v.norm() / rest.y() ? w_u : w_v;
    ring_normal[t] = thread.cross(w_u.cross(w_v)).normalized();
    if (rest != Vec2(1, 1)) {
      ++result.elastic_triangles;
      elastic[t] = 1;
      continue;
    }
    judged.push_back(all[t]);
    if (result.triangle_worst < 0 || all[t] > result.triangle_max)
      result.triangle_max = all[t], result.triangle_worst = index;
  }
  std::vector<double> gauge = gauge_stretch(mesh, all, elastic), judged_gauge;
  judged_gauge.reserve(judged.size());
  for (std::size_t t = 0; t < count; ++t) {
    if (elastic[t] != 0) continue;
    judged_gauge.push_back(gauge[t]);
    if (result.gauge_worst_triangle < 0 || gauge[t] > result.gauge_max)
      result.gauge_max = gauge[t], result.gauge_worst_triangle = static_cast<Index>(t);
  }
  result.gauge_p99 = nearest_rank(judged_gauge, 99);
  if (result.gauge_worst_triangle >= 0) {
    const auto worst = static_cast<std::size_t>(result.gauge_worst_triangle);
    for (const Index i : mesh.triangles[worst]) result.gauge_worst_m += x[static_cast<std::size_t>(i)] / 3;
    result.ring = cloth_ring(mesh, x, result.gauge_worst_triangle, ring_normal[worst]);
  }
  result.p50 = nearest_rank(all, 50);
  result.p99 = nearest_rank(all, 99);
  result.triangle_p99 = nearest_rank(judged, 99);
  result.shear_p50_deg = nearest_rank(shear, 50);
  result.shear_p99_deg = nearest_rank(shear, 99);
  result.shear_max_deg = nearest_rank(shear, 100);
  return result;
}

double speed_p99_mm_per_s(std::span<const Vec3> x_before, std::span<const Vec3> x, double fps) {
  if (x_before.size() != x.size())
    throw InputError("cloth", "vertices of the frame before", std::to_string(x.size()),
                     std::to_string(x_before.size()));
  std::vector<double> speed(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) speed[i] = 1000 * fps * (x[i] - x_before[i]).norm();
  return nearest_rank(speed, 99);
}

}  // namespace toile::internal
