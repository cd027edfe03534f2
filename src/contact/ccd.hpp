// contact/ccd.hpp: when two moving features come too near: additive continuous collision detection.    [Li et al. 2021]
//
//   x_i(t) = x_i + t u_i,  0 <= t <= 1;   d(t) the distance of the two features,   d_0 = d(0)
//   l      = |p_0| + max |p_j|  (vertex, face),   max |p_i| + max |p_j|  (edges),   p_i = u_i less their mean:
//            d changes by at most l per unit of t, so t may advance by (d - xi) / l
//   impact   the first t at which d(t) - xi is less than g = min(0.1 (d_0 - xi), 0.2 xi)
//
// Conservative by construction: no root is sought, and a motion that is called free keeps d > xi.  The small absolute
// part of g lets a landing come close; with the relative part alone a pair 20 mm apart is an impact at 2 mm.
//
// Limbs and the cloth on them move far and hardly against each other, so a thousand advances may lead past a face or an edge.  But features that
// are farther apart along one direction at two times are so at all times between, because a difference of two corners along it is linear in t.
// Before each advance w, the direction of the distance, is tried so for all of the rest: 1.3 xi are asked for, since nearer than xi + g the motion
// might be an impact to the advances; the answer is the same, by fewer of them.
// Where d_0 < 2 xi, advances would be short from the start.  There w and the direction at the end are tried with xi.
//
// Rounding.  Closest points err on one side: any two points are at least as far apart as the features.  In a needle or
// between nearly parallel edges they are found badly.  So d is not trusted but bounded: for every w
//
//   d >= min over corners a, b of the two features  w . (a - b) / |w|  = (|w|^2 - loss) / |w|,   w = x_a - x_b as found
//
// where loss, made of the products of w with the edges, is 0 for a common normal.  t advances by 0.9 (d - xi) / l, and
// d is taken as found where loss / d <= 0.05 (d - xi) - e.  Elsewhere it is the best bound, less e, among the normals
// of face or edges, of ends and edges, of ends: the nearest points of two polytopes have one of them.
//
//   e = 2^-45 M,  M = max |x_ij| + max |u_ij|.  It covers these errors, in M 2^-53:
//     u as a rounded difference, t u, x + t u           3 a coordinate, two points         11
//     w from differences and products                  20 a coordinate                     35
//     |w| taken for the root of distance2              as much again, and a norm           47
//     loss, or the bound, from products with w                                             63
//     l from u less their mean, and t itself                                               45
//                                                                          together 201 < 256
//
// 1 m from the origin e is 3e-14 m, 1 km from it 3e-11 m.  A pair with d <= xi + e at the start is an impact at 0,
// whatever its motion.
//
// Easily got wrong: the answer is about the features' own distance.  Whether they may touch (neighbours in the cloth)
// is the caller's business.
#pragma once
#include "core/types.hpp"

#include <array>

namespace toile::internal {

inline constexpr double no_impact = 2;  // a time later than any step

// Of xi: features that are farther apart all the way are no impact.  xi + g, and what need not be proven of the distance.
inline constexpr double clear_share = 1.3;

// First time in [0, 1] at which the vertex x[0] and the face x[1..3] come nearer than `separation_m` (xi), or
// no_impact.  Positions x in m, displacements u in m.  A pair that is nearer than xi at the start is an impact at 0.
double vertex_face_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double separation_m);

// The same for the edges x[0] x[1] and x[2] x[3].
double edge_edge_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double separation_m);

}  // namespace toile::internal
