// body/polygonise.hpp: triangles of an implicit surface: a rough mesh by marching tetrahedra, then isotropic remeshing.
//
// Both work on the half x >= 0 of a field that is symmetric in x; the plane x = 0 cuts the surface along a border,
// whose vertices have x = 0 exactly, so that the mirrored half fits without a seam and the whole is symmetric to
// the last bit.
//   rough mesh    each cube of a grid as six tetrahedra around its main diagonal (Kuhn): no ambiguous case, always
//                 manifold
//   remeshing     split edges longer than 4/3 L, collapse those shorter than 4/5 L, flip towards valence 6 (4 on the
//                 border), move vertices in the tangent plane towards the centroid of their neighbours, and back onto
//                 f = 0 by Newton.                                                       [Botsch & Kobbelt 2004]
// Every decision compares numbers made of + - * / sqrt, in a fixed order: the same mesh everywhere.
#pragma once
#include "core/types.hpp"

#include <functional>
#include <vector>

namespace toile::internal {

using ScalarField = std::function<double(const Vec3&)>;

struct HalfSurface {  // x >= 0, open along x = 0
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;  // counter-clockwise from outside (where the field is positive)
};

// `low` must have x = 0; the surface must stay inside the box but for x = 0.  `cell_m` is the grid's spacing.
HalfSurface march_tetrahedra(const ScalarField& field, const Vec3& low, const Vec3& high, double cell_m);

// `edge_m(p)` is the target edge length near p; it should vary by less than about 0.2 m per m.
void remesh(HalfSurface& surface, const ScalarField& field, const ScalarField& edge_m, int sweeps);

// Mirrors the half: first the vertices on the plane, then those with x > 0, then their images in the same order.
HalfSurface mirror(const HalfSurface& half);

}  // namespace toile::internal
