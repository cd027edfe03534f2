// preview/renderer.cpp: from a scene to an 8-bit picture: build, trace, smooth, tone map.
//
// Mind: pixels are independent of each other and of the division among threads; this must stay so.
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "preview/crossing_overlay.hpp"
#include "preview/denoise.hpp"
#include "preview/path_tracer.hpp"
#include "preview/srgb.hpp"

#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr int largest_side = 16384;
constexpr std::size_t tile = 16;  // pixels; neighbours in a tile meet the same parts of the tree

void check(const RenderOptions& options) {
  const auto in_range = [](const char* name, int value, int high) {
    if (value < 1 || value > high) {
      throw InputError("", std::string("preview: ") + name, "1.." + std::to_string(high), std::to_string(value));
    }
  };
  in_range("width", options.width, largest_side);
  in_range("height", options.height, largest_side);
  in_range("samples", options.samples, 65536);
  if (!(options.grid_m >= 0) || !std::isfinite(options.grid_m)) {
    throw InputError("", "preview: grid", "a width of 0 m or more", std::to_string(options.grid_m));
  }
}

// A straight line with a soft shoulder: x / (1 + x^p)^(1/p).  Colours of cloth keep their hue, highlights do not clip.
float shoulder(float x) {
  constexpr float p = 2.4f;
  return x > 0 ? x / std::pow(1.0f + std::pow(x, p), 1.0f / p) : 0.0f;
}

}  // namespace

// The two curves above in a table: three powers per channel and pixel cost more than the smoothing.
class ToneCurve {
 public:
  ToneCurve() {
    for (std::size_t i = 0; i <= steps; ++i) {
      const float root = static_cast<float>(i) * (range / steps);
      table_[i] = 255.0f * srgb_encoded(exposure * shoulder(root * root));
    }
  }
  std::uint8_t operator()(float x) const {
    if (!(x > 0)) return 0;
    const float at = std::min(std::sqrt(x), range) * (steps / range);
    const auto i = std::min(static_cast<std::size_t>(at), steps - 1);
    const float value = table_[i] + (at - static_cast<float>(i)) * (table_[i + 1] - table_[i]);
    return static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
  }

 private:
  static constexpr std::size_t steps = 2048;
  static constexpr float range = 3.0f;  // square root of the brightest distinguishable radiance
  static constexpr float exposure = 1.06f;
  std::array<float, steps + 1> table_{};
};

std::array<Vec3, 2> bounds(const PreviewScene& scene) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Vec3 low(inf, inf, inf), high(-inf, -inf, -inf);
  const auto add = [&](std::span<const Vec3> points) {
    for (const Vec3& p : points) {
      if (!p.allFinite()) continue;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  };
  for (const PreviewCloth& cloth : scene.cloths) add(cloth.positions);
  add(scene.body_positions);
  if (!(low.x() <= high.x())) return {Vec3::Zero(), Vec3::Zero()};
  return {low, high};
}

struct Renderer::State {
  RenderOptions options;
  RayScene scene;
  ToneCurve tone;
  std::vector<PixelLight> pixels;
};

Renderer::Renderer(const RenderOptions& options) {
  check(options);
  state_ = std::make_unique<State>();
  state_->options = options;
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(const PreviewScene& scene, const Camera& camera) {
  const RenderOptions& options = state_->options;
  if (!std::isfinite(scene.ground_y_m)) throw InputError("", "preview: ground", "a finite height", "not finite");
  const auto [low, high] = bounds(scene);
  const Vec3 centre = 0.5 * (low + high);
  const CameraAxes axes = camera_axes(camera, options.width, options.height);
  state_->scene.build(scene, centre, options.display_edge_m);

  const LightRig light(axes.forward.cast<float>());
  const CameraRays rays(axes, options.width, options.height, centre);
  // The radius of the subject, or its height above the ground: a flag on its mast keeps its shadow.
  const auto radius = static_cast<float>(std::max(0.5 * (high - low).norm(), centre.y() - scene.ground_y_m));
  const PathTracer tracer(state_->scene, light, rays, options, static_cast<float>(scene.ground_y_m - centre.y()),
                          Vec3f::Zero(), radius);

  const auto width = static_cast<std::size_t>(options.width), height = static_cast<std::size_t>(options.height);
  std::vector<PixelLight>& pixels = state_->pixels;
  pixels.resize(width * height);
  const std::size_t tiles_x = (width + tile - 1) / tile, tiles_y = (height + tile - 1) / tile;
  parallel_for(tiles_x * tiles_y, 1, [&](std::size_t t) {
    const std::size_t x0 = t % tiles_x * tile, y0 = t / tiles_x * tile;
    for (std::size_t y = y0; y < std::min(y0 + tile, height); ++y) {
      for (std::size_t x = x0; x < std::min(x0 + tile, width); ++x) {
        pixels[y * width + x] = tracer.trace(static_cast<int>(x), static_cast<int>(y));
      }
    }
  });

  std::vector<Vec3f> smoothed;
  if (options.denoise) {
    const double depth = std::max((centre - axes.eye).dot(axes.forward), 1e-3);
    smoothed = denoised_radiance(pixels, options.width, options.height,
                                 static_cast<float>(2 * depth * axes.tan_y / options.height));
  }
  Image image{options.width, options.height, std::vector<std::uint8_t>(3 * width * height)};
  parallel_for(width * height, 4096, [&](std::size_t p) {
    const Vec3f& radiance = options.denoise ? smoothed[p] : pixels[p].radiance;
    for (int k = 0; k < 3; ++k) image.rgb[3 * p + static_cast<std::size_t>(k)] = state_->tone(radiance[k]);
  });
  draw_crossings(image, camera, scene.red_segments);
  return image;
}

Image render(const PreviewScene& scene, const Camera& camera, const RenderOptions& options) {
  return Renderer(options).render(scene, camera);
}

Image turntable_sheet(const PreviewScene& scene, const RenderOptions& options, const std::string& title) {
  struct View {
    const char* name;
    double azimuth_deg;
  };
  constexpr std::array<View, 3> views{{{"FRONT", 0}, {"SIDE", 90}, {"BACK", 180}}};
  Renderer renderer(options);
  const auto [low, high] = bounds(scene);
  const double aspect = static_cast<double>(options.width) / options.height;
  std::vector<Image> images;
  std::vector<std::string> captions;
  for (const View& view : views) {
    images.push_back(renderer.render(scene, frame_subject(low, high, view.azimuth_deg, 8, aspect)));
    captions.push_back(title.empty() ? view.name : title + "  " + view.name);
  }
  return contact_sheet(images, captions, static_cast<int>(views.size()));
}

}  // namespace toile::internal
