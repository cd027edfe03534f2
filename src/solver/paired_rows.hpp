// solver/paired_rows.hpp: a copy of the blocks inside two strips, in the order in which sweep_kernels.hpp walks through them.
//
// The shorter of two rows is padded by blocks of zeros.  A copy, because who writes the matrix and who multiplies by it want it row by
// row; it is made once for every change of A, and read in every iteration.
#pragma once
#include "assembly/block_matrix.hpp"
#include "solver/sweep_kernels.hpp"

#include <array>
#include <vector>

namespace toile {

class PairedRows {
 public:
  // Strips [begin, middle) and [middle, end); the first is as long as the second, or one longer.
  void arrange(const BlockPattern& pattern, Index begin, Index middle, Index end);
  void copy(const BlockMatrix<float>& A);

  StripPair strips() const;

 private:
  Index begin_ = 0, middle_ = 0, end_ = 0;
  std::vector<std::int32_t> row_begin_;
  std::vector<PairedColumn> column_;
  std::vector<std::array<Slot, 2>> slot_;  // -1: none
  std::vector<PairedBlock> block_;
};

}  // namespace toile
