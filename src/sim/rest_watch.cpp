#include "sim/rest_watch.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {

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
  fps_ = fps;
  half_a_second_ = static_cast<std::size_t>(std::max(1.0, std::ceil(0.5 * fps)));
  if (frames_.empty()) keep(x);
}

void RestWatch::frame(std::span<const Vec3> x) {
  const Vec3s before = newest();
  keep(x);
  speeds_.push_back(speed_p99_mm_per_s(before, newest(), fps_));
  if (static_cast<double>(speeds_.size()) > std::max(1.0, std::round(fps_))) speeds_.erase(speeds_.begin());
}

bool RestWatch::at_rest() const {
  const auto slow = [this](double speed) { return speed <= limits_.speed_mm_per_s; };
  return frames_kept() > half_a_second_ && std::all_of(speeds_.begin(), speeds_.end(), slow) &&
         way_p99_mm() <= limits_.way_mm;
}

void RestWatch::keep(std::span<const Vec3> x) {
  frame_size_ = 3 * x.size();
  if (frames_kept() > half_a_second_)
    frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(frame_size_));
  for (const Vec3& p : x)
    for (const double c : p) frames_.push_back(static_cast<float>(c));
}

Vec3s RestWatch::newest() const {
  Vec3s x;
  for (std::size_t k = frames_.size() - frame_size_; k < frames_.size(); k += 3)
    x.emplace_back(frames_[k], frames_[k + 1], frames_[k + 2]);
  return x;
}

double RestWatch::way_p99_mm() const {
  const Vec3s now = newest();
  std::vector<double> way(now.size());
  for (std::size_t k = 0; k < frames_.size(); k += 3) {
    const std::size_t i = k % frame_size_ / 3;
    way[i] = std::max(way[i], (now[i] - Vec3(frames_[k], frames_[k + 1], frames_[k + 2])).squaredNorm());
  }
  return 1000 * std::sqrt(nearest_rank(way, 99));
}

}  // namespace toile::internal
