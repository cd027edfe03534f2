// preview/path_tracer.hpp: path tracing of the pixels.                             [Kajiya 1986]
//
// Surfaces are diffuse: L = albedo * illumination, with
//   illumination = sun * cos * visible + (mean of incoming radiance over cosine-distributed directions),
// the sun by a shadow ray towards a point of its disc, the rest by one bounced ray per path, up to three surfaces.
// A glossy cloth, where it is seen directly, adds what comes from directions around the mirrored view.
//
// The ground is not an object but a shadow on the background: background * (incident light / incident light without the
// scene).  So it has no edge, no horizon and no noise where it is not shaded.
//
// Mind: albedo and illumination are kept apart in the result, so that smoothing the light leaves the grid of the cloth sharp.
#pragma once
#include "preview/camera_rays.hpp"
#include "preview/light_rig.hpp"
#include "preview/ray_scene.hpp"
#include "preview/vec3f.hpp"

namespace toile::internal {

// The sums of a pixel's samples.  All but `radiance` are of the pixel's larger layer alone, the surfaces or the ground with the
// background, so that an outline neither blurs nor keeps its noise.
struct PixelLight {
  Vec3f radiance = Vec3f::Zero();  // mean of all samples, linear, before tone mapping
  Vec3f albedo =
      Vec3f::Zero();  // mean albedo of the layer times its share of the samples; the background's colour if open
  Vec3f illumination = Vec3f::Zero();  // mean of radiance / albedo over the layer's samples
  Vec3f normal = Vec3f::Zero();        // means over the layer's samples
  Vec3f position = Vec3f::Zero();
  float variance = 0;  // of the mean illumination's luminance
};

class PathTracer {
 public:
  // References are kept.  `ground_y` and the subject's `centre` and `radius` (m) are in the ray scene's coordinates.
  PathTracer(const RayScene& scene, const LightRig& light, const CameraRays& camera, const RenderOptions& options,
             float ground_y, const Vec3f& centre, float radius);

  PixelLight trace(int x, int y) const;

 private:
  struct Surface;
  Surface surface_at(const RayHit& hit, const Vec3f& origin, const Vec3f& direction) const;
  Vec3f albedo_of(const Surface& surface, const Vec3f& direction, const Vec3f& step_x, const Vec3f& step_y) const;
  Vec3f sewn_colour(const Surface& surface, const Vec2& at, const Vec2f& extent) const;
  template <class Sampler>
  Vec3f highlight(const Surface& surface, const Vec3f& direction, Sampler& sampler) const;
  Vec3f background(int x, int y) const;
  // The weight of the ground's shadow at a point, 0 far from the subject.
  float shadow_strength(const Vec3f& point) const;
  bool ground_hit(const Vec3f& origin, const Vec3f& direction, float& distance) const;

  template <class Sampler>
  Vec3f illumination(const Surface& surface, Sampler& sampler, int bounces) const;
  template <class Sampler>
  Vec3f ground_light(const Vec3f& point, float strength, Sampler& sampler) const;
  template <class Sampler>
  Vec3f incoming(const Vec3f& origin, const Vec3f& direction, Sampler& sampler, int bounces, bool& blocked) const;

  const RayScene& scene_;
  const LightRig& light_;
  const CameraRays& camera_;
  RenderOptions options_;
  float ground_y_, radius_, offset_, grid_mean_;
  Vec3f centre_;
};

}  // namespace toile::internal
