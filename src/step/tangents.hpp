// step/tangents.hpp: two directions along a surface, for friction.
#pragma once
#include "core/types.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace toile::internal {

// Two unit vectors across n, chosen without a decision that could flip between machines.
inline std::array<Vec3, 2> tangents(const Vec3& n) {
  Eigen::Index smallest = 0;
  if (std::abs(n.y()) < std::abs(n[smallest])) smallest = 1;
  if (std::abs(n.z()) < std::abs(n[smallest])) smallest = 2;
  const Vec3 t = n.cross(Vec3::Unit(smallest)).normalized();
  return {t, n.cross(t)};
}

}  // namespace toile::internal
