// verify/pinch.hpp: crossings of cloth with the body where the body itself leaves no room.
//
// A point of the body's surface lies in a pinch where it has
//   another part of the body around it    the surface winds around the point just outside of it
//   or in front of it, within pinch_m     a face that looks back: n . n' < -1/2
// A crossing does when it is at such a point, or when an end of the cloth's edge (a corner of the cloth's triangle) is within two parts of the
// body, or nearest to such a point: an edge leads from a pinch to where there is room, and has to come out somewhere.
// Cloth between an arm and the trunk that overlap is within one of them wherever it is.
#pragma once
#include "verify/crossings.hpp"

namespace toile::internal {

inline constexpr double pinch_m = 5e-3;  // two of the offsets that runs have by themselves

// Those of `crossings` (as find_body_crossings gives them for the same surfaces) that do not lie in a pinch, in their order.
std::vector<Crossing> outside_pinches(std::span<const Crossing> crossings, std::span<const Triangle> cloth,
                                      std::span<const Vec3> x, std::span<const Triangle> body,
                                      std::span<const Vec3> body_x);

}  // namespace toile::internal
