// contact/whole_orientation.hpp: on which side of a plane a point lies, decided without error on coordinates that are whole numbers.
//
//                 | ax ay az 1 |      In double first, with a bound on the error; where that does not decide, in integers:
//   orientation = | bx by bz 1 |          |coordinate| <= 2^60, a difference <= 2^61, a minor <= 2^123
//                 | cx cy cz 1 |      a minor times a difference is taken in two halves of 64 bits (whole_orientation.cpp).
//                 | dx dy dz 1 |
//
// Zero is resolved by simulation of simplicity: coordinate j of the point of rank i is thought to be displaced by
// epsilon^(2^(3i + j)), epsilon -> 0+.                                                        [Edelsbrunner & Mücke 1990]
//
// The judge decides the same questions on the same displaced mesh by another arithmetic (verify/predicates.hpp) and shares nothing with
// this: tests/sim/finders_test.cpp holds the two against each other.
#pragma once
#include "core/types.hpp"

#include <array>

namespace toile::internal {

inline constexpr int whole_bits = 60;  // of a coordinate

// A point with whole coordinates, held in doubles, and its place in the order of perturbations.
struct WholePoint {
  Vec3 x;
  Index rank;
};

// Sign of the determinant above: +1 when d is below the plane of a, b, c seen counter-clockwise from above; 0: coplanar.
int whole_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// As whole_orientation where that is not 0, else the sign for the displaced points: never 0.  Ranks must differ.
int perturbed_orientation(const std::array<const WholePoint*, 4>& points);

// Does the segment pq pass through the triangle abc of the displaced mesh?
bool passes_through(const WholePoint& p, const WholePoint& q, const WholePoint& a, const WholePoint& b,
                    const WholePoint& c);

}  // namespace toile::internal
