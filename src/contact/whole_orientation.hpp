// contact/whole_orientation.hpp: the side of a plane on which a point lies, exact for whole coordinates.
//
//                 | ax ay az 1 |      In double first, with a bound on the error; else in integers:
//   orientation = | bx by bz 1 |          |coordinate| <= 2^60, a difference <= 2^61, a minor <= 2^123
//                 | cx cy cz 1 |      a minor times a difference in two halves of 64 bits (whole_orientation.cpp).
//                 | dx dy dz 1 |
//
// Zero is resolved by simulation of simplicity: coordinate j of the point of rank i is perturbed by
// epsilon^(2^(3i + j)), epsilon -> 0+.                                                        [Edelsbrunner & Mücke 1990]
//
// The judge decides the same questions on the same perturbed mesh by another arithmetic (verify/predicates.hpp) and
// shares nothing with this: tests/sim/finders_test.cpp compares the two.
#pragma once
#include "core/types.hpp"

#include <array>

namespace toile::internal {

inline constexpr int whole_bits = 60;  // of a coordinate

// A point with whole coordinates, in doubles, and its rank in the order of perturbations.
struct WholePoint {
  Vec3 x;
  Index rank;
};

// Sign of the determinant above: +1: d is below the plane of a, b, c seen counter-clockwise from above; 0: coplanar.
int whole_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The same where that is not 0, else the sign for the perturbed points: never 0.  Ranks must differ.
int perturbed_orientation(const std::array<const WholePoint*, 4>& points);

// Whether the segment pq passes through the triangle abc of the perturbed mesh.
bool passes_through(const WholePoint& p, const WholePoint& q, const WholePoint& a, const WholePoint& b,
                    const WholePoint& c);

}  // namespace toile::internal
