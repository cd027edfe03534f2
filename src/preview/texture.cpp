// preview/texture.cpp: the pyramid of a picture's means.
#include "preview/texture.hpp"

#include "preview/srgb.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr int most_places = 8;  // along the longer side of an extent
constexpr float full = 65535.0f;

std::size_t texel_count(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Texture::Texture(int width, int height, std::span<const std::uint8_t> rgba) {
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = srgb_decoded(static_cast<float>(i) / 255.0f);
  Level first{width, height, std::vector<Texel>(texel_count(width) * texel_count(height))};
  for (std::size_t i = 0; i < first.texels.size(); ++i) {
    const float opacity = static_cast<float>(rgba[4 * i + 3]) / 255.0f;
    for (std::size_t k = 0; k < 3; ++k)
      first.texels[i][k] = static_cast<std::uint16_t>(std::lround(full * opacity * linear[rgba[4 * i + k]]));
    first.texels[i][3] = static_cast<std::uint16_t>(std::lround(full * opacity));
  }
  levels_.push_back(std::move(first));
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
  mean_ = smooth(levels_.back(), Vec2::Zero());
}

// Of n texels side by side to m <= n: the texel j is the mean over [j n/m, (j+1) n/m].
Texture::Level Texture::halved(const Level& from) {
  Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
  to.texels.reserve(texel_count(to.width) * texel_count(to.height));
  const auto share = [](int i, int j, int n, int m) {  // of texel i in j, in texels
    const double low = std::max<double>(i, static_cast<double>(j) * n / m),
                 high = std::min<double>(i + 1, (static_cast<double>(j) + 1) * n / m);
    return std::max(0.0, high - low);
  };
  const double area = static_cast<double>(from.width) / to.width * from.height / to.height;
  for (int y = 0; y < to.height; ++y) {
    const int top = y * from.height / to.height, bottom = ((y + 1) * from.height + to.height - 1) / to.height;
    for (int x = 0; x < to.width; ++x) {
      const int left = x * from.width / to.width, right = ((x + 1) * from.width + to.width - 1) / to.width;
      std::array<double, 4> sum{};
      for (int j = top; j < bottom; ++j) {
        for (int i = left; i < right; ++i) {
          const double weight = share(i, x, from.width, to.width) * share(j, y, from.height, to.height);
          const Texel& texel = from.texels[texel_count(j) * texel_count(from.width) + texel_count(i)];
          for (std::size_t k = 0; k < 4; ++k) sum[k] += weight * texel[k];
        }
      }
      Texel mean{};
      for (std::size_t k = 0; k < 4; ++k) mean[k] = static_cast<std::uint16_t>(std::lround(sum[k] / area));
      to.texels.push_back(mean);
    }
  }
  return to;
}

// Between the middles of four texels, round the edges of the picture.
Vec4f Texture::smooth(const Level& level, const Vec2& point) {
  const auto split = [](double repeats, int n, int& low, int& high) {
    const double x = (repeats - std::floor(repeats)) * n - 0.5, whole = std::floor(x);
    low = (static_cast<int>(whole) + n) % n;
    high = (low + 1) % n;
    return static_cast<float>(x - whole);
  };
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  const float fx = split(point.x(), level.width, x0, x1), fy = split(-point.y(), level.height, y0, y1);
  const auto texel = [&](int x, int y) -> Vec4f {
    const Texel& t = level.texels[texel_count(y) * texel_count(level.width) + texel_count(x)];
    return {static_cast<float>(t[0]), static_cast<float>(t[1]), static_cast<float>(t[2]), static_cast<float>(t[3])};
  };
  const Vec4f upper = texel(x0, y0) + fx * (texel(x1, y0) - texel(x0, y0));
  const Vec4f lower = texel(x0, y1) + fx * (texel(x1, y1) - texel(x0, y1));
  return (upper + fy * (lower - upper)) / full;
}

Vec4f Texture::blended(float size_log2, const Vec2& point) const {
  const float top = static_cast<float>(levels_.size() - 1), level = std::clamp(size_log2, 0.0f, top);
  const auto low = static_cast<std::size_t>(level);
  const float share = level - static_cast<float>(low);
  const Vec4f near = smooth(levels_[low], point);
  if (!(share > 0)) return near;
  return near + share * (smooth(levels_[low + 1], point) - near);
}

Vec4f Texture::at(const Vec2& point, const Vec2f& extent) const {
  if (!point.allFinite() || !extent.allFinite()) return mean_;
  const Vec2f texels(extent.x() * static_cast<float>(width()), extent.y() * static_cast<float>(height()));
  const bool wide = texels.x() > texels.y();
  const float longer = std::max({texels.x(), texels.y(), 1.0f}), shorter = std::max({texels.minCoeff(), 1.0f});
  const int places = static_cast<int>(std::clamp(std::ceil(longer / shorter), 1.0f, static_cast<float>(most_places)));
  const float size_log2 = std::log2(std::max(shorter, longer / static_cast<float>(places)));
  Vec4f sum = Vec4f::Zero();
  for (int k = 0; k < places; ++k) {
    const float along = (static_cast<float>(k) + 0.5f) / static_cast<float>(places) - 0.5f;
    const Vec2 step =
        wide ? Vec2(static_cast<double>(along * extent.x()), 0) : Vec2(0, static_cast<double>(along * extent.y()));
    sum += blended(size_log2, point + step);
  }
  return sum / static_cast<float>(places);
}

}  // namespace toile::internal
