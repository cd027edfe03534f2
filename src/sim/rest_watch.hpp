// sim/rest_watch.hpp: has cloth come to rest?  By the frames as files hold them, which is what the verdict is about.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// What a reader of the files will see: float32.
Vec3s as_written(std::span<const Vec3> x);

class RestWatch {
 public:
  void begin(std::span<const Vec3> x, double fps);
  void frame(std::span<const Vec3> x);
  // For half a second, and slow for the last one, which is what the verdict asks.
  bool at_rest() const;

  // The frame itself is the owner's: begin() with it, then read this.
  template <class Archive>
  void remember(Archive& archive) {
    archive(speeds_);
  }

 private:
  Vec3s before_;
  double fps_ = 30;
  std::vector<double> speeds_;  // p99 of each frame of the last second, mm/s
};

}  // namespace toile::internal
