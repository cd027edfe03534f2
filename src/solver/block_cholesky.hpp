// solver/block_cholesky.hpp: E = U^T U of a symmetric matrix of 9 x 9 blocks of which most are empty.
//
// Aggregates are numbered by the cuts that made them, so that neighbours have near numbers: blocks that fill up stay few, as in nested
// dissection.  Which do is found by elimination on the blocks alone, anew when other blocks are coupled.      [George & Liu 1981, 5]
#pragma once
#include "core/types.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

class BlockCholesky {
 public:
  static constexpr std::size_t side = 9;

  // `couples`: pairs (p, q), p < q < blocks, in any order, also twice, whose block is not empty.  All entries become zero.
  void begin(Index blocks, std::span<const std::pair<Index, Index>> couples);
  // Of a couple, or p = q: rows of p, columns of q, by rows.
  double* block(Index p, Index q) { return &value_[offset(p, q)]; }

  // After all blocks are set.  A pivot that is nothing beside the largest (1e-9) is struck out: nothing moves in its direction.
  void factorise();
  // x <- E^-1 x, zero in what was struck out.
  void solve(std::span<double> x) const;

  std::size_t stored_blocks() const { return column_.size(); }

 private:
  void eliminate();
  std::size_t offset(Index p, Index q) const { return static_cast<std::size_t>(slot_[index(p, q)]) * side * side; }
  std::size_t index(Index p, Index q) const {
    return static_cast<std::size_t>(p) * static_cast<std::size_t>(blocks_) + static_cast<std::size_t>(q);
  }

  Index blocks_ = 0;
  std::vector<std::uint8_t> coupled_, was_coupled_;  // [p][q]
  std::vector<std::int32_t> row_begin_;              // [p], and the end of the last
  std::vector<Index> column_;                        // [slot] ascending in a row, the diagonal first
  std::vector<std::int32_t> slot_;                   // [p][q] of U
  std::vector<double> value_;                        // [slot] side * side each: of E, then of U
};

}  // namespace toile::internal
