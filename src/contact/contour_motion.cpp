#include "contact/contour_motion.hpp"

#include "contact/distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

Vec3 normal_of(const Triangle& t, std::span<const Vec3> x) {
  return unit_or_zero((x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]));
}

// The two points of a crossing: on its edge and on its triangle.
std::array<ContourPull, 2> points_of(const SurfaceCrossing& crossing, int edge_side, const Triangle& t,
                                     std::span<const Vec3> x) {
  std::array<ContourPull, 2> points;
  const Vec3 &q0 = x[at(crossing.edge[0])], &q1 = x[at(crossing.edge[1])], e = q1 - q0;
  const double length2 = e.squaredNorm();
  const double s = length2 > 0 ? std::clamp(e.dot(crossing.position - q0) / length2, 0.0, 1.0) : 0.5;
  points[0].particle = {crossing.edge[0], crossing.edge[1], -1};
  points[0].weight = {1 - s, s, 0};
  points[0].side = edge_side;
  const Vec3 b = closest_vertex_triangle(crossing.position, x[at(t[0])], x[at(t[1])], x[at(t[2])]).barycentric;
  points[1].particle = t;
  points[1].weight = {b[0], b[1], b[2]};
  points[1].side = 1 - edge_side;
  return points;
}

}  // namespace

std::vector<ContourPull> length_gradient(const IntersectionContour& contour, std::span<const Triangle> triangles,
                                         std::span<const SurfaceCrossing> crossings, std::span<const Vec3> x,
                                         double least_sine) {
  std::vector<ContourPull> pulls;
  const std::size_t count = contour.points.size();
  const auto position = [&](std::size_t k) -> const Vec3& {
    return crossings[at(contour.points[k].crossing)].position;
  };
  const auto end_particle = [&](std::size_t end, const Vec3& p, Vec3& tau) {
    const Index i = contour.end_particle[end];
    if (i < 0) return;
    const Vec3 t = unit_or_zero(p - x[at(i)]);
    tau += t;
    pulls.push_back({{i, -1, -1}, {1, 0, 0}, -t, 0});
  };
  for (std::size_t k = 0; k < count; ++k) {
    const SurfaceCrossing& crossing = crossings[at(contour.points[k].crossing)];
    const Vec3& p = crossing.position;
    Vec3 tau = Vec3::Zero();
    if (k > 0 || contour.closed) tau += unit_or_zero(p - position(k > 0 ? k - 1 : count - 1));
    if (k + 1 < count || contour.closed) tau += unit_or_zero(p - position(k + 1 < count ? k + 1 : 0));
    if (k == 0) end_particle(0, p, tau);
    if (k + 1 == count) end_particle(1, p, tau);

    const Triangle& t = triangles[at(crossing.triangle)];
    const Vec3 n = normal_of(t, x), e = unit_or_zero(x[at(crossing.edge[1])] - x[at(crossing.edge[0])]);
    const double ne = n.dot(e), sine = std::copysign(std::max(std::abs(ne), least_sine), ne);
    auto [on_edge, on_triangle] = points_of(crossing, contour.points[k].edge_side, t, x);
    on_triangle.vector = n * (e.dot(tau) / sine);
    on_edge.vector = tau - on_triangle.vector;
    pulls.push_back(on_edge);
    pulls.push_back(on_triangle);
  }
  return pulls;
}

Sweep sweep(const IntersectionContour& contour, std::span<const Triangle> triangles, const Topology& topology,
            std::span<const SurfaceCrossing> crossings, std::span<const Vec3> x, int side,
            std::span<const Index> region) {
  const std::size_t count = contour.points.size();
  const auto crossing_at = [&](std::size_t k) -> const SurfaceCrossing& {
    return crossings[at(contour.points[k].crossing)];
  };
  // The other surface's normal at every point.
  std::vector<Vec3> normal(count);
  double sigma = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const SurfaceCrossing& crossing = crossing_at(k);
    if (contour.points[k].edge_side == side) {
      normal[k] = normal_of(triangles[at(crossing.triangle)], x);
      for (const Index i : crossing.edge)
        if (std::binary_search(region.begin(), region.end(), i))
          sigma += normal[k].dot(unit_or_zero(x[at(i)] - crossing.position));
    } else {
      Vec3 sum = Vec3::Zero();
      const Index e = find_edge(topology, crossing.edge);
      for (const Index t : topology.edges[at(e)].triangle)
        if (t >= 0) sum += normal_of(triangles[at(t)], x);
      normal[k] = unit_or_zero(sum);
    }
  }
  const double sign = sigma < 0 ? -1 : 1;

  Sweep result;
  Vec3 sum = Vec3::Zero();
  double length = 0;
  for (std::size_t k = 0; k < count; ++k) {
    double share = 0;
    if (k > 0 || contour.closed)
      share += (crossing_at(k).position - crossing_at(k > 0 ? k - 1 : count - 1).position).norm() / 2;
    if (k + 1 < count || contour.closed)
      share += (crossing_at(k).position - crossing_at(k + 1 < count ? k + 1 : 0).position).norm() / 2;
    sum += share * normal[k];
    length += share;
    for (ContourPull point :
         points_of(crossing_at(k), contour.points[k].edge_side, triangles[at(crossing_at(k).triangle)], x)) {
      point.vector = (point.side == side ? -sign : sign) * normal[k];
      result.pulls.push_back(point);
    }
  }
  result.coherence = length > 0 ? sum.norm() / length : 1;
  return result;
}

}  // namespace toile::internal
