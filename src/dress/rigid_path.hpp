// dress/rigid_path.hpp: the keyframed motion of a solid or of pins: shift, rotation and scale about a point.
//
//   x(t) = c + shift(t) + scale(t) R(t) (x_0 - c),   R = Rz Ry Rx
// All numbers are linear between keys, angles too, so that 720 degrees are two turns, and constant before the first key
// and after the last.
#pragma once
#include "core/types.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

// The speed limit of keyframed motion: contacts are found on straight motions within a step.
inline constexpr double most_led_m_per_s = 100;

struct RigidKey {
  double t_s = 0;
  Vec3 shift_m{0, 0, 0};
  Vec3 rotation_deg{0, 0, 0};
  double scale = 1;
};

// Exact at multiples of 90 degrees.
Mat3 rotation_from_degrees(const Vec3& rotation_deg);

class RigidPath {
 public:
  RigidPath() = default;  // no motion
  // Keys in ascending order of time.
  RigidPath(std::vector<RigidKey> keys, const Vec3& centre) : keys_(std::move(keys)), centre_(centre) {}

  bool empty() const { return keys_.empty(); }
  const std::vector<RigidKey>& keys() const { return keys_; }
  std::vector<RigidKey>& keys() { return keys_; }
  const Vec3& centre() const { return centre_; }
  Vec3& centre() { return centre_; }
  double duration_s() const { return keys_.empty() ? 0 : keys_.back().t_s; }

  // The fastest interval, by the key at its end: no point within `reach_m` of the centre at the start is faster in it.
  struct Fastest {
    std::size_t key = 0;
    double m_per_s = 0;
  };
  Fastest fastest(double reach_m) const;

  // Maps points `x` at the start of the motion to t_s; a whole surface at once, or a point.
  void place(double t_s, std::span<const Vec3> x, std::span<Vec3> placed) const;
  Vec3 place(double t_s, const Vec3& x) const;
  // The inverse of place(t_s, .).
  Vec3 before(double t_s, const Vec3& x) const;

 private:
  RigidKey at(double t_s) const;

  std::vector<RigidKey> keys_;
  Vec3 centre_{0, 0, 0};
};

}  // namespace toile::internal
