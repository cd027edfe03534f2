// rig/feet.hpp: where feet stand in a recording.
//
// A foot stands while its ankle is low and slow.  Recorded skeletons have feet that are not flat at rest, and floors that are not level; so the
// sole's tilt is the median over the times it stands, and the floor is what a foot touches within a step's time.
#pragma once
#include "core/quaternion.hpp"
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct RecordedFoot {
  std::vector<Vec3> ankle;       // [frame]
  std::vector<Quaternion> turn;  // of the foot in the world, since its rest pose
};

// [frame] whether it stands.  Lengths are relative to the leg's.
std::vector<char> standing_frames(const RecordedFoot& foot, double leg, double rate_hz);
// The direction of the foot, in its axes at rest, that points up while it stands; up where it never stands.
Vec3 sole_normal(const RecordedFoot& foot, std::span<const char> standing);
// [frame] how high a body is in the air, by its lowest point: above the lowest within a step's time, and 0 on the floor.
std::vector<double> clearance(std::span<const double> lowest, double leg, double rate_hz);

}  // namespace toile::internal
