// body/solid_shapes.hpp: plain solids for scenes without a person: closed meshes, triangles counter-clockwise from outside.
// Lengths in metres, > 0.
#pragma once
#include "core/types.hpp"
#include "io/surface_mesh.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace toile::internal {

struct SolidMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};

// Upright, with rounded rims, of 322 vertices and 640 triangles: the solid of the paper's first two figures, by its
// counts [BW98 8].  `top` is the middle of the upper cap.
SolidMesh rounded_cylinder(double radius_m, double height_m, const Vec3& top);

// More triangles in one solid are an InputError("", "edge_m", ...), before any are made.
inline constexpr std::size_t most_solid_triangles = 2'000'000;

// Around the origin: an octahedron halved until no edge is longer than `edge_m`.  Corners lie on the sphere.
SolidMesh ball(double radius_m, double edge_m);

// Around the origin, with sharp edges: faces of two triangles each.
SolidMesh block(const Vec3& size_m);

// The surface of revolution of the outline (distance from the y axis, height).  It runs from the axis to the axis (a cone, a
// spindle), or is a closed curve beside it (a torus, a funnel with a wall); either way round.  Pieces are cut, and the circle is,
// so that no edge along either is longer than `edge_m`.
// Throws InputError("", "profile", ...) for fewer than three points, a distance below 0, points that coincide, an outline
// that touches the axis between its ends, or has one end on it.
SolidMesh revolved(std::span<const Vec2> profile_m, double edge_m);

// These triangles of the file's vertices; unused vertices are dropped.  The caller checks the surface.
SolidMesh whole_of(const SurfaceMesh& mesh, std::span<const Triangle> triangles);

// A room: the same surface seen from inside.
void turn_inside_out(SolidMesh& solid);

}  // namespace toile::internal
