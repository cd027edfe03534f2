// preview/path_tracer.cpp: one pixel's paths.
#include "preview/path_tracer.hpp"

#include "preview/low_discrepancy.hpp"
#include "preview/weave.hpp"

#include <cmath>

namespace toile::internal {
namespace {

constexpr int bounces_of_a_path = 2;   // surfaces after the first
constexpr float pixel_filter = 0.85f;  // half width of the tent, in pixels
constexpr float grid_filter = 0.75f;   // the grid's box filter, in pixels; the tent adds to it
constexpr float last_bounce = 0.6f;    // share of the sky that is assumed to reach the surface after the last
constexpr float least_albedo = 0.02f;  // by which a highlight is divided
constexpr float grazing_share = 0.3f;
// Of sewing as it is seen, m, and how much darker or less see-through it is.
constexpr float seam_width = 6e-4f, seam_depth = 0.5f;
constexpr double seam_seen_m = 0.003;
constexpr float stitch_inside = 2e-3f, stitch_width = 5e-4f, stitch_period = 4e-3f, stitch_length = 2.8e-3f,
                stitch_opacity = 0.8f, hem_line = 6e-4f, hem_seen = 2e-3f, hem_depth_outside = 0.15f,
                hem_depth_inside = 0.4f;
const Vec3f ground_albedo(0.55f, 0.55f, 0.55f);
const Vec3f background_top(0.60f, 0.62f, 0.64f);
const Vec3f background_bottom(0.92f, 0.91f, 0.89f);

// Sums over the samples of a pixel that met the same layer.
struct Layer {
  Vec3f albedo = Vec3f::Zero(), light = Vec3f::Zero(), normal = Vec3f::Zero(), position = Vec3f::Zero();
  float samples = 0;
  float mean = 0, squares = 0;  // of the light's luminance, and of its deviations, by Welford's updates

