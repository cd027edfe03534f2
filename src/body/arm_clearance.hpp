// body/arm_clearance.hpp: arms that leave room for cloth between them and the body.
//
// A recording's arms belong to another body.  On one that is wider there they enter its flanks, and cloth between has no place to be.  So an arm
// is turned about its shoulder by the least angle at which every point p of its surface has
//   gap(p) >= min(room, wedge gap_at_rest(p))       gap: signed distance to the rest of the body, negative inside
// The wedge: towards the armpit, where both skins are one, the room tapers.  The turn takes a joint q away from the trunk's axis, which leads
// from the hips to the middle of the shoulders: it is about (q - shoulder) x o, with o from the axis to q, at right angles to the axis.  First
// for the upper arm's points, with the elbow as q; then for all, with the hand: off a flank it goes to the side, off a chest to the front.
//
//   in time   least angle -> the largest within T before and after -> the mean over T / 2 before and after, twice
// is nowhere less than needed, has no corners, and is exactly 0 where the arm is clear for 2 T before and after.
//
// Mind: points are those that the arm's bones alone move, the rest of the body what no arm moves: what both move is neither.
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

// Turns the arms of a track; what is clear is left to the bit.  `notes` gets a sentence when an arm was turned.  A figure without two arms of
// known names is left alone.
void keep_arms_clear(const PosedBody& body, const PersonBones& bones, double room_m, PoseTrack& track,
                     std::vector<std::string>& notes);

}  // namespace toile::internal
