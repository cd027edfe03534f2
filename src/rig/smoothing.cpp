#include "rig/smoothing.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

// Of half the time, at least one.
std::size_t reach_of(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::max(1.0, std::round(0.5 * seconds * rate_hz)));
}

std::vector<double> mean_about(std::span<const double> values, std::size_t reach) {
  std::vector<double> sums(values.size() + 1, 0), mean(values.size());
  for (std::size_t f = 0; f < values.size(); ++f) sums[f + 1] = sums[f] + values[f];
  for (std::size_t f = 0; f < values.size(); ++f) {
    // As far to both sides, so that a slope stays one at the ends.
    const std::size_t near = std::min({reach, f, values.size() - 1 - f});
    mean[f] = (sums[f + near + 1] - sums[f - near]) / static_cast<double>(2 * near + 1);
  }
  return mean;
}

}  // namespace

std::vector<double> smoothed(std::span<const double> values, double seconds, double rate_hz) {
  const std::size_t reach = reach_of(seconds, rate_hz);
  return mean_about(mean_about(values, reach), reach);
}

std::vector<double> smoothed_above(std::span<const double> least, double seconds, double rate_hz, bool loops) {
  const std::size_t count = least.size(), reach = reach_of(seconds, rate_hz);
  std::vector<double>
      long_enough;  // of one that loops: the round before and after, without the pose that is there twice
  const std::size_t round = count - 1, rounds = loops && count > 1 ? (2 * reach + round - 1) / round : 0;
  const std::size_t padding = rounds * round;
  for (std::size_t f = 0; f < count + 2 * padding; ++f) long_enough.push_back(least[padding > 0 ? f % round : f]);
  std::vector<double> most(long_enough.size());
  for (std::size_t f = 0; f < most.size(); ++f) {
    const std::size_t first = f > 2 * reach ? f - 2 * reach : 0, end = std::min(f + 2 * reach + 1, most.size());
    most[f] = *std::max_element(long_enough.begin() + static_cast<std::ptrdiff_t>(first),
                                long_enough.begin() + static_cast<std::ptrdiff_t>(end));
  }
  const std::vector<double> smooth = smoothed(most, seconds, rate_hz);
  const auto begin = smooth.begin() + static_cast<std::ptrdiff_t>(padding);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace toile::internal
