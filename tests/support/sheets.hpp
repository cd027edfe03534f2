// tests/support/sheets.hpp: small cloths for tests, near-equilateral, and reproducible random numbers.
#pragma once
#include "mesh/cloth_mesh.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace toile::internal::test {

struct Sheet {
  ClothMesh mesh;
  Vec3s x;  // flat in the plane y = 0, u along x, v along -z, so that the right side faces up
};

// Makes a second panel of the triangles whose middle, in the drawing, passes is_second.
template <class IsSecond>
void add_panel(Sheet& sheet, const std::string& name, const IsSecond& is_second) {
  const auto second = static_cast<Index>(sheet.mesh.panel_names.size());
  sheet.mesh.panel_names.push_back(name);
  for (std::size_t t = 0; t < sheet.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = sheet.mesh.uv[t];
    if (is_second(Vec2((a + b + c) / 3))) sheet.mesh.panel[t] = second;
  }
}

// Rows of equilateral triangles; odd rows are shifted by half an edge and close with a half triangle at both ends.
inline Sheet equilateral_sheet(double width_m, double height_m, double edge_m) {
  const int columns = std::max(1, static_cast<int>(std::lround(width_m / edge_m)));
  const int rows = std::max(1, static_cast<int>(std::lround(height_m / (edge_m * std::sqrt(3.0) / 2))));
  Sheet sheet;
  Vec2s uv;
  std::vector<std::vector<Index>> row_points;
  for (int r = 0; r <= rows; ++r) {
    const double v = height_m * r / rows;
    std::vector<Index> points;
    const auto add = [&](double u) {
      points.push_back(static_cast<Index>(uv.size()));
      uv.emplace_back(u, v);
    };
    if (r % 2 == 0) {
      for (int c = 0; c <= columns; ++c) add(width_m * c / columns);
    } else {
      add(0);
      for (int c = 0; c < columns; ++c) add(width_m * (c + 0.5) / columns);
      add(width_m);
    }
    row_points.push_back(points);
  }
  for (int r = 0; r < rows; ++r) {
    // Walk both rows from left to right, always advancing the one whose next point is further left.
    const auto &low = row_points[static_cast<std::size_t>(r)], &high = row_points[static_cast<std::size_t>(r) + 1];
    std::size_t i = 0, j = 0;
    while (i + 1 < low.size() || j + 1 < high.size()) {
      const bool step_low =
          j + 1 >= high.size() || (i + 1 < low.size() && uv[static_cast<std::size_t>(low[i + 1])].x() <=
                                                             uv[static_cast<std::size_t>(high[j + 1])].x());
      const Index a = low[i], b = high[j], c = step_low ? low[i + 1] : high[j + 1];
      sheet.mesh.triangles.push_back({a, c, b});
      if (step_low)
        ++i;
      else
        ++j;
    }
  }
  sheet.mesh.particle_count = static_cast<Index>(uv.size());
  for (const Triangle& t : sheet.mesh.triangles) {
    sheet.mesh.uv.push_back(
        {uv[static_cast<std::size_t>(t[0])], uv[static_cast<std::size_t>(t[1])], uv[static_cast<std::size_t>(t[2])]});
    sheet.mesh.panel.push_back(0);
  }
  sheet.mesh.panel_names = {"sheet"};
  for (const Vec2& p : uv) sheet.x.emplace_back(p.x(), 0, -p.y());
  return sheet;
}

// Appends a sheet to a mesh, as its last panel.
inline void add_sheet(Sheet& all, const Sheet& one, const Vec3& aside_m, const std::string& name) {
  const Index first = all.mesh.particle_count, panel = static_cast<Index>(all.mesh.panel_names.size());
  for (const Vec3& p : one.x) all.x.push_back(p + aside_m);
  for (std::size_t t = 0; t < one.mesh.triangles.size(); ++t) {
    Triangle c = one.mesh.triangles[t];
    for (Index& i : c) i += first;
    all.mesh.triangles.push_back(c);
    all.mesh.uv.push_back(one.mesh.uv[t]);
    all.mesh.panel.push_back(panel);
  }
  all.mesh.particle_count += one.mesh.particle_count;
  all.mesh.panel_names.push_back(name);
}

// Square sheets, each `gap_m` above the one below and shifted by parts of an edge, so that no vertex lies above a vertex.
inline Sheet stack(double size_m, double edge_m, double gap_m, int layers) {
  const Sheet one = equilateral_sheet(size_m, size_m, edge_m);
  Sheet all;
  for (int layer = 0; layer < layers; ++layer)
    add_sheet(all, one, layer * Vec3(0.25 * edge_m, gap_m, 0.15 * edge_m), "layer " + std::to_string(layer));
  return all;
}

// Uniform in [low, high), the same numbers with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  Vec3 vector(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
    return {x, y, z};
  }

 private:
  std::mt19937_64 engine_;
};

// A crumpled copy of the positions: every particle moved by up to `size_m`.
inline Vec3s crumpled(const Vec3s& x, double size_m, std::uint64_t seed) {
  Random random(seed);
  Vec3s out = x;
  for (Vec3& p : out) p += random.vector(size_m);
  return out;
}

}  // namespace toile::internal::test
