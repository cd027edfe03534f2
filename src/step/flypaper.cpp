#include "step/flypaper.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double begins_below = 2;                    // r
constexpr double ends_above = 2.2;                    // r
constexpr double parts_above = 1;                     // r
constexpr double room_above = 0.5, room_again = 0.6;  // r
constexpr double closes_by = 1e-3;                    // r per step: less is rounding, or a narrow place that turns
constexpr std::size_t flypaper_grain = 256;

}  // namespace

Flypaper::Flypaper(const BodySurface* body, std::size_t particles, BodyContactOptions contact)
    : body_(body), contact_(std::move(contact)), pinched_(particles, Pinched::no) {}

// The closing distance of the two surfaces in the step; 0 for a rigid motion.
double Flypaper::closing(const Pinch& pinch) const {
  const auto& [one, two] = pinch.side;
  const Vec3 relative = body_->travel(one.triangle, one.barycentric) - body_->travel(two.triangle, two.barycentric);
  return 0.5 * (one.normal - two.normal).dot(relative);
}

bool Flypaper::has_room(const Pinch& pinch) const {
  const double least = std::min(pinch.apart(), pinch.apart() - closing(pinch));
  return pinch.outside() && least >= (pinch.room ? room_above : room_again) * offset_m(pinch);
}

bool Flypaper::goes_on(Pinch& pinch, const Vec3& x) const {
  for (BodyPoint& side : pinch.side) {
    const double own = std::abs(side.gap_m) + 2 * offset_m(side), reach = own + 2 * body_->travel_near(x, own);
    side = body_->nearest_facing(x, side.normal, reach);
    if (side.triangle < 0) return false;
  }
  const double r = offset_m(pinch);
  if (pinch.apart() > ends_above * r || pinch.side[0].normal.dot(pinch.side[1].normal) > 0) return false;
  if (pinch.outside() && pinch.apart() > parts_above * r && closing(pinch) < -closes_by * r) return false;
  pinch.room = has_room(pinch);
  return true;
}

bool Flypaper::begins(Pinch& pinch, const Vec3& x) const {
  const BodyPoint near = pinch.side[0];
  const double travel = body_->travel(near.triangle, near.barycentric).norm();
  const double widest = 0.5 * (offset_m(near) + contact_.largest_offset_m());
  const double own = begins_below * widest + travel - near.gap_m;
  if (near.gap_m < 0) return false;
  const double reach = own + body_->travel_near(x, std::max(own, 0.0));
  if (reach <= 0) return false;
  pinch.side[1] = body_->nearest_opposite(x, near.normal, reach);
  const BodyPoint& other = pinch.side[1];
  // Within the face; or beside it, not over it: the direction to it is along it.
  if (other.triangle < 0 || other.gap_m < 0.5 * (x - body_->position(other.triangle, other.barycentric)).norm())
    return false;
  const double closes = closing(pinch), r = offset_m(pinch);
  if (closes <= closes_by * r || pinch.apart() - closes >= begins_below * r) return false;
  pinch.room = has_room(pinch);
  return true;
}

void Flypaper::detect(const ClothState& state, std::span<const BodyPoint> nearest) {
  if (!body_) return;
  const auto start = body_->positions(), end = body_->next_positions();
  was_.assign(pinched_.begin(), pinched_.end());  // a particle that has just been released stays free for this step
  candidates_.clear();
  for (Pinch& pinch : pinches_)
    if (goes_on(pinch, state.x[at(pinch.particle)])) candidates_.push_back(pinch);
  pinches_.swap(candidates_);
  if (!std::equal(start.begin(), start.end(), end.begin())) {  // else no pinch closes
    candidates_.clear();
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      if (nearest[i].triangle < 0 || was_[i] != Pinched::no) continue;
      candidates_.push_back({static_cast<Index>(i), {nearest[i], {}}});
    }
    begun_.assign(candidates_.size(), 0);
    parallel_for(candidates_.size(), flypaper_grain, [&](std::size_t k) {
      begun_[k] = begins(candidates_[k], state.x[at(candidates_[k].particle)]) ? 1 : 0;
    });
    for (std::size_t k = 0; k < candidates_.size(); ++k)
      if (begun_[k] != 0) pinches_.push_back(candidates_[k]);
    std::sort(pinches_.begin(), pinches_.end(), [](const Pinch& a, const Pinch& b) { return a.particle < b.particle; });
  }
  any_without_room_ = false;
  std::fill(pinched_.begin(), pinched_.end(), Pinched::no);
  for (const Pinch& pinch : pinches_) {
    pinched_[at(pinch.particle)] = pinch.room ? Pinched::with_room : Pinched::without_room;
    any_without_room_ |= !pinch.room;
  }
  steps_without_room_ += any_without_room_ ? 1 : 0;
}

void Flypaper::apply(const ClothState& state, const StepFormula& step, ParticleConstraints& constraints) const {
  for (const Pinch& pinch : pinches_) {
    if (!constraints.is_free(pinch.particle)) continue;
    const std::size_t i = at(pinch.particle);
    const auto& [one, two] = pinch.side;
    const double s = pinch.room ? one.gap_m / pinch.apart() : 0.5;
    const Vec3 way =
        (1 - s) * body_->travel(one.triangle, one.barycentric) + s * body_->travel(two.triangle, two.barycentric);
    constraints.hold(pinch.particle, (way - step.drift(pinch.particle)) / step.weight_s - state.v[i]);
  }
}

}  // namespace toile::internal
