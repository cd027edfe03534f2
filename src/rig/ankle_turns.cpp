#include "rig/ankle_turns.hpp"

#include "rig/smoothing.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace toile::internal {
namespace {

constexpr double believed_deg = 60, no_ankle_deg = 90;
constexpr double smooth_s = 0.2;  // as spines (rig/spine_bends.cpp)

double turn_deg(const AnkleTurn& ankle) {
  const Quaternion turn = ankle.shank.inverse() * ankle.foot;
  return 2 * ieee_atan2(std::sqrt(turn.v.squaredNorm()), std::abs(turn.w)) * 180 / std::numbers::pi;
}

double least_share(double degrees) {
  if (degrees <= believed_deg) return 0;
  if (degrees >= no_ankle_deg) return 1;
  const double left_deg = believed_deg * (no_ankle_deg - degrees) / (no_ankle_deg - believed_deg);
  return 1 - left_deg / degrees;
}

}  // namespace

AnkleFault hold_ankle(std::span<AnkleTurn> frames, double rate_hz) {
  AnkleFault most;
  std::vector<double> least;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const double degrees = turn_deg(frames[f]);
    least.push_back(least_share(degrees));
    if (least.back() > 0 && degrees > most.degrees) most = {degrees, f};
  }
  if (most.degrees == 0) return most;
  const std::vector<double> share = smoothed_above(least, smooth_s, rate_hz, false);
  for (std::size_t f = 0; f < frames.size(); ++f)
    if (share[f] > 0) frames[f].foot = slerp(frames[f].foot, frames[f].shank, std::min(share[f], 1.0));
  return most;
}

}  // namespace toile::internal
