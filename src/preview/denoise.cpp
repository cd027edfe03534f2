// preview/denoise.cpp: the passes of the a-trous filter.
#include "preview/denoise.hpp"

#include "core/parallel.hpp"

#include <cmath>

namespace toile::internal {
namespace {

constexpr int passes = 4;
constexpr float light_tolerance = 3.5f;    // standard deviations of the light
constexpr float normal_sharpness = 24.0f;  // on 1 - cos of the angle between normals
constexpr float plane_tolerance = 2.0f;    // pixels off the tangent plane, per step

struct Light {
  Vec3f mean;
  float variance;
};

}  // namespace

std::vector<Vec3f> denoised_radiance(const std::vector<PixelLight>& pixels, int width, int height,
                                     float metre_per_pixel) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  std::vector<Light> now(w * h), next(w * h);
  // The variance of a few samples is itself noisy: averaged over the 3 x 3 neighbours.
  parallel_for(h, 8, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x) {
      float sum = 0, weight = 0;
      for (std::size_t j = y == 0 ? 0 : y - 1; j <= std::min(y + 1, h - 1); ++j) {
        for (std::size_t i = x == 0 ? 0 : x - 1; i <= std::min(x + 1, w - 1); ++i) {
          const float k = (i == x ? 2.0f : 1.0f) * (j == y ? 2.0f : 1.0f);
          sum += k * pixels[j * w + i].variance;
          weight += k;
        }
      }
      now[y * w + x] = {pixels[y * w + x].illumination, sum / weight};
    }
  });

  for (int pass = 0; pass < passes; ++pass) {
    const std::ptrdiff_t step = std::ptrdiff_t{1} << pass;
    const float plane_scale = 1.0f / (plane_tolerance * metre_per_pixel * static_cast<float>(step));
    parallel_for(h, 8, [&](std::size_t row) {
      const auto y = static_cast<std::ptrdiff_t>(row);
      for (std::ptrdiff_t x = 0; x < width; ++x) {
        const std::size_t p = row * w + static_cast<std::size_t>(x);
        const Light& centre = now[p];
        if (!(centre.variance > 1e-10f)) {
          next[p] = centre;
          continue;
        }
        const float light_scale = 1.0f / (light_tolerance * std::sqrt(centre.variance) + 1e-4f);
        const float centre_luminance = luminance(centre.mean);
        Vec3f sum = 4.0f * centre.mean;
        float weights = 4.0f, variance = 16.0f * centre.variance;
        for (std::ptrdiff_t dy = -1; dy <= 1; ++dy) {
          for (std::ptrdiff_t dx = -1; dx <= 1; ++dx) {
            const std::ptrdiff_t i = x + dx * step, j = y + dy * step;
            if ((dx == 0 && dy == 0) || i < 0 || j < 0 || i >= width || j >= height) continue;
            const std::size_t q = static_cast<std::size_t>(j) * w + static_cast<std::size_t>(i);
            const float bend = 1.0f - pixels[p].normal.dot(pixels[q].normal);
            const float off_plane = std::abs(pixels[p].normal.dot(pixels[q].position - pixels[p].position));
            const float contrast = std::abs(luminance(now[q].mean) - centre_luminance);
            const float exponent = normal_sharpness * bend + plane_scale * off_plane + light_scale * contrast;
            if (!(exponent < 12.0f)) continue;
            const float k = (dx == 0 ? 2.0f : 1.0f) * (dy == 0 ? 2.0f : 1.0f) * std::exp(-exponent);
            sum += k * now[q].mean;
            weights += k;
            variance += k * k * now[q].variance;
          }
        }
        next[p] = {sum / weights, variance / (weights * weights)};
      }
    });
    now.swap(next);
  }

  std::vector<Vec3f> radiance(w * h);
  parallel_for(w * h, 4096, [&](std::size_t p) {
    // Not albedo times light: the mean of a product is not the product of the means where a pixel holds the grid or an outline.
    radiance[p] = pixels[p].radiance + pixels[p].albedo.cwiseProduct(now[p].mean - pixels[p].illumination);
  });
  return radiance;
}

}  // namespace toile::internal
