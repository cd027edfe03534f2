// solver/strip_rows.hpp: a copy of the blocks inside a domain, in the order in which sweep_kernels.hpp walks through them.
//
// The domain is cut into strips of consecutive particles, and row k of every strip is swept at the same time k.  A block of two rows
// belongs to the earlier one, whichever strips they are in; of two rows of one time none can wait for the other, and their block is
// left out.  Rows with fewer blocks are padded by zeros.  A copy, because who writes the matrix and who multiplies by it want it row
// by row; it is made once for every change of A, and read in every iteration.
#pragma once
#include "assembly/block_matrix.hpp"
#include "solver/sweep_kernels.hpp"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace toile {

class StripRows {
 public:
  // Strip s has the rows [begin[s], begin[s + 1]); as many as the last one, or one more.
  void arrange(const BlockPattern& pattern, std::span<const Index, strips_at_once + 1> begin);
  void copy(const BlockMatrix<float>& A);

  // When a row of the domain is swept.
  Index time(Index row) const;
  Strips strips() const;

 private:
  struct Source {
    Slot slot = -1;  // none: stays zero
    bool below_diagonal = false;
  };
  void pair_up(std::span<std::vector<std::pair<Index, Source>>, strips_at_once> blocks, Index row);

  std::array<Index, strips_at_once + 1> begin_{};
  std::vector<std::int32_t> row_begin_;
  std::vector<StripColumn> column_;
  std::vector<std::array<Source, strips_at_once>> source_;
  std::vector<StripBlock> block_;
};

}  // namespace toile
