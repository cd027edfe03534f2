// verify/jitter.cpp: see the header.
#include "verify/jitter.hpp"

#include "core/parallel.hpp"
#include "verify/nearest_point.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toile::internal {
namespace {

// Differences of first order, then the filter's: together a fifth difference over 16.
constexpr std::array<double, 6> fifth_difference{-1, 5, -10, 10, -5, 1};

}  // namespace

JitterMeter::JitterMeter(std::vector<Triangle> body, double fps)
    : body_(std::move(body)), fps_(fps), histogram_(bins, 0) {}

void JitterMeter::add(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  if (!moving_ && consecutive_ > 0) {
    const Vec3s& before = body_x_[slot(frames_ + window - 1)];
    moving_ = !std::equal(before.begin(), before.end(), body_x.begin(), body_x.end());
    if (moving_) {
      consecutive_ = 1;
      worst_ = {};
      std::fill(histogram_.begin(), histogram_.end(), 0);
    }
  }
  x_[slot(frames_)].assign(x.begin(), x.end());
  body_x_[slot(frames_)].assign(body_x.begin(), body_x.end());
  ++frames_;
  if (++consecutive_ >= window) measure();
}

void JitterMeter::skip() {
  ++frames_;
  consecutive_ = 0;
}

// To the body in the middle frame of the window.
void JitterMeter::fit_tree() {
  const int frame = frames_ - window + middle;
  const Vec3s& x = body_x_[slot(frame)];
  if (!tree_) {
    tree_.emplace(body_, x);
  } else if (tree_frame_ != frame - 1 || x != body_x_[slot(frame - 1)]) {
    tree_->refit(body_, x);
  }
  tree_frame_ = frame;
}

void JitterMeter::measure() {
  const int first = frames_ - window;
  const Vec3s& x_middle = x_[slot(first + middle)];
  const Vec3s& body_middle = body_x_[slot(first + middle)];
  const bool has_body = !body_.empty();
  if (has_body) fit_tree();
  nearest_.resize(x_middle.size(), -1);
  speed_mm_per_s_.resize(x_middle.size());

  parallel_for(x_middle.size(), 256, [&](std::size_t i) {
    const auto corner = [&](Index t, std::size_t k) {
      return static_cast<std::size_t>(body_[static_cast<std::size_t>(t)][k]);
    };
    const auto squared_distance = [&](Index t) {
      return squared_distance_to_triangle(x_middle[i], body_middle[corner(t, 0)], body_middle[corner(t, 1)],
                                          body_middle[corner(t, 2)]);
    };
    if (has_body) {
      BoxTree::Nearest start{-1, jitter_reach_m * jitter_reach_m};
      if (nearest_[i] >= 0) {
        const double guess = squared_distance(nearest_[i]);
        if (guess < start.squared_distance) start = {nearest_[i], guess};
      }
      nearest_[i] = tree_->nearest(x_middle[i], start, squared_distance).triangle;
    }
    const Index t = nearest_[i];
    const Vec3 weights = t < 0 ? Vec3(0, 0, 0)
                               : nearest_weights(x_middle[i], body_middle[corner(t, 0)], body_middle[corner(t, 1)],
                                                 body_middle[corner(t, 2)]);
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < window; ++k) {
      Vec3 u = x_[slot(first + k)][i];
      const Vec3s& body_x = body_x_[slot(first + k)];
      if (t >= 0)
        for (int c = 0; c < 3; ++c) u -= weights[c] * body_x[corner(t, static_cast<std::size_t>(c))];
      sum += fifth_difference[static_cast<std::size_t>(k)] * u;
    }
    speed_mm_per_s_[i] = 1000 * fps_ / 16 * sum.norm();
  });

  ++worst_.windows;
  for (std::size_t i = 0; i < speed_mm_per_s_.size(); ++i) {
    const double speed = speed_mm_per_s_[i];
    const double bin = std::min(std::round(speed * bins_per_mm_per_s), static_cast<double>(bins - 1));
    ++histogram_[static_cast<std::size_t>(bin)];
    if (speed > worst_.max_mm_per_s || worst_.worst_vertex < 0) {
      worst_.max_mm_per_s = speed;
      worst_.worst_vertex = static_cast<Index>(i);
      worst_.worst_frame = first + middle;
    }
  }
}

JitterStatistics JitterMeter::statistics() const {
  std::int64_t count = 0;
  for (const std::int64_t n : histogram_) count += n;
  const auto percentile = [&](std::int64_t percent) {
    if (count == 0) return 0.0;
    const std::int64_t rank = (percent * count + 99) / 100;
    std::int64_t below = 0;
    for (std::size_t k = 0; k + 1 < bins; ++k) {
      below += histogram_[k];
      if (below >= rank) return std::min(static_cast<double>(k) / bins_per_mm_per_s, worst_.max_mm_per_s);
    }
    return worst_.max_mm_per_s;
  };
  JitterStatistics result = worst_;
  result.p50_mm_per_s = percentile(50);
  result.p99_mm_per_s = percentile(99);
  return result;
}

}  // namespace toile::internal
