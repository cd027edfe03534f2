// core/disjoint_sets.hpp: disjoint sets (union-find); the smallest member represents its set, in whatever order sets are joined.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <numeric>

namespace toile::internal {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) { reset(count); }

  // 0 .. count-1, each a set of its own.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  Index find(Index i) {
    while (at(i) != i) i = at(i) = at(at(i));
    return i;
  }
  void join(Index a, Index b) {
    a = find(a);
    b = find(b);
    at(std::max(a, b)) = std::min(a, b);
  }

  // [i] find(i)
  std::vector<Index> representatives() {
    std::vector<Index> of(parent_.size());
    for (std::size_t i = 0; i < of.size(); ++i) of[i] = find(static_cast<Index>(i));
    return of;
  }

 private:
  Index& at(Index i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<Index> parent_;
};

}  // namespace toile::internal
