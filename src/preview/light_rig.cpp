// preview/light_rig.cpp: places and colours of the lights.
#include "preview/light_rig.hpp"

#include "preview/low_discrepancy.hpp"

#include <cmath>

namespace toile::internal {
namespace {

constexpr float key_azimuth = 0.85f, key_elevation = 0.82f;  // rad, left of the camera and above the horizon
constexpr float rim_azimuth = -2.5f, rim_elevation = 0.55f;  // rad, behind the subject on the right
constexpr float sun_half_angle = 0.16f;                      // rad: a large softbox rather than the real sun's 0.005

const Vec3f sun_colour(1.00f, 0.945f, 0.875f);
const Vec3f zenith_colour(0.30f, 0.315f, 0.335f);
const Vec3f horizon_colour(0.17f, 0.17f, 0.175f);
const Vec3f key_glow(0.44f, 0.42f, 0.395f);
const Vec3f rim_glow(0.70f, 0.73f, 0.79f);

// Turned by `azimuth` to the left about the vertical axis, as seen by the camera, and raised.
Vec3f turned(const Vec3f& to_camera, float azimuth, float elevation) {
  const float c = std::cos(azimuth), s = std::sin(azimuth);
  const Vec3f flat(c * to_camera.x() - s * to_camera.z(), 0.0f, s * to_camera.x() + c * to_camera.z());
  return std::cos(elevation) * flat + std::sin(elevation) * Vec3f(0, 1, 0);
}

}  // namespace

LightRig::LightRig(const Vec3f& camera_forward) {
  Vec3f to_camera(-camera_forward.x(), 0.0f, -camera_forward.z());
  const float length = to_camera.norm();
  to_camera = length > 1e-4f ? Vec3f(to_camera / length) : Vec3f(0, 0, 1);
  key_ = turned(to_camera, key_azimuth, key_elevation);
  rim_ = turned(to_camera, rim_azimuth, rim_elevation);
  sun_ = sun_colour;
  ground_from_sun_ = sun_ * key_.y();

  // The sky's cosine-weighted and plain means over the upper hemisphere, on a fixed grid of directions.
  constexpr int rings = 32, spokes = 64;
  Vec3f weighted = Vec3f::Zero(), plain = Vec3f::Zero();
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < spokes; ++j) {
      const Vec2f u((static_cast<float>(i) + 0.5f) / rings, (static_cast<float>(j) + 0.5f) / spokes);
      weighted += sky(cosine_direction(Vec3f(0, 1, 0), u));
      const float y = u.x(), r = std::sqrt(1.0f - y * y), angle = 6.28318531f * u.y();
      plain += sky(Vec3f(r * std::cos(angle), y, r * std::sin(angle)));
    }
  }
  ground_from_sky_ = weighted / (rings * spokes);
  ambient_ = plain / (rings * spokes);
}

Vec3f LightRig::sun_direction(const Vec2f& u) const {
  const float height = 1.0f - u.x() * (1.0f - std::cos(sun_half_angle));
  const float radius = std::sqrt(std::max(0.0f, 1.0f - height * height));
  const float angle = 6.28318531f * u.y();
  return along_normal(key_, radius * std::cos(angle), radius * std::sin(angle), height);
}

Vec3f LightRig::sky(const Vec3f& d) const {
  const float up = std::max(d.y(), 0.0f);
  Vec3f light = mix(horizon_colour, zenith_colour, up * (2.0f - up));
  // Lobes ((1 + cos) / 2)^n: wide soft boxes around the key and the rim light.
  const float toward_key = 0.5f + 0.5f * d.dot(key_), toward_rim = 0.5f + 0.5f * d.dot(rim_);
  const float key2 = toward_key * toward_key, rim2 = toward_rim * toward_rim;
  const float key4 = key2 * key2, rim4 = rim2 * rim2;
  light += key4 * key4 * key_glow + rim4 * rim4 * rim4 * rim_glow;
  return light;
}

}  // namespace toile::internal
