// solver/block_cholesky.hpp: Cholesky factor E = U^T U of a sparse symmetric matrix of 9 x 9 blocks.
//
// Aggregates are numbered by the cuts that made them, so neighbours have near numbers and fill-in stays small, as in
// nested dissection.  A symbolic elimination on the blocks finds it, again when other blocks are coupled.
//                                                                                                [George & Liu 1981, 5]
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

  // `couples`: the pairs (p, q), p < q < blocks, of non-empty blocks, in any order, duplicates allowed.  Sets all
  // entries to zero.
  void begin(Index blocks, std::span<const std::pair<Index, Index>> couples);
  // The block of a couple, or of p = q: rows of p, columns of q, row by row.
  double* block(Index p, Index q) { return &value_[offset(p, q)]; }

  // Call after all blocks are set.  A pivot below 1e-9 of the largest is dropped: the solution is zero in its
  // direction.
  void factorise();
  // x <- E^-1 x, zero in dropped directions.
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