  void add(const Vec3f& sample_albedo, const Vec3f& sample_light, const Vec3f& sample_normal,
           const Vec3f& sample_position) {
    albedo += sample_albedo;
    light += sample_light;
    normal += sample_normal;
    position += sample_position;
    samples += 1;
    const float value = luminance(sample_light), change = value - mean;
    mean += change / samples;
    squares += change * (value - mean);
  }
};

// Tent distribution on [-1, 1] from a uniform number.
float tent(float u) { return u < 0.5f ? std::sqrt(2.0f * u) - 1.0f : 1.0f - std::sqrt(2.0f - 2.0f * u); }

}  // namespace

struct PathTracer::Surface {
  Vec3f position;  // on the triangle
  Vec3f origin;    // where rays leave: on the smooth surface that the vertex normals suggest, a little off the triangle
  Vec3f geometric, normal;  // unit, both on the side that the ray came from
  Vec3f albedo;             // without grid detail
  const RayMesh* mesh = nullptr;
  const ClothLook* look = nullptr;  // of cloth as in a studio
  bool right_side = true;
  std::size_t triangle = 0;
  float b1 = 0, b2 = 0;
};

PathTracer::PathTracer(const RayScene& scene, const LightRig& light, const CameraRays& camera,
                       const RenderOptions& options, float ground_y, const Vec3f& centre, float radius)
    : scene_(scene),
      light_(light),
      camera_(camera),
      options_(options),
      ground_y_(ground_y),
      radius_(std::max(radius, 1e-3f)),
      offset_(3e-5f * std::max(radius, 1e-3f)),
      grid_mean_(weave_mean(static_cast<float>(options.grid_m))),
      centre_(centre) {}

PathTracer::Surface PathTracer::surface_at(const RayHit& hit, const Vec3f& origin, const Vec3f& direction) const {
  Surface s;
  s.mesh = &scene_.mesh(hit.mesh);
  s.triangle = hit.triangle;
  s.b1 = hit.b1;
  s.b2 = hit.b2;
  const Triangle& t = s.mesh->triangles[hit.triangle];
  const auto i0 = static_cast<std::size_t>(t[0]), i1 = static_cast<std::size_t>(t[1]),
             i2 = static_cast<std::size_t>(t[2]);
  const float b0 = 1.0f - hit.b1 - hit.b2;
  const Vec3f &p0 = s.mesh->positions[i0], &p1 = s.mesh->positions[i1], &p2 = s.mesh->positions[i2];
  s.position = b0 * p0 + hit.b1 * p1 + hit.b2 * p2;

  const Vec3f normal = (p1 - p0).cross(p2 - p0);
  const float length = normal.norm();
  s.geometric = length > 0 ? Vec3f(normal / length) : Vec3f(-direction);
  const bool right_side = s.geometric.dot(direction) < 0;
  const float side = right_side ? 1.0f : -1.0f;
  s.geometric *= side;
  s.right_side = right_side;
  if (s.mesh->display) {
    s.look = s.mesh->look[static_cast<std::size_t>(s.mesh->display->source[s.triangle])];
    s.albedo = mean_colour(*s.look, right_side);
  } else {
    s.albedo = right_side ? s.mesh->right_side : s.mesh->wrong_side;
    if (!s.mesh->sides.empty()) s.albedo = s.mesh->sides[s.triangle][right_side ? 0 : 1];
    if (!s.mesh->uv.empty()) s.albedo *= grid_mean_;
  }

  const Vec3f n0 = side * s.mesh->normals[hit.triangle][0], n1 = side * s.mesh->normals[hit.triangle][1],
              n2 = side * s.mesh->normals[hit.triangle][2];
  s.normal = b0 * n0 + hit.b1 * n1 + hit.b2 * n2;
  const float smooth_length = s.normal.norm();
  s.normal = smooth_length > 1e-6f ? Vec3f(s.normal / smooth_length) : s.geometric;
  // A smooth normal that turns away from the viewer (at outlines) is bent back until it just faces it.
  const float facing = s.normal.dot(direction) / direction.norm();
  if (facing > -0.02f) s.normal = (s.normal - (facing + 0.02f) * direction / direction.norm()).normalized();
  if (s.normal.dot(s.geometric) < 0.05f) s.normal = s.geometric;

  // J. Hanika, Hacking the Shadow Terminator (Ray Tracing Gems II, ch. 4): rays leave from the point moved onto the tangent
  // planes of the corners, or coarse triangles would shade themselves in bands where the light grazes them.  Limited to a
  // share of the triangle, so that the origin cannot pass through another layer of cloth that lies close by.
  const auto lift = [&](const Vec3f& corner, const Vec3f& n) -> Vec3f {
    return std::max(0.0f, -(s.position - corner).dot(n)) * n;
  };
  Vec3f lifted = b0 * lift(p0, n0) + hit.b1 * lift(p1, n1) + hit.b2 * lift(p2, n2);
  const float limit = 0.08f * std::sqrt(length), height = lifted.norm();
  if (height > limit) lifted *= limit / height;
  s.origin = s.position + lifted + (offset_ + 2e-6f * (s.position - origin).norm()) * s.geometric;
  return s;
}

// Threads, seams, and the stitches of hems.
Vec3f PathTracer::sewn_colour(const Surface& s, const Vec2& at, const Vec2f& extent) const {
  const ClothLook& look = *s.look;
  const EdgeDistance edge = edge_distance(*s.mesh->display, s.mesh->display->source[s.triangle], at);
  // A hem is turned twice: it shows the right side inside, too.
  const bool turned = look.print && static_cast<float>(edge.open_m) < look.hem_m;
  Vec3f colour = thread_colour(look, s.right_side || turned, at, extent);
  const float blur = std::max(extent.x(), extent.y());
  if (edge.sewn_m < seam_seen_m)
    colour *= 1.0f - seam_depth * line_cover(static_cast<float>(edge.sewn_m), blur, seam_width);
  const float below_hem = static_cast<float>(edge.open_m) - look.hem_m;
  if (below_hem < hem_seen) {
    const float stitch =
        line_cover(below_hem + stitch_inside, blur, stitch_width) *
        band_cover(static_cast<float>(std::fmod(edge.along_m, 64 * static_cast<double>(stitch_period))), blur,
                   stitch_period, stitch_length);
    colour = mix(colour, look.stitch, stitch_opacity * stitch);
    // Where a hem ends is seen from inside; outside it shows through.
    colour *= 1.0f - (s.right_side ? hem_depth_outside : hem_depth_inside) * line_cover(below_hem, blur, hem_line);
  }
  return colour;
}

// The mirrored view blurred by the cloth's roughness: a sample of a cosine lobe around it.  Reflectance rises at grazing view as Schlick's does, to
// grazing_share: yarn is rough, and shadows itself there.
template <class Sampler>
Vec3f PathTracer::highlight(const Surface& s, const Vec3f& direction, Sampler& sampler) const {
  const Vec3f view = direction.normalized();
  const float facing = std::clamp(-view.dot(s.normal), 0.0f, 1.0f);
  const float grazing = std::pow(1.0f - facing, 5.0f);
  const float reflectance = s.look->gloss + (grazing_share - s.look->gloss) * grazing;
  const Vec3f mirrored = view + 2.0f * facing * s.normal;
  const float power = 2.0f / (s.look->roughness * s.look->roughness);
  const Vec2f u = sampler.next();
  const float height = std::pow(1.0f - u.x(), 1.0f / (power + 1.0f));
  const float radius = std::sqrt(std::max(0.0f, 1.0f - height * height)), angle = 6.28318531f * u.y();
  Vec3f sample = along_normal(mirrored.normalized(), radius * std::cos(angle), radius * std::sin(angle), height);
  const float out = sample.dot(s.geometric);
  if (out < 0.01f) sample = (sample + (0.02f - 2.0f * out) * s.geometric).normalized();
  bool blocked = false;
  Vec3f light = incoming(s.origin, sample, sampler, 0, blocked);
  // The sun's disc, which no sampled ray meets: its part of the lobe.
  const Vec3f to_sun = light_.sun_direction(sampler.next());
  const float toward = mirrored.normalized().dot(to_sun);
  if (toward > 0 && s.normal.dot(to_sun) > 0 && !scene_.occluded(s.origin, to_sun))
    light += 0.5f * (power + 1.0f) * std::pow(toward, power) * light_.sun();  // sun() is its irradiance over pi
  return reflectance * light;
}

Vec3f PathTracer::albedo_of(const Surface& s, const Vec3f& direction, const Vec3f& step_x, const Vec3f& step_y) const {
  if (!s.mesh->cloth) return s.albedo;
  Vec3f albedo = s.albedo;
  if (!s.mesh->uv.empty()) {
    const Triangle& t = s.mesh->triangles[s.triangle];
    const Vec3f& p0 = s.mesh->positions[static_cast<std::size_t>(t[0])];
    const Vec3f e1 = s.mesh->positions[static_cast<std::size_t>(t[1])] - p0;
    const Vec3f e2 = s.mesh->positions[static_cast<std::size_t>(t[2])] - p0;
    const std::array<Vec2, 3>& uv = s.mesh->uv[s.triangle];
    const Vec2f d1 = (uv[1] - uv[0]).cast<float>(), d2 = (uv[2] - uv[0]).cast<float>();
    const Vec2 at = uv[0] + (uv[1] - uv[0]) * static_cast<double>(s.b1) + (uv[2] - uv[0]) * static_cast<double>(s.b2);
    // A step in the triangle's plane, as weights of e1 and e2, then as a step of (u, v).
    const float a11 = e1.squaredNorm(), a12 = e1.dot(e2), a22 = e2.squaredNorm();
    const float determinant = a11 * a22 - a12 * a12;
    const auto uv_step = [&](const Vec3f& step) -> Vec2f {
      const float c1 = step.dot(e1), c2 = step.dot(e2);
      return ((c1 * a22 - c2 * a12) * d1 + (c2 * a11 - c1 * a12) * d2) / determinant;
    };
    if (determinant > 0) {
      const Vec2f across = uv_step(step_x), down = uv_step(step_y);
      // The box around the pixel's parallelogram in (u, v) would blur slanted views too much: its diagonal is enough.
      const Vec2f extent = grid_filter * (across.cwiseAbs2() + down.cwiseAbs2()).cwiseSqrt();
      if (s.look) {
        const Vec3f woven = sewn_colour(s, at, extent);
        if (woven.allFinite()) albedo = woven;
      } else {
        const float shade = weave_shade(static_cast<float>(at.x()), static_cast<float>(at.y()), extent.x(), extent.y(),
                                        static_cast<float>(options_.grid_m));
        if (std::isfinite(shade)) albedo *= shade / grid_mean_;
      }
    }
  }
  // Sheen: fibres that stand off the cloth catch light where it is seen edge-on.
  const float edge = 1.0f - std::min(1.0f, std::abs(s.normal.dot(direction)) / direction.norm());
  const float sheen = (s.look ? s.look->sheen : 0.30f) * edge * edge * edge;
  return albedo + sheen * (0.06f * Vec3f::Ones() + 0.94f * albedo);
}

bool PathTracer::ground_hit(const Vec3f& origin, const Vec3f& direction, float& distance) const {
  if (direction.y() >= 0 || origin.y() <= ground_y_) return false;
  distance = (ground_y_ - origin.y()) / direction.y();
  return true;
}

float PathTracer::shadow_strength(const Vec3f& point) const {
  const float away = std::hypot(point.x() - centre_.x(), point.z() - centre_.z()) / radius_;
  return 1.0f - smoothstep(1.2f, 2.6f, away);
}

Vec3f PathTracer::background(int x, int y) const {
  const float across = (2.0f * static_cast<float>(x) + 1.0f) / static_cast<float>(options_.width) - 1.0f;
  const float down = (static_cast<float>(y) + 0.5f) / static_cast<float>(options_.height);
  return mix(background_top, background_bottom, smoothstep(0.0f, 1.0f, down)) * (1.0f - 0.10f * across * across);
}

// The radiance that comes back along a bounced ray.
template <class Sampler>
Vec3f PathTracer::incoming(const Vec3f& origin, const Vec3f& direction, Sampler& sampler, int bounces,
                           bool& blocked) const {
  RayHit hit;
  float to_ground = 0;
  const bool ground = ground_hit(origin, direction, to_ground);
  blocked = scene_.nearest(origin, direction, hit) && !(ground && to_ground < hit.distance);
  if (blocked) {
    const Surface surface = surface_at(hit, origin, direction);
    if (bounces <= 0) return surface.albedo.cwiseProduct(last_bounce * light_.ambient());
    return surface.albedo.cwiseProduct(illumination(surface, sampler, bounces - 1));
  }
  if (!ground) return light_.sky(direction);
  // The floor as a white surface under the subject: its sun by a shadow ray, its sky unblocked but dimmer close by.
  const Vec3f point = origin + to_ground * direction;
  const Vec3f sky_part = 0.85f * light_.ground_from_sky();
  const Vec3f raised(point.x(), ground_y_ + offset_, point.z());
  if (scene_.occluded(raised, light_.sun_direction(sampler.next()))) return ground_albedo.cwiseProduct(sky_part);
  return ground_albedo.cwiseProduct(sky_part + light_.ground_from_sun());
}

template <class Sampler>
Vec3f PathTracer::illumination(const Surface& s, Sampler& sampler, int bounces) const {
  Vec3f sum = Vec3f::Zero();
  const Vec3f to_sun = light_.sun_direction(sampler.next());
  const float cosine = s.normal.dot(to_sun);
  if (cosine > 0 && s.origin.y() > ground_y_ && !scene_.occluded(s.origin, to_sun)) sum += cosine * light_.sun();

  Vec3f direction = cosine_direction(s.normal, sampler.next());
  // Around a smooth normal some directions point into the triangle: mirrored out of it, no light comes through the cloth.
  const float out = direction.dot(s.geometric);
  if (out < 0.01f) direction = (direction + (0.02f - 2.0f * out) * s.geometric).normalized();
  bool blocked = false;
  return sum + incoming(s.origin, direction, sampler, bounces, blocked);
}

// The light on the ground as a share of its light without the scene.  Only the difference is sampled, so an open ground
// is exactly 1.
template <class Sampler>
Vec3f PathTracer::ground_light(const Vec3f& point, float strength, Sampler& sampler) const {
  Vec3f change = Vec3f::Zero();
  if (scene_.occluded(point, light_.sun_direction(sampler.next()))) change -= light_.ground_from_sun();
  const Vec3f direction = cosine_direction(Vec3f(0, 1, 0), sampler.next());
  bool blocked = false;
  const Vec3f light = incoming(point, direction, sampler, 0, blocked);
  if (blocked) change += light - light_.sky(direction);
  return Vec3f::Ones() + strength * change.cwiseQuotient(light_.ground_from_sun() + light_.ground_from_sky());
}

PixelLight PathTracer::trace(int x, int y) const {
  PixelLight pixel;
  Layer open, covered;
  const Vec3f back = background(x, y);
  const auto seed = mix_bits(static_cast<std::uint32_t>(y) * 0x10001u + static_cast<std::uint32_t>(x) + 1u);
  const auto count = static_cast<std::uint32_t>(options_.samples);
  for (std::uint32_t i = 0; i < count; ++i) {
    PathSampler sampler(seed, i, count);
    const Vec2f u = sampler.next();
    const float px = static_cast<float>(x) + 0.5f + pixel_filter * tent(u.x());
    const float py = static_cast<float>(y) + 0.5f + pixel_filter * tent(u.y());
    const Vec3f direction = camera_.direction(px, py);

    RayHit hit;
    float to_ground = 0;
    const bool ground = ground_hit(camera_.eye, direction, to_ground);
    if (scene_.nearest(camera_.eye, direction, hit) && !(ground && to_ground < hit.distance)) {
      const Surface s = surface_at(hit, camera_.eye, direction);
      // Neighbouring pixels' rays meet the plane of the triangle a step apart.
      const auto plane_step = [&](const Vec3f& change) -> Vec3f {
        return hit.distance * (change - (s.geometric.dot(change) / s.geometric.dot(direction)) * direction);
      };
      const Vec3f albedo =
          albedo_of(s, direction, plane_step(camera_.step_x * camera_.right), plane_step(camera_.step_y * camera_.up));
      Vec3f light = illumination(s, sampler, bounces_of_a_path);
      if (s.look && s.look->gloss > 0)
        light += highlight(s, direction, sampler).cwiseQuotient(albedo.cwiseMax(least_albedo));
      pixel.radiance += albedo.cwiseProduct(light);
      covered.add(albedo, light, s.normal, s.position);
    } else {
      const Vec3f point = camera_.eye + (ground ? to_ground : 1e3f * radius_) * direction;
      const float strength = ground ? shadow_strength(point) : 0.0f;
      Vec3f light = Vec3f::Ones();
      if (strength > 0) light = ground_light(Vec3f(point.x(), ground_y_ + offset_, point.z()), strength, sampler);
      pixel.radiance += back.cwiseProduct(light);
      open.add(back, light, Vec3f(0, 1, 0), point);
    }
  }
  const float share = 1.0f / static_cast<float>(count);
  const Layer& layer = covered.samples >= open.samples ? covered : open;
  const float layer_share = 1.0f / layer.samples;
  pixel.radiance *= share;
  pixel.albedo = share * layer.albedo;
  pixel.illumination = layer_share * layer.light;
  pixel.normal = layer_share * layer.normal;
  pixel.position = layer_share * layer.position;
  // One sample says nothing about its spread: as noisy as it is bright.
  pixel.variance = layer.samples > 1 ? layer.squares * layer_share / (layer.samples - 1) : layer.mean * layer.mean;
  return pixel;
}

}  // namespace toile::internal
