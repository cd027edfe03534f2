// garment/triangulate.hpp: near-equilateral triangles inside a closed polygon whose boundary points are kept
// unchanged.
//
// Constrained Delaunay with exact predicates (coordinates snapped to a 2^-20 m grid, 128-bit integers), interior
// points on a jitter-free triangular lattice at `edge_m` away from the boundary, a few smoothing sweeps with
// re-triangulation, then vertices inserted, removed or moved wherever a triangle is still poor.  Bending is isotropic
// only on such meshes (docs/theory/bend.md).  How and how well: docs/theory/meshing.md.
//
// Easily got wrong: the sides must already be cut into pieces of about `edge_m`.  Nothing is ever inserted
// on the boundary, because the panel across the seam owns the same points; a side left uncut stays one long edge.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct PlanarMesh {
  std::vector<Vec2> points;         // the polygon's points first, in order and unchanged, then interior points
  std::vector<Triangle> triangles;  // counter-clockwise
};

// Within `reach_m` of a line the triangles inside have edges of `edge_m`, as the outline there must have.
struct FinerZone {
  std::vector<Vec2> line;
  double reach_m = 0, edge_m = 0;
};

struct PlanarQuality {  // over all angles and over all edges, each edge once; zeros for an empty mesh
  double min_angle_deg = 0, p1_angle_deg = 0;  // p1: one angle in a hundred is smaller
  double mean_edge_m = 0, min_edge_m = 0, max_edge_m = 0;
};

// `outline` is a simple closed polygon in metres, either orientation, without repeated points.  Equal input gives equal
// bits, and an outline shifted by whole grid steps gives the same mesh shifted.  Where three outline points lie on
// a line to within a micrometre, properties of the snapped points hold for the given ones only to that micrometre.
// Throws InputError("", "point 12", ...) for points that are not finite, coincide (after snapping) or lie more than
// 16 m from the middle, and for edges that cross, touch or fold back; InputError("", "outline", ...) for fewer than 3
// points or an area that is zero; InputError("", "edge_m", ...) below 0.06 mm or for more than 2^24 interior points.
PlanarMesh triangulate(std::span<const Vec2> outline, double edge_m, std::span<const FinerZone> finer = {});

// A rectangle from (0, 0) to (width_m, height_m) whose sides are cut evenly, as near `edge_m` as whole pieces allow.
PlanarMesh equilateral_sheet(double width_m, double height_m, double edge_m);

PlanarQuality planar_quality(const PlanarMesh& mesh);

}  // namespace toile::internal
