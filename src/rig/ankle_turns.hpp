// rig/ankle_turns.hpp: a recorded foot that is turned against its shank farther than an ankle can.
//
// Where the markers of a foot are lost or swapped, a recording may fold it into the shank or turn it back to front, for seconds.  From rest an ankle
// bends by 50 degrees down, 20 up and 35 inwards at most [AAOS 1965], together by some 60.  What is more is no measurement: of a turn theta
// between 60 and 90 degrees there is left
//   theta' = 60 (90 - theta) / 30
// and of a larger one nothing, so that a foot that passes half a turn, where its axis changes sides, is at rest there.  In time the share that is
// taken is a curve without corners that is nowhere less (rig/smoothing.hpp).
//
// American Academy of Orthopaedic Surgeons, Joint Motion: Method of Measuring and Recording, 1965.
#pragma once
#include "core/quaternion.hpp"

#include <cstddef>
#include <span>

namespace toile::internal {

struct AnkleTurn {
  Quaternion shank, foot;  // in the world, since rest
};

struct AnkleFault {
  double degrees = 0;
  std::size_t frame = 0;
};

// Returns the largest turn that was too much, 0 degrees where there was none; what an ankle can do is left to the bit.
AnkleFault hold_ankle(std::span<AnkleTurn> frames, double rate_hz);

}  // namespace toile::internal
