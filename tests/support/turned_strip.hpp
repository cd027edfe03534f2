// tests/support/turned_strip.hpp: a strip from the mesher, whose triangles lie at some angle to it.
#pragma once
#include "garment/triangulate.hpp"
#include "mesh/cloth_mesh.hpp"

#include <cmath>

namespace toile::internal::test {

// From the mesher, and then drawn at (0, 0) to (u_m, v_m): the outline is turned before it is meshed, and turned back, so the triangles' rows lie
// at the angle `turn` to the strip.  The threads are not turned.
inline ClothMesh turned_strip(double u_m, double v_m, double edge_m, double turn) {
  const double c = std::cos(turn), s = std::sin(turn);
  const auto turned = [&](const Vec2& p) { return Vec2(c * p.x() - s * p.y(), s * p.x() + c * p.y()); };
  std::vector<Vec2> outline;
  const int along = static_cast<int>(std::lround(u_m / edge_m)), across = static_cast<int>(std::lround(v_m / edge_m));
  for (int k = 0; k < along; ++k) outline.push_back(turned({u_m * k / along, 0}));
  for (int k = 0; k < across; ++k) outline.push_back(turned({u_m, v_m * k / across}));
  for (int k = along; k > 0; --k) outline.push_back(turned({u_m * k / along, v_m}));
  for (int k = across; k > 0; --k) outline.push_back(turned({0, v_m * k / across}));
  const PlanarMesh planar = triangulate(outline, edge_m);
  ClothMesh mesh;
  mesh.particle_count = static_cast<Index>(planar.points.size());
  mesh.triangles = planar.triangles;
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2& p = planar.points[static_cast<std::size_t>(t[k])];
      uv[k] = Vec2(c * p.x() + s * p.y(), -s * p.x() + c * p.y());
    }
    mesh.uv.push_back(uv);
    mesh.panel.push_back(0);
  }
  mesh.panel_names = {"strip"};
  return mesh;
}

}  // namespace toile::internal::test
