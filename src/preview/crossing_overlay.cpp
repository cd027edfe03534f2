// preview/crossing_overlay.cpp: anti-aliased thick lines with a bright core.
//
// Mind: a tube is at least a few pixels thick at any distance: one crossing on a whole garment must be seen.
#include "preview/crossing_overlay.hpp"

#include "preview/camera_rays.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double radius_m = 0.0012, smallest_radius_px = 1.6;
constexpr double halo_px = 1.3;  // a dark red rim sets the tube off from light and from red cloth
constexpr double nearest_m = 1e-3;

struct ScreenPoint {
  double x, y, radius;  // px
};

ScreenPoint on_screen(const CameraAxes& axes, int width, int height, const Vec3& p) {
  const double depth = p.dot(axes.forward);
  const double scale = 0.5 * height / (depth * axes.tan_y);
  return {0.5 * width + scale * p.dot(axes.right), 0.5 * height - scale * p.dot(axes.up),
          std::max(radius_m * scale, smallest_radius_px)};
}

void blend(std::uint8_t* rgb, const std::array<double, 3>& colour, double share) {
  for (std::size_t k = 0; k < 3; ++k) {
    rgb[k] = static_cast<std::uint8_t>(std::lround(rgb[k] + share * (colour[k] - rgb[k])));
  }
}

void draw_tube(Image& image, const ScreenPoint& a, const ScreenPoint& b) {
  const double reach = std::max(a.radius, b.radius) + halo_px + 1;
  const auto clamped = [](double v, int limit) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(limit)));
  };
  const int x0 = clamped(std::floor(std::min(a.x, b.x) - reach), image.width);
  const int x1 = clamped(std::ceil(std::max(a.x, b.x) + reach), image.width);
  const int y0 = clamped(std::floor(std::min(a.y, b.y) - reach), image.height);
  const int y1 = clamped(std::ceil(std::max(a.y, b.y) + reach), image.height);
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
      const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
      const double radius = a.radius + t * (b.radius - a.radius);
      const double distance = std::hypot(px - t * dx, py - t * dy);
      const double halo = std::clamp(radius + halo_px - distance + 0.5, 0.0, 1.0);
      if (halo <= 0) continue;
      std::uint8_t* rgb = &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                          static_cast<std::size_t>(x))];
      blend(rgb, {110, 0, 8}, 0.6 * halo);
      const double core = std::clamp(1.0 - distance / radius, 0.0, 1.0);
      blend(rgb, {255, 30 + 90 * core, 24 + 60 * core}, std::clamp(radius - distance + 0.5, 0.0, 1.0));
    }
  }
}

}  // namespace

void draw_crossings(Image& image, const Camera& camera, std::span<const std::array<Vec3, 2>> segments) {
  if (segments.empty()) return;
  const CameraAxes axes = camera_axes(camera, image.width, image.height);
  for (const std::array<Vec3, 2>& segment : segments) {
    Vec3 a = segment[0] - axes.eye, b = segment[1] - axes.eye;
    if (!a.allFinite() || !b.allFinite()) continue;
    double depth_a = a.dot(axes.forward), depth_b = b.dot(axes.forward);
    if (depth_a < depth_b) {
      std::swap(a, b);
      std::swap(depth_a, depth_b);
    }
    if (depth_a < nearest_m) continue;
    if (depth_b < nearest_m) b += (a - b) * ((nearest_m - depth_b) / (depth_a - depth_b));
    draw_tube(image, on_screen(axes, image.width, image.height, a), on_screen(axes, image.width, image.height, b));
  }
}

}  // namespace toile::internal
