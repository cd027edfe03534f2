// sim/keyed.hpp: a value that changes in time by keys: straight from one to the next, at rest before the first and after the last.
#pragma once
#include "core/types.hpp"

#include <cstddef>
#include <vector>

namespace toile::internal {

template <class Value>
Value between(const Value& from, const Value& to, double share) {
  return (1 - share) * from + share * to;
}
// Another order of the same sum; its bits are those of runs that were made.
inline Vec2 between(const Vec2& from, const Vec2& to, double share) { return from + share * (to - from); }

// `keys` are not empty, and their times ascend.
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
