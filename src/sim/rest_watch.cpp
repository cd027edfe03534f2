#include "sim/rest_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toile::internal {
namespace {

constexpr double rest_s = 0.5;

}  // namespace

// Through memory: in x.cast<float>().cast<double>() GCC 12 at -O3 leaves the last of an odd number of entries unrounded.
Vec3s as_written(std::span<const Vec3> x) {
  std::vector<float> single(3 * x.size());
  for (std::size_t i = 0; i < single.size(); ++i)
    single[i] = static_cast<float>(x[i / 3][static_cast<Eigen::Index>(i % 3)]);
  Vec3s rounded;
  rounded.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) rounded.emplace_back(single[3 * i], single[3 * i + 1], single[3 * i + 2]);
  return rounded;
}

void RestWatch::begin(std::span<const Vec3> x, double fps, const RestLimits& limits) {
  limits_ = limits;
  before_ = as_written(x);
  fps_ = fps;
}

void RestWatch::frame(std::span<const Vec3> x) {
  const Vec3s before = std::exchange(before_, as_written(x));
  speeds_.push_back(speed_p99_mm_per_s(before, before_, fps_));
  if (static_cast<double>(speeds_.size()) > std::max(1.0, std::round(fps_))) speeds_.erase(speeds_.begin());
}

bool RestWatch::at_rest() const {
  const auto recent = static_cast<std::size_t>(std::max(1.0, std::ceil(rest_s * fps_)));
  if (speeds_.size() < recent) return false;
  const auto within = [](double limit) { return [limit](double v) { return v <= limit; }; };
  return std::all_of(speeds_.begin(), speeds_.end(), within(limits_.a_second)) &&
         std::all_of(speeds_.end() - static_cast<std::ptrdiff_t>(recent), speeds_.end(), within(limits_.half_a_second));
}

}  // namespace toile::internal
