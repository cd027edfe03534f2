// preview/vec3f.hpp: single-precision vectors and colours of the path tracer.
//
// Pictures need no more than float; the scene is moved so that its centre is the origin before it is rounded.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>

namespace toile::internal {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;

// Rec. 709 weights, linear RGB.
inline float luminance(const Vec3f& c) { return 0.2126f * c.x() + 0.7152f * c.y() + 0.0722f * c.z(); }

inline Vec3f mix(const Vec3f& a, const Vec3f& b, float t) { return a + t * (b - a); }

inline float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

}  // namespace toile::internal
