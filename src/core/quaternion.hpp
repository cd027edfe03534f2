// core/quaternion.hpp: unit quaternions as rotations: w + x i + y j + z k turns by 2 acos(w) about (x, y, z).
//
// Made of + - * / sqrt and the sines of core/elementary.hpp, so that a pose has the same bits everywhere.  Mind: q and
// -q are the same rotation; only their blends differ.
//
// K. Shoemake, Animating Rotation with Quaternion Curves, SIGGRAPH 1985.
#pragma once
#include "core/elementary.hpp"
#include "core/types.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::internal {

struct Quaternion {
  double w = 1;
  Vec3 v = Vec3::Zero();

  // The product turns by `other` first.
  Quaternion operator*(const Quaternion& other) const {
    return {w * other.w - v.dot(other.v), w * other.v + other.w * v + v.cross(other.v)};
  }
  Vec3 operator*(const Vec3& p) const { return p + 2.0 * v.cross(v.cross(p) + w * p); }
  Quaternion inverse() const { return {w, -v}; }
  double dot(const Quaternion& other) const { return w * other.w + v.dot(other.v); }
  Quaternion normalised() const {
    const double n = std::sqrt(dot(*this));
    return {w / n, v / n};
  }
  // The rotation mirrored in the plane x = 0.
  Quaternion mirrored() const { return {w, Vec3(v.x(), -v.y(), -v.z())}; }
};

// About an axis of unit length, counter-clockwise seen from its tip, rad.
inline Quaternion rotation_about(const Vec3& axis, double angle) {
  return {ieee_cos(0.5 * angle), ieee_sin(0.5 * angle) * axis};
}

// The smallest rotation that takes the direction of `from` to that of `to`; they must not be opposite.
inline Quaternion rotation_between(const Vec3& from, const Vec3& to) {
  const double length = std::sqrt(from.dot(from) * to.dot(to));
  return Quaternion{length + from.dot(to), from.cross(to)}.normalised();
}

inline Mat3 rotation_matrix(const Quaternion& q) {
  const double x = q.v.x(), y = q.v.y(), z = q.v.z(), w = q.w;
  Mat3 m;
  m << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return m;
}

// Of a rotation matrix; by its largest component, so that no root is taken of what is nearly 0.
inline Quaternion quaternion_of(const Mat3& m) {
  const std::array<double, 4> four = {1 + m(0, 0) + m(1, 1) + m(2, 2), 1 + m(0, 0) - m(1, 1) - m(2, 2),
                                      1 - m(0, 0) + m(1, 1) - m(2, 2), 1 - m(0, 0) - m(1, 1) + m(2, 2)};
  const auto largest = std::max_element(four.begin(), four.end()) - four.begin();
  const double twice = std::sqrt(four[static_cast<std::size_t>(largest)]), part = 0.5 / twice;
  const double x = part * (m(2, 1) - m(1, 2)), y = part * (m(0, 2) - m(2, 0)), z = part * (m(1, 0) - m(0, 1));
  const double xy = part * (m(0, 1) + m(1, 0)), xz = part * (m(0, 2) + m(2, 0)), yz = part * (m(1, 2) + m(2, 1));
  Quaternion q;
  if (largest == 0) q = {0.5 * twice, Vec3(x, y, z)};
  if (largest == 1) q = {x, Vec3(0.5 * twice, xy, xz)};
  if (largest == 2) q = {y, Vec3(xy, 0.5 * twice, yz)};
  if (largest == 3) q = {z, Vec3(xz, yz, 0.5 * twice)};
  return q.normalised();
}

// The way from a to b at constant speed, the shorter of the two; u in [0, 1].                      [Shoemake 1985]
inline Quaternion slerp(const Quaternion& a, const Quaternion& b, double u) {
  const double sign = a.dot(b) < 0 ? -1 : 1;
  const Quaternion apart{b.w * sign - a.w, b.v * sign - a.v}, along{b.w * sign + a.w, b.v * sign + a.v};
  const double angle = 2 * ieee_atan2(std::sqrt(apart.dot(apart)), std::sqrt(along.dot(along)));
  double from = 1 - u, to = u;
  if (angle > 1e-4) {  // below, the chord is the arc to 1e-9 of it
    from = ieee_sin((1 - u) * angle) / ieee_sin(angle);
    to = ieee_sin(u * angle) / ieee_sin(angle);
  }
  to *= sign;
  return Quaternion{from * a.w + to * b.w, from * a.v + to * b.v}.normalised();
}

}  // namespace toile::internal
