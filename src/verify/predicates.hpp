// verify/predicates.hpp: exact predicates: the side of a plane, and whether a segment passes through a triangle.
//
//                 | ax ay az 1 |      Filter: the determinant in double, with Shewchuk's a-priori bound on its error;
//   orient3d =    | bx by bz 1 |      when the bound does not decide, the same determinant as an exact sum of doubles.
//                 | cx cy cz 1 |      [Shewchuk 1997, Adaptive Precision Floating-Point Arithmetic, 2-4]
//                 | dx dy dz 1 |      Zero is resolved by simulation of simplicity.  [Edelsbrunner & Mücke 1990]
//
// Exact for finite coordinates that are multiples of 2^-350 and below 2^330 in magnitude, with the processor rounding
// to nearest and denormals kept: no product underflows or overflows there.  Every float32 (a multiple of 2^-149, below
// 2^128) is in that range, so the positions of a point cache always are.
//
// Easily got wrong: a degenerate configuration has no right answer for one pair of elements alone.  An edge that passes
// exactly through the common edge of two triangles only touches each of them, and yet it pierces the surface.  All
// calls that together judge one mesh must therefore give a particle the same rank; then they judge one and the same
// infinitesimally displaced mesh that has no degeneracy, and that edge is counted once.
#pragma once
#include "core/types.hpp"

namespace toile::internal {

// Sign (-1, 0, +1) of the determinant above, exactly: +1 when d is below the plane of a, b, c seen counter-clockwise
// from above.  0 means exactly coplanar.
int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// A point and its place in the order of perturbations; points of one call have different ranks.
struct RankedPoint {
  const Vec3& x;
  std::int64_t rank;
};

// As orient3d_exact where that is not 0.  Otherwise the sign after coordinate j of the point of rank i is displaced by
// epsilon^(2^(3i + j)), epsilon -> 0+.  Never 0, and antisymmetric in its arguments.
int orient3d_perturbed(RankedPoint a, RankedPoint b, RankedPoint c, RankedPoint d);

// Does segment pq pass through triangle abc of the perturbed mesh?
//   - a proper crossing (q beyond the plane, the crossing point inside the triangle, however shallow)   always true
//   - no common point (however near)                                                                   always false
//   - touching, coplanar, or a triangle without area: true or false, but the same mesh is meant in every call.  A
//     surface that is pierced exactly through an edge or a vertex is pierced once; one that is merely touched may count.
// Does not depend on the order of p, q nor of a, b, c.
bool segment_crosses_triangle(RankedPoint p, RankedPoint q, RankedPoint a, RankedPoint b, RankedPoint c);

// For a single pair: ranks in the order of the arguments.
bool segment_crosses_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace toile::internal
