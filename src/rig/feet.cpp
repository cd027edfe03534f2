#include "rig/feet.hpp"

#include "rig/smoothing.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double low_share = 0.04;  // of the leg, above where the ankle is lowest: less than a heel is lifted in a step
constexpr double slow_per_s =
    0.5;  // legs a second: an ankle in the air passes at 2 and more, rolling over a standing foot below 0.4
constexpr double lowest_share = 0.1;   // of the frames count as lowest, as single ones are wrong
constexpr double fewest_share = 0.02;  // of the frames make a foot that stands
constexpr double step_s = 0.6;         // half of a stride: within it before and after, one foot stands
constexpr double in_the_air = 0.03;    // of the leg: less is a rolling foot, or the recording's error
constexpr double least_upright = 0.5;  // cosine: a sole that stands steeper than 60 degrees is no sole

double share_of(std::vector<double> values, double share) {
  const auto k = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

std::size_t frames_of(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::max(1.0, std::round(seconds * rate_hz)));
}

// The lowest within `reach` frames before and after.
std::vector<double> lowest_about(std::span<const double> values, std::size_t reach) {
  std::vector<double> lowest(values.size());
  for (std::size_t f = 0; f < values.size(); ++f) {
    const std::size_t first = f > reach ? f - reach : 0, end = std::min(f + reach + 1, values.size());
    lowest[f] = *std::min_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                                  values.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return lowest;
}

}  // namespace

std::vector<char> standing_frames(const RecordedFoot& foot, double leg, double rate_hz) {
  const std::size_t frames = foot.ankle.size();
  std::vector<double> heights;
  for (const Vec3& p : foot.ankle) heights.push_back(p.y());
  const double low = share_of(heights, lowest_share) + low_share * leg;
  std::vector<char> standing(frames, 0);
  for (std::size_t f = 0; f < frames; ++f) {
    const std::size_t before = f > 0 ? f - 1 : f, after = std::min(f + 1, frames - 1);
    const double seconds = static_cast<double>(after - before) / rate_hz;
    const double speed = seconds > 0 ? (foot.ankle[after] - foot.ankle[before]).norm() / seconds : 0;
    standing[f] = heights[f] <= low && speed <= slow_per_s * leg ? 1 : 0;
  }
  return standing;
}

Vec3 sole_normal(const RecordedFoot& foot, std::span<const char> standing) {
  const Vec3 up(0, 1, 0);
  std::array<std::vector<double>, 3> normals;
  for (std::size_t f = 0; f < standing.size(); ++f) {
    if (standing[f] == 0) continue;
    const Vec3 normal = foot.turn[f].inverse() * up;
    for (std::size_t k = 0; k < 3; ++k) normals[k].push_back(normal[static_cast<Eigen::Index>(k)]);
  }
  if (static_cast<double>(normals[0].size()) < std::max(1.0, fewest_share * static_cast<double>(standing.size())))
    return up;
  const Vec3 median(share_of(normals[0], 0.5), share_of(normals[1], 0.5), share_of(normals[2], 0.5));
  const double length = std::sqrt(median.squaredNorm());
  if (!(length > 0) || median.y() < least_upright * length) return up;
  return median / length;
}

std::vector<double> clearance(std::span<const double> lowest, double leg, double rate_hz) {
  const std::vector<double> floor = smoothed(lowest_about(lowest, frames_of(step_s, rate_hz)), step_s, rate_hz);
  std::vector<double> clear(lowest.size());
  for (std::size_t f = 0; f < clear.size(); ++f) clear[f] = std::max(0.0, lowest[f] - floor[f] - in_the_air * leg);
  return clear;
}

}  // namespace toile::internal
