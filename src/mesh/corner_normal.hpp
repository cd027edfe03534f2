// mesh/corner_normal.hpp: what a triangle adds to the normal of a vertex, so that it does not depend on how the surface is cut.
#pragma once
#include "core/elementary.hpp"
#include "core/types.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace toile::internal {

// Of the triangle's corner with sides a and b, counter-clockwise: its normal, as long as the corner's angle; zero without an area.
inline Vec3 corner_normal(const Vec3& a, const Vec3& b) {
  const Vec3 n = a.cross(b);
  const double area = std::sqrt(n.squaredNorm());
  return area > 0 ? Vec3(ieee_atan2(area, a.dot(b)) / area * n) : Vec3(0, 0, 0);
}

}  // namespace toile::internal
