// verify/stillness.hpp: does the cloth rest?  How far it came in the last second.
//
//   v_i = max over the frames k of the last T of |x_i - x_i(k)| / T,      x_i: now;      reported: the p99 over i, mm/s
//   steady motion with speed v: v          to and fro by A: at most 2 A / T          docs/theory/verify.md#rest
//
// Easily got wrong: the speed from one frame to the next is no measure of rest.  It multiplies the rounding of float32, and a
// trembling too small to be seen, by the frames per second; that is jitter, and measured as such (verify/jitter.hpp).
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// Frames are fed in their order; those of the last T are kept as the files hold them, in float32.
class StillnessMeter {
 public:
  explicit StillnessMeter(double fps = 30, double window_s = 1);

  // The same frames, seen over another T.
  void set_window(double fps, double window_s);
  // Throws InputError if there are other vertices than in the frames before.
  void add(std::span<const Vec3> x);
  // A frame that cannot be measured: no window reaches over it.
  void skip() { frames_.clear(); }

  // Whether the frames reach back over all of T.
  bool full() const { return count() > window_; }
  bool empty() const { return frames_.empty(); }
  // Over T, or over the frames there are; 0 with fewer than two.
  double speed_p99_mm_per_s() const;

  template <class Archive>
  void remember(Archive& archive) {
    archive(frames_, frame_size_);
  }

 private:
  std::size_t count() const { return frame_size_ == 0 ? 0 : frames_.size() / frame_size_; }

  double fps_ = 30;
  std::size_t window_ = 30;  // frames
  std::uint64_t frame_size_ = 0;
  std::vector<float> frames_;  // (x, y, z) of the vertices of each, the newest last
};

}  // namespace toile::internal
