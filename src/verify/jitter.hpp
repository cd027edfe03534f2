// verify/jitter.hpp: how much the cloth trembles: the fast part of its velocity relative to the body.
//
//   u_k = x_k - b_k       over six frames, k = 0..5; b: the point of the body that is nearest in frame 2, followed
//   v_k = (u_{k+1} - u_k) fps,    w = (v_0 - 4 v_1 + 6 v_2 - 4 v_3 + v_4) / 16,    jitter = |w|, mm/s
//   gain of the filter:  sin^4(pi f / fps), one half at 0.318 fps: 9.5 Hz at 30 frames per second
//   response to u = A cos(2 pi f t):  |w| up to 2 A fps sin^5(pi f / fps)                docs/theory/verify.md#jitter
//
// Easily got wrong: motion with the body is no jitter, so b is one material point over all six frames, not the nearest
// of each: that one jumps from triangle to triangle.  Only its position is subtracted, not its triangle's rotation:
// that is slow, but the noise of a small triangle times a lever of centimetres is not.
#pragma once
#include "core/types.hpp"
#include "verify/box_tree.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace toile::internal {

// Cloth farther from the body than this is not carried by it: its velocity is taken as it is.
constexpr double jitter_reach_m = 0.05;

// Over all vertices and all windows of six frames.
struct JitterStatistics {
  int windows = 0;  // 0: fewer than six frames, not measured
  double p50_mm_per_s = 0, p99_mm_per_s = 0, max_mm_per_s = 0;
  Index worst_vertex = -1;
  int worst_frame = -1;  // frame 2 of the window of max, counted from the first frame added
};

// Frames are fed in their order.  Memory does not grow with them: six frames and a histogram in steps of 0.1 mm/s are
// kept, so percentiles (nearest rank) are rounded to that; max is not.
//
// A body that begins to move ends the drape: earlier measurements are dropped, and the last frame in which it
// stood is the first of the motion.  A body that never moves is measured from the first frame on.
class JitterMeter {
 public:
  // Indices of `body` must be in range of the positions that will be given; it may be empty.  fps > 0.
  JitterMeter(std::vector<Triangle> body, double fps);

  // Finite positions, as many each time.
  void add(std::span<const Vec3> x, std::span<const Vec3> body_x);
  // A frame that cannot be measured: no window reaches over it.
  void skip();

  JitterStatistics statistics() const;

 private:
  static constexpr int window = 6, middle = 2;
  static constexpr double bins_per_mm_per_s = 10;
  static constexpr std::size_t bins = 20001;  // up to 2 m/s; beyond, a percentile is reported as max

  std::size_t slot(int frame) const { return static_cast<std::size_t>(frame % window); }
  void fit_tree();
  void measure();

  std::vector<Triangle> body_;
  double fps_;
  bool moving_ = false;
  int frames_ = 0, consecutive_ = 0;  // added or skipped; finite in a row, or since the body moves
  std::array<Vec3s, window> x_, body_x_;
  std::optional<BoxTree> tree_;
  int tree_frame_ = -1;
  std::vector<Index> nearest_;  // triangle of the window before, a guess; -1: none within reach
  std::vector<double> speed_mm_per_s_;
  std::vector<std::int64_t> histogram_;
  JitterStatistics worst_;  // windows and max so far
};

}  // namespace toile::internal
