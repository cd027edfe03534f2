// preview/texture.hpp: a picture that repeats over the plane, averaged over what a pixel sees of it.                 [Williams 1983]
//
// Levels of half the size each hold means of the level before, weighted by area, so that every level has the picture's mean.  A lookup
// takes the two levels whose texels are about as large as the shorter side of the pixel's extent, and up to eight places along the longer one.
//
// Means are those of light: colours are decoded first, and weighted by their opacity.
#pragma once
#include "core/types.hpp"
#include "preview/vec3f.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace toile::internal {

using Vec4f = Eigen::Vector4f;

class Texture {
 public:
  // 8-bit sRGB with opacity, row by row from the top, 4 * width * height bytes; width and height at least 1.
  Texture(int width, int height, std::span<const std::uint8_t> rgba);

  // Linear colour times opacity, and opacity.  In repeats, x to the right and y up from the picture's lower left corner.
  Vec4f at(const Vec2& point, const Vec2f& extent) const;
  const Vec4f& mean() const { return mean_; }
  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }

 private:
  using Texel = std::array<std::uint16_t, 4>;  // linear, 65535 is 1
  struct Level {
    int width = 0, height = 0;
    std::vector<Texel> texels;  // from the top
  };
  static Level halved(const Level& from);
  static Vec4f smooth(const Level& level, const Vec2& point);
  Vec4f blended(float size_log2, const Vec2& point) const;

  std::vector<Level> levels_;
  Vec4f mean_ = Vec4f::Zero();
};

}  // namespace toile::internal
