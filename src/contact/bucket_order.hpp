// contact/bucket_order.hpp: sorts keys (first, second) by counting the firsts; linear where few share a first.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace toile {

// order: indices into `keys` such that the keys ascend; equal keys keep the order they came in.
// offsets[f] .. offsets[f + 1]: where in `order` the keys with first = f stand; `first_count` + 1 entries.
inline void bucket_order(std::span<const std::pair<Index, Index>> keys, std::size_t first_count,
                         std::vector<Index>& offsets, std::vector<Index>& order) {
  offsets.assign(first_count + 2, 0);
  for (const auto& key : keys) ++offsets[static_cast<std::size_t>(key.first) + 2];
  for (std::size_t f = 2; f < offsets.size(); ++f) offsets[f] += offsets[f - 1];
  order.resize(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    order[static_cast<std::size_t>(offsets[static_cast<std::size_t>(keys[i].first) + 1]++)] = static_cast<Index>(i);
  }
  offsets.pop_back();
  for (std::size_t f = 0; f < first_count; ++f) {
    std::sort(order.begin() + offsets[f], order.begin() + offsets[f + 1], [&](Index i, Index j) {
      const Index a = keys[static_cast<std::size_t>(i)].second, b = keys[static_cast<std::size_t>(j)].second;
      return a != b ? a < b : i < j;
    });
  }
}

}  // namespace toile
