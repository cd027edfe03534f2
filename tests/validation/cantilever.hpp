// tests/validation/cantilever.hpp: strips that are clamped level at one end and bend under their own weight.
//
// What is held ends with a line of particles; a hinge on that line bends for the cell beyond it and for half a cell on this side, so
// that the clamp is half a row before the line, and the length counts from there.
#pragma once
#include "garment/triangulate.hpp"
#include "support/elastica.hpp"
#include "support/settle.hpp"
#include "validation/figures.hpp"

#include <vector>

namespace toile::internal::test {

enum class StripMesh { rows_across, rows_along, mesher, mesher_15, mesher_30 };
inline const char* to_string(StripMesh mesh) {
  switch (mesh) {
    case StripMesh::rows_across:
      return "equilateral";
    case StripMesh::rows_along:
      return "equilateral turned 90";
    case StripMesh::mesher:
      return "mesher";
    case StripMesh::mesher_15:
      return "mesher turned 15";
    case StripMesh::mesher_30:
      return "mesher turned 30";
  }
  return "";
}

struct Strip {
  Sheet sheet;  // flat in y = 0; runs along -z from the clamp at z = 0 to the tip at z = -length
  double length_m = 0;
  double line_m = 0;        // -z of the last particles that are held
  bool along_warp = false;  // u runs along the strip, not across
};

// A strip of the mesher with a line of particles across it where it is held: two parts that share the points of that line.
inline Sheet strip_with_line(double width_m, double free_m, double held_m, double edge_m, double turn_rad) {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  const int across = static_cast<int>(std::lround(width_m / edge_m));
  Sheet sheet;
  Vec2s uv;
  std::vector<Index> line;
  const auto add = [&](double u, double v) {
    uv.emplace_back(u, v);
    return static_cast<Index>(uv.size() - 1);
  };
  for (int k = 0; k <= across; ++k) line.push_back(add(width_m * k / across, 0));
  for (const double end_m : {free_m, -held_m}) {
    const int along = std::max(1, static_cast<int>(std::lround(std::abs(end_m) / edge_m)));
    std::vector<Index> number = line;
    for (int k = 1; k <= along; ++k) number.push_back(add(width_m, end_m * k / along));
    for (int k = across - 1; k >= 0; --k) number.push_back(add(width_m * k / across, end_m));
    for (int k = along - 1; k > 0; --k) number.push_back(add(0, end_m * k / along));
    Vec2s outline;
    for (const Index i : number) {
      const Vec2& p = uv[static_cast<std::size_t>(i)];
      outline.emplace_back(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    }
    const PlanarMesh planar = triangulate(outline, edge_m);
    for (std::size_t k = outline.size(); k < planar.points.size(); ++k) {
      const Vec2& p = planar.points[k];
      number.push_back(add(c * p.x() + s * p.y(), -s * p.x() + c * p.y()));
    }
    for (const Triangle& t : planar.triangles) {
      sheet.mesh.triangles.push_back({number[static_cast<std::size_t>(t[0])], number[static_cast<std::size_t>(t[1])],
                                      number[static_cast<std::size_t>(t[2])]});
    }
  }
  sheet.mesh.particle_count = static_cast<Index>(uv.size());
  for (const Triangle& t : sheet.mesh.triangles) {
    sheet.mesh.uv.push_back(
        {uv[static_cast<std::size_t>(t[0])], uv[static_cast<std::size_t>(t[1])], uv[static_cast<std::size_t>(t[2])]});
    sheet.mesh.panel.push_back(0);
  }
  sheet.mesh.panel_names = {"strip"};
  for (const Vec2& p : uv) sheet.x.emplace_back(p.x(), 0, -p.y());
  return sheet;
}

// `rows` rows of triangles (of height L / rows, nearly) from the clamp to the tip, a width of L/4.
inline Strip clamped_strip(StripMesh kind, double length_m, int rows, bool along_warp = false) {
  Strip strip;
  strip.length_m = length_m;
  strip.along_warp = along_warp;
  const double row = length_m / (rows - 0.5), edge = row * 2 / std::sqrt(3.0), width = length_m / 4;
  const double free_m = (rows - 1) * row;  // beyond the line
  double held_m = row;                     // behind it
  strip.line_m = 0.5 * row;
  if (kind == StripMesh::rows_across) {
    strip.sheet = test::equilateral_sheet(width, held_m + free_m, edge);
  } else if (kind == StripMesh::rows_along) {
    held_m = free_m / std::lround(free_m / edge) * 2;  // the lattice has a column of particles on the line
    strip.sheet = test::equilateral_sheet(held_m + free_m, width, edge);
    for (auto& triangle : strip.sheet.mesh.uv) {
      for (Vec2& p : triangle) p = Vec2(width - p.y(), p.x());
    }
    for (Vec3& p : strip.sheet.x) p = Vec3(width + p.z(), 0, -p.x());
  } else {
    const double turn = kind == StripMesh::mesher      ? 0
                        : kind == StripMesh::mesher_15 ? 0.2617993877991494
                                                       : 0.5235987755982988;
    strip.sheet = strip_with_line(width, free_m, 2 * row, edge, turn);
    held_m = 0;  // its line lies at v = 0
  }
  for (Vec3& p : strip.sheet.x) p.z() += held_m - strip.line_m;
  if (along_warp) {
    for (auto& triangle : strip.sheet.mesh.uv) {
      for (Vec2& p : triangle) p = Vec2(p.y(), -p.x());
    }
  }
  return strip;
}

struct Sag {
  double H_m, W_m;  // drop and reach of the tip
};

inline Sag sag(const Strip& strip, const Fabric& fabric, BendElement element = BendElement::plate) {
  ModelOptions options;
  options.bend_element = element;
  ClothRun run(strip.sheet, fabric, options);
  run.step.rows.cloth_cloth = false;
  for (std::size_t i = 0; i < strip.sheet.x.size(); ++i) {
    if (-strip.sheet.x[i].z() < strip.line_m + 1e-9) run.pin(static_cast<Index>(i));
  }
  settle(run, 0.1, 1e-4, 20, 400);
  Sag sum{0, 0};
  int count = 0;
  for (std::size_t i = 0; i < strip.sheet.x.size(); ++i) {
    if (-strip.sheet.x[i].z() < strip.length_m - 1e-9) continue;
    sum.H_m -= run.state.x[i].y();
    sum.W_m -= run.state.x[i].z();
    ++count;
  }
  EXPECT_GT(count, 1);
  return {sum.H_m / count, sum.W_m / count};
}

// The rigidity of a strip of cloth lies between D (1 - nu^2), where it may curl across, and D, where its own membrane forbids that.
// Hinges by themselves have nu = -1/3 (docs/theory/bend.md).
inline double strip_rigidity_low(double nu) { return 1 - nu * nu; }
inline double strip_rigidity_middle(double nu) { return 1 - 0.5 * nu * nu; }
inline constexpr double nu_of_hinges = -1.0 / 3;

}  // namespace toile::internal::test
