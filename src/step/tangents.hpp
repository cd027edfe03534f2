// step/tangents.hpp: two tangents of a surface, for friction.
#pragma once
#include "core/types.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace toile::internal {

// Two unit vectors orthogonal to n and to each other, chosen without a comparison that could differ between machines.
inline std::array<Vec3, 2> tangents(const Vec3& n) {
  Eigen::Index smallest = 0;
  if (std::abs(n.y()) < std::abs(n[smallest])) smallest = 1;
  if (std::abs(n.z()) < std::abs(n[smallest])) smallest = 2;
  const Vec3 t = n.cross(Vec3::Unit(smallest)).normalized();
  return {t, n.cross(t)};
}

}  // namespace toile::internal
