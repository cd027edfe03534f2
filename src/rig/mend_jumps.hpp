// rig/mend_jumps.hpp: turns that no joint can make.
//
// Where a limb was nearly straight, a recording may go over to the other way to turn it within one frame: a knee jumps by 20 cm.  Faster than
// 8000 degrees a second is no person: a pitcher's shoulder, the fastest joint, turns at 7000 [Fleisig et al. 1999].  Such a jump is spread along
// the shorter arc over the frames within 0.05 s before and after it.
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
