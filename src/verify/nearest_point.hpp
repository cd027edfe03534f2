// verify/nearest_point.hpp: the point of a triangle nearest to p, and its distance.
//
// Above the triangle when p lies on the inner side of the three planes through its edges along the normal; else nearest
// to an edge.  A triangle without area is its edges.
//
// Easily got wrong: the weights of the obtuse triangle.  Clamping the weights of the foot of the perpendicular to 0..1
// does not give the nearest point; that is on the nearest edge.
#pragma once
#include "core/types.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace toile::internal {

// The parameter on ab, 0 at a and 1 at b.
inline double nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0 ? std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) : 0.0;
}

inline double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  return (p - a - nearest_on_segment(p, a, b) * (b - a)).squaredNorm();
}

inline bool lies_above_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return normal.dot((b - a).cross(p - a)) > 0 && normal.dot((c - b).cross(p - b)) > 0 &&
         normal.dot((a - c).cross(p - c)) > 0;
}

inline double squared_distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  if (lies_above_triangle(p, a, b, c, normal)) {
    const double height = normal.dot(p - a);
    return height * height / normal.squaredNorm();
  }
  return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                   squared_distance_to_segment(p, c, a)});
}

// The nearest point is w_0 a + w_1 b + w_2 c; weights in 0..1, sum 1.
inline Vec3 nearest_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  if (lies_above_triangle(p, a, b, c, normal)) {
    const double area2 = normal.squaredNorm();
    const double w1 = normal.dot((a - c).cross(p - c)) / area2, w2 = normal.dot((b - a).cross(p - a)) / area2;
    return {1 - w1 - w2, w1, w2};
  }
  const double to_ab = squared_distance_to_segment(p, a, b), to_bc = squared_distance_to_segment(p, b, c),
               to_ca = squared_distance_to_segment(p, c, a);
  if (to_ab <= to_bc && to_ab <= to_ca) {
    const double s = nearest_on_segment(p, a, b);
    return {1 - s, s, 0};
  }
  if (to_bc <= to_ca) {
    const double s = nearest_on_segment(p, b, c);
    return {0, 1 - s, s};
  }
  const double s = nearest_on_segment(p, c, a);
  return {s, 0, 1 - s};
}

}  // namespace toile::internal
