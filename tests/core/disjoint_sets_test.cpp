#include "core/disjoint_sets.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

TEST(DisjointSets, TheSmallestStandsForAllWhateverTheOrder) {
  const std::vector<std::array<Index, 2>> pairs = {{5, 2}, {7, 8}, {2, 9}, {8, 1}, {3, 3}};
  const std::vector<Index> expected = {0, 1, 2, 3, 4, 2, 6, 1, 1, 2};
  DisjointSets forwards(10), backwards(10);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    forwards.join(pairs[k][0], pairs[k][1]);
    const auto& [a, b] = pairs[pairs.size() - 1 - k];
    backwards.join(b, a);
  }
  EXPECT_EQ(forwards.representatives(), expected);
  EXPECT_EQ(backwards.representatives(), expected);
  EXPECT_EQ(forwards.find(9), 2);
  forwards.reset(3);
  EXPECT_EQ(forwards.representatives(), (std::vector<Index>{0, 1, 2}));
}

}  // namespace
}  // namespace toile::internal
