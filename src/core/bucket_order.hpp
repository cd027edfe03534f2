// core/bucket_order.hpp: sorts keys (first, second) by counting the firsts; linear where few share a first.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

// Keeps its memory between calls.
class BucketOrder {
 public:
  // Afterwards order() lists the indices of `keys` in ascending order of the keys; the sort is stable.
  void sort(std::span<const std::pair<Index, Index>> keys, std::size_t first_count) {
    // While filling, offsets_[f + 1] runs from the start of bucket f to its end, which is the start of the next.
    offsets_.assign(first_count + 2, 0);
    for (const auto& key : keys) ++offsets_[static_cast<std::size_t>(key.first) + 2];
    for (std::size_t f = 2; f < offsets_.size(); ++f) offsets_[f] += offsets_[f - 1];
    if (keys.size() > packed_.capacity()) {  // resize() alone would grow to the last record by one key, time and again
      packed_.reserve(2 * keys.size());
      order_.reserve(2 * keys.size());
    }
    packed_.resize(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const auto at = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(keys[i].first) + 1]++);
      packed_[at] = static_cast<std::uint64_t>(keys[i].second) << 32 | i;
    }
    order_.resize(keys.size());
    for (std::size_t f = 0; f < first_count; ++f) {
      const auto begin = packed_.begin() + offsets_[f], end = packed_.begin() + offsets_[f + 1];
      if (end - begin > 1) std::sort(begin, end);
    }
    for (std::size_t i = 0; i < keys.size(); ++i) order_[i] = static_cast<Index>(packed_[i] & 0xffffffffu);
  }
  std::span<const Index> order() const { return order_; }
  // The indices of the keys with this first number.
  std::span<const Index> bucket(std::size_t first) const {
    return order().subspan(static_cast<std::size_t>(offsets_[first]),
                           static_cast<std::size_t>(offsets_[first + 1] - offsets_[first]));
  }

 private:
  std::vector<Index> offsets_, order_;
  std::vector<std::uint64_t> packed_;  // second, index
};

}  // namespace toile::internal
