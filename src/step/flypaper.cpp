#include "step/flypaper.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

constexpr double opposite = -0.5;   // n_1 . n_2
constexpr double begins_below = 2;  // r
constexpr double ends_above = 2.2;  // r
constexpr double parts_above = 1;   // r
constexpr double closes_by = 1e-3;  // r per step: less is rounding, or a narrow place that turns
constexpr std::size_t grain = 256;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

Flypaper::Flypaper(const BodySurface* body, std::size_t particles, double offset_m)
    : body_(body), offset_m_(offset_m), pinched_(particles, 0) {}

// How much nearer the two surfaces come to each other in the step.
double Flypaper::closing(const Pinch& pinch) const {
  double sum = 0;
  for (const BodyPoint& side : pinch.side) sum += side.normal.dot(body_->travel(side.triangle, side.barycentric));
  return sum;
}

bool Flypaper::goes_on(Pinch& pinch, const Vec3& x) const {
  for (BodyPoint& side : pinch.side) {
    const double reach = std::abs(side.gap_m) + 2 * (offset_m_ + farthest_travel_m_);
    side = body_->nearest_facing(x, side.normal, reach);
    if (side.triangle < 0) return false;
  }
  const double apart = pinch.side[0].gap_m + pinch.side[1].gap_m;
  if (apart > ends_above * offset_m_) return false;
  const bool outside = pinch.side[0].gap_m > 0 && pinch.side[1].gap_m > 0;
  return !(outside && apart > parts_above * offset_m_ && closing(pinch) < -closes_by * offset_m_);
}

bool Flypaper::begins(Pinch& pinch, const Vec3& x) const {
  const BodyPoint near = pinch.side[0];
  const double reach = begins_below * offset_m_ + 2 * farthest_travel_m_ - near.gap_m;
  if (near.gap_m < 0 || reach <= 0) return false;
  pinch.side[1] = body_->nearest_facing(x, -near.normal, reach);
  const BodyPoint& other = pinch.side[1];
  if (other.triangle < 0 || near.normal.dot(other.normal) >= opposite) return false;
  // Within it; or beside it, not over it: the way to it leads along it.
  if (other.gap_m < 0.5 * (x - body_->position(other.triangle, other.barycentric)).norm()) return false;
  const double closes = closing(pinch), apart = near.gap_m + other.gap_m;
  return closes > closes_by * offset_m_ && apart - closes < begins_below * offset_m_;
}

void Flypaper::detect(const ClothState& state, std::span<const BodyPoint> nearest) {
  if (!body_) return;
  double travel2 = 0;
  for (std::size_t v = 0; v < body_->positions().size(); ++v)
    travel2 = std::max(travel2, body_->vertex_travel(static_cast<Index>(v)).squaredNorm());
  farthest_travel_m_ = std::sqrt(travel2);
  was_.assign(pinched_.begin(), pinched_.end());  // what has just been let go of stays free for this step
  for (Pinch& pinch : pinches_) pinched_[at(pinch.particle)] = goes_on(pinch, state.x[at(pinch.particle)]) ? 1 : 0;
  const auto ended = [&](const Pinch& pinch) { return pinched_[at(pinch.particle)] == 0; };
  pinches_.erase(std::remove_if(pinches_.begin(), pinches_.end(), ended), pinches_.end());
  if (!(travel2 > 0)) return;  // nothing closes
  candidates_.clear();
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i].triangle < 0 || was_[i] != 0) continue;
    candidates_.push_back({static_cast<Index>(i), {nearest[i], {}}});
  }
  begun_.assign(candidates_.size(), 0);
  parallel_for(candidates_.size(), grain, [&](std::size_t k) {
    begun_[k] = begins(candidates_[k], state.x[at(candidates_[k].particle)]) ? 1 : 0;
  });
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (begun_[k] == 0) continue;
    pinched_[at(candidates_[k].particle)] = 1;
    pinches_.push_back(candidates_[k]);
  }
  std::sort(pinches_.begin(), pinches_.end(), [](const Pinch& a, const Pinch& b) { return a.particle < b.particle; });
}

void Flypaper::apply(const ClothState& state, const StepFormula& step, ParticleConstraints& constraints) const {
  for (const Pinch& pinch : pinches_) {
    if (!constraints.is_free(pinch.particle)) continue;
    const std::size_t i = at(pinch.particle);
    const auto& [one, two] = pinch.side;
    const Vec3 way =
        0.5 * (body_->travel(one.triangle, one.barycentric) + body_->travel(two.triangle, two.barycentric));
    constraints.hold(pinch.particle, (way - step.drift(pinch.particle)) / step.weight_s - state.v[i]);
  }
}

}  // namespace toile
