#include "rig/spine_bends.hpp"

#include "rig/smoothing.hpp"

#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

constexpr double whole_deg = 90;  // from the hips to the neck
constexpr double smooth_s = 0.2;  // as limbs that are led out of the trunk (body/limb_clearance.hpp)
constexpr int steps = 32, halvings = 5;

SpineTurns shared(const SpineTurns& given, double share) {
  SpineTurns turns = given;
  const std::size_t n = given.size() - 1;
  for (std::size_t i = 1; i < n; ++i) {
    const double place = static_cast<double>(i) / static_cast<double>(n);
    turns[i] = slerp(given[i], slerp(given.front(), given.back(), place), share);
  }
  return turns;
}

double bend_deg(const Quaternion& below, const Quaternion& joint, const Vec3& along) {
  const Vec3 a = below * along, b = joint * along;
  return ieee_atan2(std::sqrt(a.cross(b).squaredNorm()), a.dot(b)) * 180 / std::numbers::pi;
}

SpineBend largest_bend(const SpineTurns& turns, const Vec3& along) {
  SpineBend most;
  for (std::size_t i = 1; i < turns.size(); ++i)
    if (const double bend = bend_deg(turns[i - 1], turns[i], along); bend > most.degrees) most = {bend, i, 0};
  return most;
}

double least_share(const SpineTurns& turns, const Vec3& along, double largest_deg) {
  const auto bends = [&](double share) { return largest_bend(shared(turns, share), along).degrees > largest_deg; };
  int step = 0;
  while (step < steps && bends(static_cast<double>(step) / steps)) ++step;
  if (step == 0) return 0;
  double low = static_cast<double>(step - 1) / steps, high = static_cast<double>(step) / steps;
  for (int k = 0; k < halvings; ++k) (bends(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return high;
}

}  // namespace

SpineBend share_bends(std::span<SpineTurns> frames, const Vec3& along, double rate_hz) {
  SpineBend most;
  if (frames.empty() || frames.front().size() < 3) return most;  // a joint alone has nobody to share with
  const double largest_deg = whole_deg / static_cast<double>(frames.front().size() - 1);
  std::vector<double> least;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    least.push_back(least_share(frames[f], along, largest_deg));
    SpineBend bend = largest_bend(frames[f], along);
    bend.frame = f;
    if (least.back() > 0 && bend.degrees > most.degrees) most = bend;
  }
  if (most.degrees == 0) return most;
  const std::vector<double> share = smoothed_above(least, smooth_s, rate_hz, false);
  for (std::size_t f = 0; f < frames.size(); ++f)
    if (share[f] > 0) frames[f] = shared(frames[f], std::min(share[f], 1.0));
  return most;
}

}  // namespace toile::internal
