// core/types.hpp: the types that every module uses.
//
// World: SI units, y up, right-handed.  `Vec3s` always means one entry per particle.
#pragma once
#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace toile::internal {

using Index = std::int32_t;  // a particle, triangle, edge ...; -1 where documented means "none"
// As an index of the standard library's containers.
constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;

using Vec2s = std::vector<Vec2>;
using Vec3s = std::vector<Vec3>;

using Triangle = std::array<Index, 3>;  // counter-clockwise seen from outside

// v / |v|; zero where |v| is.
inline Vec3 unit_or_zero(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

}  // namespace toile::internal
