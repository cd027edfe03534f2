// tests/preview/pictures.hpp: small scenes and questions about their pictures.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "preview/preview.hpp"

namespace toile::internal {

struct Sheet {
  std::vector<Triangle> triangles;
  std::vector<std::array<Vec2, 3>> uv;
  std::vector<Vec3> positions;
};

// An upright square of `side` m around `centre` whose right side faces +z; u = x and v = y from its corner, times `uv_scale`.
inline Sheet upright_square(const Vec3& centre, double side, double uv_scale = 1) {
  Sheet s;
  for (const double y : {-0.5, 0.5}) {
    for (const double x : {-0.5, 0.5}) s.positions.push_back(centre + side * Vec3(x, y, 0));
  }
  const auto uv = [&](Index i) { return Vec2(uv_scale * side * (i % 2), uv_scale * side * (i / 2)); };
  for (const Triangle& t : {Triangle{0, 1, 3}, Triangle{0, 3, 2}}) {
    s.triangles.push_back(t);
    s.uv.push_back({uv(t[0]), uv(t[1]), uv(t[2])});
  }
  return s;
}

// A closed sphere, outside out.
inline Sheet sphere(const Vec3& centre, double radius, int rings = 16) {
  Sheet s;
  const int spokes = 2 * rings;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < spokes; ++i) {
      const double polar = M_PI * j / rings, azimuth = 2 * M_PI * i / spokes;
      s.positions.push_back(centre + radius * Vec3(std::sin(polar) * std::sin(azimuth), -std::cos(polar),
                                                   std::sin(polar) * std::cos(azimuth)));
    }
  }
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < spokes; ++i) {
      const Index a = j * spokes + i, b = j * spokes + (i + 1) % spokes, c = b + spokes, d = a + spokes;
      s.triangles.push_back({a, b, c});
      s.triangles.push_back({a, c, d});
    }
  }
  return s;
}

inline PreviewCloth cloth_of(const Sheet& s, const Vec3& colour = {0.35, 0.45, 0.62}) {
  return {s.triangles, s.uv, s.positions, colour};
}

inline std::array<int, 3> pixel(const Image& image, int x, int y) {
  const auto at = 3 * static_cast<std::size_t>(y * image.width + x);
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

inline int brightness(const std::array<int, 3>& p) { return p[0] + p[1] + p[2]; }

// The centres of the stretches of row y in [x0, x1) that are `depth` darker than the row's median.
inline std::vector<double> dark_lines(const Image& image, int y, int x0, int x1, int depth) {
  std::vector<int> row;
  for (int x = x0; x < x1; ++x) row.push_back(brightness(pixel(image, x, y)));
  std::vector<int> sorted = row;
  std::sort(sorted.begin(), sorted.end());
  const int limit = sorted[sorted.size() / 2] - depth;
  std::vector<double> lines;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] >= limit) continue;
    const std::size_t begin = i;
    while (i < row.size() && row[i] < limit) ++i;
    lines.push_back(x0 + 0.5 * static_cast<double>(begin + i));
  }
  return lines;
}

}  // namespace toile::internal
