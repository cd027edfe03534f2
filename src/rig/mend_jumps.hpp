// rig/mend_jumps.hpp: turns that no joint can make.
//
// Where a limb was nearly straight, a recording may go over to the other way to turn it within one frame: a knee jumps by 20 cm.  Faster than
// 8000 degrees a second is no person: a pitcher's shoulder, the fastest joint, turns at 7000 [Fleisig et al. 1999].  Such a jump is spread over the
// frames within 0.05 s before and after it, by turns that a joint can make: through rest, not through half a turn from it.
// Between jumps less than 0.25 s apart a recording flickers between two ways, one of them wrong: the spread leads over all of them.
//
// G. S. Fleisig, S. W. Barrentine, N. Zheng, R. F. Escamilla, J. R. Andrews, Kinematic and kinetic comparison of baseball pitching among various
// levels of development, J. Biomechanics 32, 1999.
#pragma once
#include "rig/pose_track.hpp"

#include <string>
#include <vector>

namespace toile::internal {

// `notes` gets a sentence for each joint that jumps.
void mend_jumps(const Figure& figure, PoseTrack& track, std::vector<std::string>& notes);

}  // namespace toile::internal
