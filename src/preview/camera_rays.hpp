// preview/camera_rays.hpp: the axes of a camera, in double for projection and in float for rays.
#pragma once
#include "preview/preview.hpp"
#include "preview/vec3f.hpp"

namespace toile::internal {

// Unit axes: right and up in the picture, forward into it; tangents of half the field of view.
struct CameraAxes {
  Vec3 eye, right, up, forward;
  double tan_x, tan_y;
};

// Throws InputError when eye and target coincide, something is not finite, or the field of view is not in (0, 180).
// For a vertical view -z is "up" in the picture, as for a viewer in front of the subject.
CameraAxes camera_axes(const Camera& camera, int width, int height);

// The axes for one picture in float, relative to `origin`.
struct CameraRays {
  Vec3f eye, right, up, forward;  // right and up scaled to half the picture at distance 1
  float step_x, step_y;           // one pixel, as a fraction of half the picture

  CameraRays(const CameraAxes& axes, int width, int height, const Vec3& origin);

  // Through the point (x, y) in pixels from the top left corner; unit length along `forward`, not normalised.
  Vec3f direction(float x, float y) const { return forward + (x * step_x - 1.0f) * right + (1.0f - y * step_y) * up; }
};

}  // namespace toile::internal
