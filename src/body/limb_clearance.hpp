// body/limb_clearance.hpp: arms and legs that leave room for cloth between them and the body.
//
// A recording's limbs belong to another body.  On one that is wider there arms enter its flanks, thighs its belly, and cloth between has no place to
// be.  So a limb is turned about its shoulder or hip c by the least angle at which every point p of its surface has
//   gap(p) >= min(room, wedge gap_at_rest(p))       gap: signed distance to the rest of the body, negative inside
// The wedge: towards the armpit or groin, where both skins are one, the room tapers.  The turn takes a joint q of the limb towards a direction o, about
// (q - c) x o.
//   legs   o: halfway between down, along the trunk's axis, and the leg's own side; there a leg is clear of the trunk and of the other leg.
//          q: the knee.  The rest of the body: the trunk; arms come later.
//   arms   o: from the axis to q, at right angles to it.  First for the upper arm's points, with the elbow as q; then for all, with the hand: off a
//          flank it goes to the side, off a chest to the front.  The rest of the body: trunk and legs.
// The trunk's axis leads from the hips to the middle of the shoulders.
//
//   in time   least angle -> the largest within T before and after -> the mean over T / 2 before and after, twice
// is nowhere less than needed, has no corners, and is exactly 0 where the limb is clear for 2 T before and after (rig/smoothing.hpp).
//
// A body that stood on a leg that was turned is put down again: its lowest point is as high as it was.
//
// Mind: points of an arm are those that its bones alone move, the rest of the body what no arm moves: what both move is neither.  About a hip, where
// skin is blended for a hand's breadth, a leg's points are those that it moves for the most part (turned by their share), the trunk what it moves by
// a tenth at most.
#pragma once
#include "core/quaternion.hpp"
#include "rig/bone_names.hpp"
#include "rig/pose_track.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

// A body on a skeleton, in metres.
struct PosedBody {
  const Figure* figure = nullptr;
  std::span<const Index> vertices;      // of the figure, of each vertex of the body
  std::span<const Triangle> triangles;  // counter-clockwise from outside
  Mat3 to_body = Mat3::Identity();      // from the figure's axes and unit
  std::function<void(const FigurePose&, std::span<Vec3>)> place;
};

// Turns the limbs of a track, legs first; what is clear is left to the bit.  `notes` gets a sentence for a limb that was turned.  A figure without
// two arms of known names is left alone.
void keep_limbs_clear(const PosedBody& body, const PersonBones& bones, double room_m, PoseTrack& track,
                      std::vector<std::string>& notes);

}  // namespace toile::internal
