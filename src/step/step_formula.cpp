#include "step/step_formula.hpp"

namespace toile::internal {
namespace {

constexpr double largest_ratio = 2.4;  // of two steps: beyond 1 + sqrt 2 BDF2 is not zero-stable

}  // namespace

void MotionHistory::remember(const ClothState& start, const ClothState& end, std::span<const Vec3> moved, double h_s) {
  h_s_ = h_s;
  moved_.assign(moved.begin(), moved.end());
  dv_.resize(moved.size());
  for (std::size_t i = 0; i < dv_.size(); ++i) dv_[i] = end.v[i] - start.v[i];
  end_ = end;
}

void MotionHistory::check(const ClothState& state) {
  if (h_s_ > 0 && (state.x != end_.x || state.v != end_.v)) forget();
}

StepFormula MotionHistory::formula(double h_s) {
  drift_.clear();
  kick_.clear();
  if (h_s_ <= 0 || h_s > largest_ratio * h_s_) return h_s;
  const double w = h_s / h_s_, beta = w * w / (1 + 2 * w);
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    drift_.push_back(beta * moved_[i]);
    kick_.push_back(beta * dv_[i]);
  }
  return {h_s, h_s * (1 + w) / (1 + 2 * w), drift_};
}

}  // namespace toile::internal
