// material/plate.hpp: how the three edges of a triangle turn under bending moments: the plate element of Hellan, Herrmann and Johnson.
//
//   M constant in a triangle, m_k = L_k n_k.M n_k the moment across edge k, N m: what turns the two triangles there about their edge
//   phi = F m,   F = A W^T C^-1 W        phi_k: this triangle's part of the fold angle at edge k, rad
//
// Both triangles of a hinge feel one moment, and their parts add up to its fold angle: assembly/plate_moments.hpp.
// Constant curvature is exact on any triangles, for any C.                                    docs/theory/bend.md
#pragma once
#include "core/types.hpp"
#include "material/fabric.hpp"

namespace toile::internal {

// C, N m: (M_uu, M_vv, M_uv) = C (S_uu, S_vv, 2 S_uv), with S the curvature in 1/m.
//
//        | D_u  D_1       |      D_1 = nu sqrt(D_u D_v)
//    C = | D_1  D_v       |      D_uv = (1 - nu)/2 sqrt(D_u D_v) unless the fabric says otherwise
//        |           D_uv |
//
// A rigidity of zero becomes 1e-12 N m, a ten millionth of cotton's: a moment needs an inverse.  With bending friction it is that against bends
// too small to make threads slip, C (1 + D_f/D) of bend_hysteresis.hpp.
constexpr double least_rigidity_N_m = 1e-12;
Mat3 bending_rigidity(const Fabric& fabric);

// F, rad/(N m), of a triangle with corners uv in m; side k joins corners k and k + 1.  No side is stiffer than a thousand times the
// largest entry of C, which slivers would be.
Mat3 plate_compliance(const std::array<Vec2, 3>& uv, const Mat3& rigidity_N_m);

// B = A W^T, m: a curvature (S_uu, S_vv, 2 S_uv) of the triangle turns its three sides by phi = B S.
Mat3 side_turns(const std::array<Vec2, 3>& uv);

}  // namespace toile::internal
