// tests/support/bodies.hpp: small closed bodies for tests.
#pragma once
#include "contact/body_surface.hpp"
#include "support/box.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <map>

namespace toile::internal::test {

// A box with the given half sizes, turned by `angle_deg` about z, its top face through the origin's height before turning.
inline BodySurface tilted_slab(double half_width_m, double thickness_m, double angle_deg) {
  const Eigen::AngleAxisd turn(angle_deg * 3.14159265358979323846 / 180, Vec3::UnitZ());
  std::vector<Vec3> x;
  for (const double y : {-thickness_m, 0.0}) {
    for (const double z : {-half_width_m, half_width_m}) {
      for (const double u : {-half_width_m, half_width_m}) x.push_back(turn * Vec3(u, y, z));
    }
  }
  return BodySurface(std::move(x), {box_triangles.begin(), box_triangles.end()});
}

// An octahedron subdivided `levels` times onto a sphere.
inline BodySurface sphere(const Vec3& centre, double radius_m, int levels) {
  std::vector<Vec3> x = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Triangle> triangles = {{2, 4, 0}, {2, 0, 5}, {2, 5, 1}, {2, 1, 4},
                                     {3, 0, 4}, {3, 5, 0}, {3, 1, 5}, {3, 4, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middle;
    const auto between = [&](Index a, Index b) {
      const auto [found, added] = middle.try_emplace(std::minmax(a, b), static_cast<Index>(x.size()));
      if (added) x.push_back((x[static_cast<std::size_t>(a)] + x[static_cast<std::size_t>(b)]).normalized());
      return found->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : triangles) {
      const Index a = between(t[0], t[1]), b = between(t[1], t[2]), c = between(t[2], t[0]);
      finer.insert(finer.end(), {Triangle{t[0], a, c}, Triangle{t[1], b, a}, Triangle{t[2], c, b}, Triangle{a, b, c}});
    }
    triangles = std::move(finer);
  }
  for (Vec3& p : x) p = centre + radius_m * p;
  return BodySurface(std::move(x), triangles);
}

}  // namespace toile::internal::test
