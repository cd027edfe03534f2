#include "step/penetration_recovery.hpp"

#include "core/parallel.hpp"

#include <algorithm>

namespace toile::internal {
namespace {

constexpr double farthest_in_m = 0.3;  // deeper than any limb
constexpr double out_in_s = 0.25, slowest_m_per_s = 0.1, fastest_m_per_s = 0.5;
constexpr double drag_per_s = 500;
constexpr std::size_t particle_grain = 64;

}  // namespace

void PenetrationRecovery::clear() {
  deep_.clear();
  any_ = false;
}

void PenetrationRecovery::detect(std::span<const Vec3> x, const BodyConstraints& constraints) {
  clear();
  if (!body_) return;
  const std::span<const BodyPoint> known = constraints.points();
  nearest_.resize(x.size());
  has_way_out_.assign(x.size(), 0);
  parallel_for(x.size(), particle_grain, [&](std::size_t i) {
    BodyPoint& near = nearest_[i];
    near = known[i].triangle < 0 ? body_->nearest(x[i], farthest_in_m) : known[i];
    if (near.triangle < 0 || !constraints.too_deep(near)) return;
    const Vec3 outside = x[i] + (constraints.offset_m(near) - near.gap_m) * near.normal;
    has_way_out_[i] =
        body_->winding_number(outside) > 0 ? 0 : 1;  // 0: the way out leads into another part, or parts overlap here
  });
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (nearest_[i].triangle < 0 || !constraints.too_deep(nearest_[i])) continue;
    any_ = true;
    if (has_way_out_[i] != 0) deep_.push_back({static_cast<Index>(i), nearest_[i]});
  }
  if (any_) return;
  // A particle in front of one part and within another: the nearest point does not show it.
  std::vector<char>& within = has_way_out_;
  parallel_for(x.size(), particle_grain, [&](std::size_t i) { within[i] = body_->winding_number(x[i]) > 0 ? 1 : 0; });
  any_ = std::find(within.begin(), within.end(), 1) != within.end();
}

void PenetrationRecovery::append_springs(std::vector<LinearSpring>& springs) const {
  for (const Deep& deep : deep_) {
    LinearSpring drag;
    drag.particle[0] = deep.particle;
    drag.weight[0] = 1;
    drag.direction = deep.point.normal;
    drag.damping_N_s_per_m = drag_per_s * model_->mass_kg[static_cast<std::size_t>(deep.particle)];
    drag.force_N = drag.damping_N_s_per_m * std::clamp(-deep.point.gap_m / out_in_s, slowest_m_per_s, fastest_m_per_s);
    drag.body_displacement_m = deep.point.normal.dot(body_->travel(deep.point.triangle, deep.point.barycentric));
    springs.push_back(drag);
  }
}

}  // namespace toile::internal
