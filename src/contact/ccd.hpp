// contact/ccd.hpp: when do two moving features come too near?  Additive continuous collision detection.   [Li et al. 2021]
//
//   x_i(t) = x_i + t u_i,  0 <= t <= 1;   d(t) the distance of the two features,   d_0 = d(0)
//   l      = |p_0| + max |p_j|  (vertex, face),   max |p_i| + max |p_j|  (edges),   p_i = u_i less their mean:
//            d cannot change faster than l per unit of t, so t may advance by (d - xi) / l without looking
//   impact   the first t at which d(t) - xi is less than g = min(0.1 (d_0 - xi), 0.2 xi)
//
// Conservative by construction: no root is sought, and a motion that is called free keeps d > xi.  The small absolute
// part of g lets a landing come close; with the relative part alone a pair 20 mm apart is an impact at 2 mm.
//
// Easily got wrong: the answer is about the features' own distance.  Whether they may touch (neighbours in the cloth)
// is the caller's business.
#pragma once
#include "core/types.hpp"

#include <array>

namespace toile {

inline constexpr double no_impact = 2;  // a time later than any step

// First time in [0, 1] at which the vertex x[0] and the face x[1..3] come nearer than `separation_m` (xi), or
// no_impact.  Positions x in m, displacements u in m.  A pair that is nearer than xi at the start is an impact at 0.
double vertex_face_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double separation_m);

// The same for the edges x[0] x[1] and x[2] x[3].
double edge_edge_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double separation_m);

}  // namespace toile
