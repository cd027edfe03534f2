// dress/keyed.hpp: keyframed values: linear between keys, constant before the first and after the last.
#pragma once
#include "core/types.hpp"

#include <cstddef>
#include <vector>

namespace toile::internal {

// The keys of one value are in ascending order of time.
struct VectorKey {  // a position, m; gravity, m/s^2; wind, m/s
  double t_s = 0;
  Vec3 x{0, 0, 0};
};
struct FrictionKey {
  double t_s = 0, friction = 0;
};
struct RestStretchKey {  // a panel's (b_u, b_v): a cloth that shrinks while it is simulated
  double t_s = 0;
  Vec2 b{1, 1};
};
struct StiffnessKey {  // shares of the stretch, shear and bend of a panel's fabric
  double t_s = 0;
  Vec3 share{1, 1, 1};
};

inline constexpr double most_pressure_Pa = 1e5;  // an atmosphere
struct PressureKey {                             // on a panel, towards its right side
  double t_s = 0, Pa = 0;
};

template <class Value>
Value between(const Value& from, const Value& to, double share) {
  return (1 - share) * from + share * to;
}
// Not std::lerp: this order of the sum has the bits of existing runs.
inline Vec2 between(const Vec2& from, const Vec2& to, double share) { return from + share * (to - from); }

// `keys` are not empty.
template <class Key, class Value>
Value along(const std::vector<Key>& keys, Value Key::*value, double t_s) {
  if (t_s <= keys.front().t_s) return keys.front().*value;
  for (std::size_t k = 1; k < keys.size(); ++k) {
    if (t_s > keys[k].t_s) continue;
    return between(keys[k - 1].*value, keys[k].*value, (t_s - keys[k - 1].t_s) / (keys[k].t_s - keys[k - 1].t_s));
  }
  return keys.back().*value;
}

}  // namespace toile::internal
