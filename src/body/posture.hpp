// body/posture.hpp: a pose by channels of movement: lifting an arm, bending a knee, setting a foot aside.
//
// A posture is one number per channel, degrees or metres, all 0 in the A-pose; so postures may be scaled and added, and
// a blend from the A-pose is a factor.  Channels of limbs mean the same on both sides, mirrored.
//
// Legs are moved in two ways:
//   planted   soles stay flat on the floor where `foot_x`, `foot_z`, `foot_turn` put them: hip, knee and ankle are solved
//             for (two bones of lengths a, b, a hinge: a^2 + b^2 + 2 v . Rx(k) w = d^2), then `leg_*`, `knee`, `ankle`
//             lift the leg out of that
//   free      only angles count, and the body is raised or lowered until its lower sole touches the floor: the smooth
//             minimum over heels, balls and toes of both feet, at most sole_depth_m below it
#pragma once
#include "body/pose.hpp"

#include <array>
#include <cstddef>
#include <numbers>

namespace toile::internal {

inline constexpr double degree = std::numbers::pi / 180;  // in radians

enum class Channel : std::size_t {
  turn,  // of the whole figure about the vertical through the origin, to its left
  pelvis_x,
  pelvis_y,
  pelvis_z,  // m, in the figure's axes
  pelvis_turn,
  pelvis_list,
  pelvis_tilt,  // left; left side up; forwards
  spine_turn,
  spine_left,
  spine_forward,  // each bends from the joint on
  chest_turn,
  chest_left,
  chest_forward,
  neck_turn,
  neck_left,
  neck_forward,
  // Left side; the right side's stand `side_channels` later.
  collar,  // shoulder up
  arm_out,
  arm_forward,
  arm_across,  // from the A-pose: up sideways, then swung forwards, then about the vertical
  arm_turn,    // about its own axis, thumb up
  elbow,
  wrist,  // flexion; the palm's
  leg_out,
  leg_forward,
  leg_turn,  // abduction, flexion, toes outwards
  knee,
  ankle,
  toes,  // flexion; toes up; toes up against the foot
  foot_x,
  foot_z,
  foot_turn,  // of a planted foot: m outwards, m forwards, toes outwards
};

constexpr std::size_t side_channels = 16;
constexpr std::size_t channel_count = static_cast<std::size_t>(Channel::collar) + 2 * side_channels;

enum class Side : std::size_t { left, right };

struct Posture {
  std::array<double, channel_count> values{};

  double& operator()(Channel c, Side side = Side::left) {
    return values[static_cast<std::size_t>(c) + side_channels * static_cast<std::size_t>(side)];
  }
  double operator()(Channel c, Side side = Side::left) const {
    return values[static_cast<std::size_t>(c) + side_channels * static_cast<std::size_t>(side)];
  }
  void scale(double factor) {
    for (double& v : values) v *= factor;
  }
};

enum class Legs { planted, free };

constexpr double sole_depth_m = 0.01;

// `joints` are a mannequin's (their names are looked up).  A planted foot out of the leg's reach hangs from a straight
// leg; near there the knee snaps, as its angle goes with the square root of the missing reach, so motions must stay below.
Pose make_pose(const Posture& posture, Legs legs, std::span<const Joint> joints);

}  // namespace toile::internal
