// rig/spine_bends.hpp: a recorded spine that bends in one joint farther than a spine can.
//
// Where markers of the hips are lost, a recording may put a bend of 80 degrees into the lowest of three joints and take some of it back above.
// Skin folds deep into itself there, and thighs enter the belly.  A spine bends by 90 degrees at most from the hips to the neck (80 in clinical
// tables), all along: so of n joints none by more than 90 / n.  Where one does, all are led towards even shares,
//   W_i' = slerp(W_i, slerp(H, W_n, i / n), s)       W_i: turns in the world since rest, i = 1 ... n; H: the hips'
// with the least s in [0, 1] at which none is beyond its share, in time a curve without corners that is nowhere less (rig/smoothing.hpp).  Hips
// and the last joint, which carries neck and arms, keep their turns.  A spine that bends farther as a whole ends at even shares.
#pragma once
#include "core/quaternion.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace toile::internal {

using SpineTurns = std::vector<Quaternion>;  // H, W_1 ... W_n

struct SpineBend {
  double degrees = 0;
  std::size_t joint = 0, frame = 0;  // joint: 1 ... n
};

// `along`: the direction of the spine at rest.  Returns the largest bend that was too much, 0 degrees where there was none; what is within its
// share is left to the bit.
SpineBend share_bends(std::span<SpineTurns> frames, const Vec3& along, double rate_hz);

}  // namespace toile::internal
