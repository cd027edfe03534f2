// preview/light_rig.hpp: the light of a picture: a soft sun as key light and a sky with a gradient, turned with the camera.
//
// Radiances are relative: a white diffuse surface that faces the key light reflects about 1.
//
// Mind: the sun is not part of sky(): it is lit only by aiming rays at it (shadow rays), so nothing is counted twice.
#pragma once
#include "preview/vec3f.hpp"

namespace toile::internal {

class LightRig {
 public:
  // `camera_forward` in world axes; only its direction on the horizon matters.
  explicit LightRig(const Vec3f& camera_forward);

  // A direction towards the sun's disc, uniform over its solid angle.
  Vec3f sun_direction(const Vec2f& u) const;
  // Irradiance of the whole sun at right angles, divided by pi: times cosine and albedo it is reflected radiance.
  const Vec3f& sun() const { return sun_; }

  // Radiance from direction d (unit) that no surface blocks.
  Vec3f sky(const Vec3f& d) const;

  // The radiance of an unblocked horizontal ground over its albedo, from sun and from sky.
  const Vec3f& ground_from_sun() const { return ground_from_sun_; }
  const Vec3f& ground_from_sky() const { return ground_from_sky_; }
  // The sky's mean radiance: approximates the light after the last bounce.
  const Vec3f& ambient() const { return ambient_; }

 private:
  Vec3f key_, rim_;  // unit directions towards the lights
  Vec3f sun_, ground_from_sun_, ground_from_sky_, ambient_;
};

}  // namespace toile::internal
