#include "verify/stillness.hpp"

#include "core/error.hpp"
#include "verify/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::internal {

StillnessMeter::StillnessMeter(double fps, double window_s) { set_window(fps, window_s); }

void StillnessMeter::set_window(double fps, double window_s) {
  fps_ = fps;
  window_ = static_cast<std::size_t>(std::clamp(std::round(window_s * fps), 1.0, 1e9));
}

void StillnessMeter::add(std::span<const Vec3> x) {
  if (frames_.empty()) frame_size_ = 3 * x.size();
  if (frame_size_ != 3 * x.size())
    throw InputError("cloth", "vertices of the frame before", std::to_string(frame_size_ / 3),
                     std::to_string(x.size()));
  if (full()) frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(frame_size_));
  for (const Vec3& p : x)
    for (const double c : p) frames_.push_back(static_cast<float>(c));
}

double StillnessMeter::speed_p99_mm_per_s() const {
  const std::size_t frames = count();
  if (frames < 2) return 0;
  const float* now = &frames_[(frames - 1) * frame_size_];
  std::vector<double> way(frame_size_ / 3);
  for (std::size_t k = 0; k + 1 < frames; ++k) {
    const float* then = &frames_[k * frame_size_];
    for (std::size_t i = 0; i < way.size(); ++i) {
      double square = 0;
      for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
        const double d = double{now[c]} - double{then[c]};
        square += d * d;
      }
      way[i] = std::max(way[i], square);
    }
  }
  return 1000 * std::sqrt(nearest_rank(way, 99)) * fps_ / static_cast<double>(frames - 1);
}

}  // namespace toile::internal
