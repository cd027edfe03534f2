// sim/rest_watch.hpp: has cloth come to rest?  By the frames as files hold them, which is what the verdict is about.
#pragma once
#include "core/types.hpp"
#include "sim/report.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// What a reader of the files will see: float32.
Vec3s as_written(std::span<const Vec3> x);

// p99 of the particles' speeds, mm/s.
struct RestLimits {
  double half_a_second, a_second;  // at most, over the last
};
// When a drape may stop; over a second it is what the verdict asks.
inline constexpr RestLimits still{2, Limits{}.still_mm_per_s};

class RestWatch {
 public:
  void begin(std::span<const Vec3> x, double fps, const RestLimits& limits = still);
  void frame(std::span<const Vec3> x);
  bool at_rest() const;

  // The frame itself is the owner's: begin() with it, then read this.
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
