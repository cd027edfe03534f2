// verify/pinch.hpp: crossings of cloth with the body where parts of the body leave no room between them.
//
// A point of the body's surface lies in a pinch where it has
//   another part of the body around it    the point just outside of it is inside the body
//   or in front of it, within pinch_m     a face that looks back: n . n' < -1/2
// A crossing lies in a pinch when it is at such a point, or when an end of the cloth's edge (a corner of the cloth's triangle) is within two parts
// of the body, or nearest to such a point: an edge that leads out of a pinch has to cross the body somewhere.
// Cloth between an arm and the trunk that overlap is always within one of them.
#pragma once
#include "verify/crossings.hpp"

namespace toile::internal {

inline constexpr double pinch_m =
    3e-3;  // two offsets of cloth from a person: nearer than that, a step has no room either

// The `crossings` (of find_body_crossings for the same surfaces) that do not lie in a pinch, in their order.
std::vector<Crossing> outside_pinches(std::span<const Crossing> crossings, std::span<const Triangle> cloth,
                                      std::span<const Vec3> x, std::span<const Triangle> body,
                                      std::span<const Vec3> body_x);

}  // namespace toile::internal
