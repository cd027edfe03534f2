// The places of rows: an order of all of them, narrow whatever the numbers of the particles are.
#include "assembly/block_pattern.hpp"

#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace toile::internal {
namespace {

using Links = std::vector<std::pair<Index, Index>>;

// A grid of width x height with diagonals, numbered row by row and then by `number`.
Links grid(Index width, Index height, const std::vector<Index>& number, Index first = 0) {
  Links links;
  const auto at = [&](Index x, Index y) { return number[static_cast<std::size_t>(first + y * width + x)]; };
  for (Index y = 0; y < height; ++y) {
    for (Index x = 0; x < width; ++x) {
      if (x + 1 < width) links.emplace_back(at(x, y), at(x + 1, y));
      if (y + 1 < height) links.emplace_back(at(x, y), at(x, y + 1));
      if (x + 1 < width && y + 1 < height) links.emplace_back(at(x, y), at(x + 1, y + 1));
    }
  }
  return links;
}

std::vector<Index> in_order(Index n) {
  std::vector<Index> number(static_cast<std::size_t>(n));
  std::iota(number.begin(), number.end(), 0);
  return number;
}

std::vector<Index> shuffled(Index n) {
  std::vector<Index> number = in_order(n);
  test::Random random(3);
  for (std::size_t k = number.size(); k-- > 1;)
    std::swap(
        number[k],
        number[std::min(k, static_cast<std::size_t>((0.5 + random.vector(0.5).x()) * static_cast<double>(k + 1)))]);
  return number;
}

// Every row has one place, and `bandwidth` is what it says.
void expect_an_order(const BlockPattern& pattern, const Links& links) {
  std::vector<bool> taken(static_cast<std::size_t>(pattern.rows()), false);
  for (Index i = 0; i < pattern.rows(); ++i) {
    const Index place = pattern.place(i);
    ASSERT_GE(place, 0);
    ASSERT_LT(place, pattern.rows());
    EXPECT_FALSE(taken[static_cast<std::size_t>(place)]) << i;
    taken[static_cast<std::size_t>(place)] = true;
    EXPECT_EQ(pattern.row_at(place), i);
  }
  Index widest = 0;
  for (const auto& [a, b] : links) widest = std::max(widest, std::abs(pattern.place(a) - pattern.place(b)));
  EXPECT_EQ(pattern.bandwidth(), widest);
}

TEST(BlockPattern, PutsRowsThatABlockCouplesNearEachOther) {
  for (const auto& [width, height] : {std::pair<Index, Index>(40, 30), {5, 200}, {200, 3}}) {
    const Links links = grid(width, height, shuffled(width * height));
    const BlockPattern pattern(width * height, links);
    expect_an_order(pattern, links);
    // No order is narrower than the shorter side.  Fronts from a corner are no longer than it, with the diagonals in the way twice.
    EXPECT_GE(pattern.bandwidth(), std::min(width, height));
    EXPECT_LE(pattern.bandwidth(), 2 * std::min(width, height) + 2);
  }
}

TEST(BlockPattern, KeepsAnOrderOfTheMeshThatIsNarrow) {
  const Links links = grid(20, 50, in_order(1000));
  const BlockPattern pattern(1000, links);
  expect_an_order(pattern, links);
  for (Index i = 0; i < 1000; ++i) EXPECT_EQ(pattern.place(i), i);
}

TEST(BlockPattern, GivesPiecesAndRowsWithoutBlocksPlacesToo) {
  const std::vector<Index> number = shuffled(700);
  Links links = grid(20, 15, number);
  const Links other = grid(10, 30, number, 300);  // and 100 rows that nothing couples
  links.insert(links.end(), other.begin(), other.end());
  const BlockPattern pattern(700, links);
  expect_an_order(pattern, links);
  EXPECT_EQ(pattern.piece_sizes().size(), 102u);
  EXPECT_LE(pattern.bandwidth(), 32);
  const BlockPattern nothing(0, {});
  EXPECT_EQ(nothing.bandwidth(), 0);
}

}  // namespace
}  // namespace toile::internal
