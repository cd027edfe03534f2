// garment/triangulate.hpp: near-equilateral triangles inside a closed polygon whose boundary points are kept as they are.
//
// Constrained Delaunay with exact predicates (coordinates snapped to a 2^-20 m grid, 128-bit integers), interior points on
// a jitter-free triangular lattice at `edge_m` away from the boundary, Delaunay refinement where the shape asks for it, then a few
// smoothing sweeps with re-triangulation.  Bending is isotropic only on such meshes (docs/theory/bend.md).
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile {

struct PlanarMesh {
  std::vector<Vec2> points;              // the polygon's points first, in order and unchanged, then interior points
  std::vector<Triangle> triangles;       // counter-clockwise
};

struct PlanarQuality {
  double min_angle_deg = 0, p1_angle_deg = 0, mean_edge_m = 0, min_edge_m = 0, max_edge_m = 0;
};

// `outline` is a simple closed polygon, either orientation, without repeated points; throws InputError("", "point 12", ...)
// for fewer than 3 points, repeated points, edges that cross, or an area that is zero.
PlanarMesh triangulate(std::span<const Vec2> outline, double edge_m);

// A rectangle from (0, 0) to (width_m, height_m) whose sides are cut evenly, as near `edge_m` as whole pieces allow.
PlanarMesh equilateral_sheet(double width_m, double height_m, double edge_m);

PlanarQuality planar_quality(const PlanarMesh& mesh);

}  // namespace toile
