#include "dress/contour_push.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr double push_share = 0.6;    // of the mean edge
constexpr double least_sweep = 1e-3;  // of the edge: the least cost of a sweep that hardly moves the contour
constexpr double least_sine = 0.1;

std::vector<double> particle_areas(std::span<const Triangle> triangles, std::span<const Vec3> x) {
  std::vector<double> area(x.size(), 0);
  for (const Triangle& t : triangles) {
    const double third = (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]).norm() / 6;
    for (const Index i : t) area[at(i)] += third;
  }
  return area;
}

}  // namespace

ContourPush::ContourPush(const Topology& topology, std::span<const Triangle> all, std::span<const Vec3> x)
    : topology_(&topology), all_(all), regions_(topology, x.size(), particle_areas(all, x)) {}

double ContourPush::operator()(const IntersectionContour& contour, std::span<const SurfaceCrossing> crossings,
                               std::span<const Vec3> x, Way way, double edge_m, double largest_part,
                               std::vector<char>& marked, const Pull& pull) {
  struct Choice {
    CutRegion region;
    Sweep sweep;
    double cost = std::numeric_limits<double>::infinity();
  };
  std::array<Choice, 2> choices;
  const double push_m = push_share * edge_m;
  const double length = contour_length(contour, crossings, x);
  for (int side = 0; side < 2; ++side) {
    Choice& choice = choices[static_cast<std::size_t>(side)];
    choice.region = regions_.cut_off(contour, crossings, side);
    const CutRegion& region = choice.region;
    if (!region.separates || region.particles.empty()) continue;
    if (region.area_m2 > largest_part * (region.area_m2 + region.rest_m2)) continue;
    choice.sweep = sweep(contour, all_, *topology_, crossings, x, side, region.particles);
    choice.cost = region.area_m2 / std::max(choice.sweep.coherence * length, least_sweep * edge_m);
  }
  std::size_t best = choices[1].cost < choices[0].cost ? 1 : 0;
  if (way == Way::other_side && std::isfinite(choices[1 - best].cost)) best = 1 - best;
  const bool sweeps = std::isfinite(choices[best].cost);
  if (sweeps) {
    for (const Index i : choices[best].region.particles) marked[at(i)] = 1;
    for (const ContourPull& p : choices[best].sweep.pulls) pull(p, push_m / 2 * p.vector);
    if (way != Way::shorter_too) return choices[best].region.area_m2;
  }
  const double most_m = way == Way::gently ? std::min(push_m, length / 4) : push_m;
  for (const ContourPull& p : length_gradient(contour, all_, crossings, x, least_sine))
    pull(p, -most_m / std::max(1.0, p.vector.norm()) * p.vector);
  return sweeps ? choices[best].region.area_m2 : length * edge_m;
}

LinearSpring spring_along(const ContourPull& point, const Vec3& move_m) {
  LinearSpring spring;
  for (std::size_t k = 0; k < 3; ++k) {
    spring.particle[k] = point.particle[k];
    spring.weight[k] = point.weight[k];
  }
  spring.direction = move_m / move_m.norm();
  return spring;
}

void mark_particles(const SurfaceCrossing& crossing, std::span<const Triangle> triangles, std::vector<char>& marked) {
  for (const Index i : crossing.edge) marked[at(i)] = 1;
  for (const Index i : triangles[at(crossing.triangle)]) marked[at(i)] = 1;
}

}  // namespace toile::internal
