// body/quaternion.hpp: unit quaternions as rotations: w + x i + y j + z k turns by 2 acos(w) about (x, y, z).
//
// Made of + - * / sqrt and the sines of core/elementary.hpp, so that a pose has the same bits everywhere.  Mind: q and
// -q are the same rotation; only their blends differ.
#pragma once
#include "core/elementary.hpp"
#include "core/types.hpp"

#include <Eigen/Geometry>

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

}  // namespace toile::internal
