// rig/retarget.hpp: the motion of one person's skeleton for another's.
//
// Every bone of the target that has one in the source is turned as that one is, in the axes of the world:
//   Q(t) = W(t) D R       W: turn of the source's bone since its rest pose, R: turn of the target's at rest
//   D: the rest poses' difference.  Of arms, thighs and shanks the smallest turn from the target's bone to the source's, so that a recording that
//      begins in a T-pose moves a body that stands in an A-pose; of feet the tilt of the source's sole against the floor where it stands
//      (rig/feet.hpp); of all others none.  Hands go with their forearms, toes with their feet.
// Before that the source is turned by right angles until up and left are the target's, and about the vertical so that the motion begins facing as
// the target does.  The hips go their way, scaled by the length of the legs, beginning where they stand; the body is then raised or lowered so that its
// lower sole is on the floor, or in the air as it was.
//
// Before all that joints that jump are mended (rig/mend_jumps.hpp), turns of a spine that bends in one place farther than a spine can are shared by its
// joints (rig/spine_bends.hpp), and feet that are turned farther than ankles can are led back (rig/ankle_turns.hpp).
//
// What has no bone in the source stays as it is at rest, relative to its parent.
#pragma once
#include "rig/bone_names.hpp"
#include "rig/pose_track.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// A skeleton, and which of its nodes are which part of a person.
struct Person {
  const Figure* figure;
  PersonBones bones;
};

struct Retargeted {
  PoseTrack track;
  std::vector<std::string> notes;
};

// Throws InputError, with `file` as its place, for a source or a target without hips, thighs or shanks.
Retargeted retarget(const Person& source, const PoseTrack& moves, const Person& target, std::string_view file);

}  // namespace toile::internal
