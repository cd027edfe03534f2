#include "dress/rigid_path.hpp"

#include "garment/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::internal {

// The convention of a panel's rotation, by the same code.
Mat3 rotation_from_degrees(const Vec3& rotation_deg) {
  Panel panel;
  panel.rotation_deg = rotation_deg;
  return panel.rotation();
}

RigidKey RigidPath::at(double t_s) const {
  if (t_s <= keys_.front().t_s) return keys_.front();
  for (std::size_t k = 1; k < keys_.size(); ++k) {
    const RigidKey &from = keys_[k - 1], &to = keys_[k];
    if (t_s > to.t_s) continue;
    const double s = (t_s - from.t_s) / (to.t_s - from.t_s), r = 1 - s;
    return {t_s, r * from.shift_m + s * to.shift_m, r * from.rotation_deg + s * to.rotation_deg,
            r * from.scale + s * to.scale};
  }
  return keys_.back();
}

// d/dt (shift + s R r) is at most |shift'| + (|s'| + s |omega|) |r|, and omega at most the sum of the three angles' rates.
RigidPath::Fastest RigidPath::fastest(double reach_m) const {
  Fastest most;
  for (std::size_t k = 1; k < keys_.size(); ++k) {
    const RigidKey &from = keys_[k - 1], &to = keys_[k];
    const double turn = std::numbers::pi / 180 * (to.rotation_deg - from.rotation_deg).lpNorm<1>(),
                 size = std::max(from.scale, to.scale), growth = std::abs(to.scale - from.scale);
    const double m_per_s =
        ((to.shift_m - from.shift_m).norm() + (growth + size * turn) * reach_m) / (to.t_s - from.t_s);
    if (m_per_s > most.m_per_s) most = {k, m_per_s};
  }
  return most;
}

void RigidPath::place(double t_s, std::span<const Vec3> x, std::span<Vec3> placed) const {
  if (keys_.empty()) {
    std::copy(x.begin(), x.end(), placed.begin());
    return;
  }
  const RigidKey key = at(t_s);
  const Mat3 turn = key.scale * rotation_from_degrees(key.rotation_deg);
  const Vec3 to = centre_ + key.shift_m;
  for (std::size_t i = 0; i < x.size(); ++i) placed[i] = to + turn * (x[i] - centre_);
}

Vec3 RigidPath::before(double t_s, const Vec3& x) const {
  if (keys_.empty()) return x;
  const RigidKey key = at(t_s);
  return centre_ + rotation_from_degrees(key.rotation_deg).transpose() * (x - centre_ - key.shift_m) / key.scale;
}

Vec3 RigidPath::place(double t_s, const Vec3& x) const {
  Vec3 placed;
  place(t_s, std::span(&x, 1), std::span(&placed, 1));
  return placed;
}

}  // namespace toile::internal
