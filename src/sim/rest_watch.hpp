// sim/rest_watch.hpp: has cloth come to rest?  By the frames as the files hold them, as in the verdict.
#pragma once
#include "core/types.hpp"
#include "sim/report.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// The positions as in the files: float32.
Vec3s as_written(std::span<const Vec3> x);

// p99 of the particles' speeds, mm/s.
struct RestLimits {
  double half_a_second, a_second;  // at most, over the last
};
// When a drape may stop; the limit over a second is the verdict's.
inline constexpr RestLimits still{2, Limits{}.still_mm_per_s};

class RestWatch {
 public:
  void begin(std::span<const Vec3> x, double fps, const RestLimits& limits = still);
  void frame(std::span<const Vec3> x);
  bool at_rest() const;

  // The state of the frame is the owner's: call begin() with it, then read this.
  template <class Archive>
  void remember(Archive& archive) {
    archive(speeds_);
  }

 private:
  RestLimits limits_ = still;
  Vec3s before_;
  double fps_ = 30;
  std::vector<double> speeds_;  // p99 of each frame of the last second, mm/s
};

}  // namespace toile::internal
