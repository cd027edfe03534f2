// preview/weave.cpp: box-filtered grid lines.
#include "preview/weave.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr float line_share = 0.075f, line_depth = 0.34f;  // width as a share of the grid, and how much darker it is
constexpr float bold_share = 0.13f, bold_depth = 0.42f;   // the same for every fifth line, on top of the plain line
constexpr float bold_every = 5.0f;

}  // namespace

float band_cover(float x, float extent, float period, float band) {
  const float share = band / period;
  // The length of bands in [0, t], with t and the result in periods, for bands that begin at whole t.
  const auto covered = [&](float t) {
    const float whole = std::floor(t);
    return whole * share + std::min(t - whole, share);
  };
  const float t = x / period + 0.5f * share;
  const float half = std::max(0.5f * extent / period, 1e-4f);
  return std::clamp((covered(t + half) - covered(t - half)) / (2.0f * half), 0.0f, 1.0f);
}

float weave_shade(float u, float v, float extent_u, float extent_v, float grid_m) {
  if (!(grid_m > 0)) return 1.0f;
  const auto along = [&](float x, float extent) {
    return (1.0f - line_depth * band_cover(x, extent, grid_m, line_share * grid_m)) *
           (1.0f - bold_depth * band_cover(x, extent, bold_every * grid_m, bold_share * grid_m));
  };
  return along(u, extent_u) * along(v, extent_v);
}

float weave_mean(float grid_m) {
  if (!(grid_m > 0)) return 1.0f;
  const float along = (1.0f - line_depth * line_share) * (1.0f - bold_depth * bold_share / bold_every);
  return along * along;
}

}  // namespace toile::internal
