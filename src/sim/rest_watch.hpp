// sim/rest_watch.hpp: has cloth come to rest?  By the frames as the files hold them, as in the verdict.
//
//   way of i = max over the frames k of the last half second of |x_i - x_i(k)|,      x_i: now
//
// Easily got wrong: the speed from frame to frame alone is no measure of rest.  A tremble of a tenth of a millimetre at 30 frames
// per second counts as 3 mm/s and goes nowhere; a creep of 3 mm/s is what a drape must wait for.
#pragma once
#include "core/types.hpp"
#include "sim/report.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::internal {

// The positions as in the files: float32.
Vec3s as_written(std::span<const Vec3> x);

// At most, of 99 % of the particles.
struct RestLimits {
  double way_mm;          // in half a second
  double speed_mm_per_s;  // from frame to frame, over the last second
};
// When a drape may stop; the speed is the verdict's.
inline constexpr RestLimits still{1, Limits{}.still_mm_per_s};

class RestWatch {
 public:
  // Of a cloth that has not been watched before, or of one that remember() has brought back: then `x` is ignored.
  void begin(std::span<const Vec3> x, double fps, const RestLimits& limits = still);
  void frame(std::span<const Vec3> x);
  bool at_rest() const;

  template <class Archive>
  void remember(Archive& archive) {
    archive(speeds_, frames_, frame_size_);
  }

 private:
  std::size_t frames_kept() const { return frame_size_ == 0 ? 0 : frames_.size() / frame_size_; }
  void keep(std::span<const Vec3> x);
  Vec3s newest() const;
  double way_p99_mm() const;

  RestLimits limits_ = still;
  double fps_ = 30;
  std::size_t half_a_second_ = 15;  // frames
  std::vector<double> speeds_;      // p99 of each frame of the last second, mm/s
  std::uint64_t frame_size_ = 0;
  std::vector<float> frames_;  // (x, y, z) of the particles in each frame of the last half second, the newest last
};

}  // namespace toile::internal
