// solver/strip_rows.hpp: a copy of the blocks of a domain, in the order in which sweep_kernels.hpp traverses them.
//
// The domain is cut into strips of consecutive places, and row k of every strip is swept at the same time k.  A block
// of two rows belongs to the earlier one, whichever strips they are in.  Two rows of one time cannot wait for each
// other, and their block is left out.  Rows with fewer blocks are padded by zeros.  It is a copy because assembly and
// products need the matrix row by row; it is made once for every change of A, and read in every iteration.
#pragma once
#include "assembly/block_matrix.hpp"
#include "solver/sweep_kernels.hpp"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

class StripRows {
 public:
  // Strip s has the rows of the places [begin[s], begin[s + 1]): as many rows as the last strip, or one more.
  void arrange(const BlockPattern& pattern, std::span<const Index, strips_at_once + 1> begin);
  void copy(const BlockMatrix<float>& A);

  // The time at which the row of a place of the domain is swept.
  Index time(Index place) const;
  Strips strips() const;

  // Sweeps the rows of times [begin, end) with the blocks held here, as in sweep_kernels.hpp, with G and vectors from
  // place 0 on.  In double from A itself, row by row as in textbooks.
  void forward(const BlockMatrix<float>& A, Index begin, Index end, std::span<const Block<float>> G,
               std::span<Lane<float>> s, std::span<Lane<float>> As) const;
  void backward(const BlockMatrix<float>& A, Index begin, Index end, std::span<const Block<float>> G,
                std::span<Lane<float>> s, std::span<Lane<float>> As) const;
  void forward(const BlockMatrix<double>& A, Index begin, Index end, std::span<const Block<double>> G,
               std::span<Lane<double>> s, std::span<Lane<double>> As) const;
  void backward(const BlockMatrix<double>& A, Index begin, Index end, std::span<const Block<double>> G,
                std::span<Lane<double>> s, std::span<Lane<double>> As) const;

 private:
  struct Source {
    Slot slot = -1;  // none: stays zero
    bool below_diagonal = false;
  };
  template <class Work>
  void for_rows_at(Index time, const Work& work) const;
  template <class Work>
  void for_blocks(const BlockMatrix<double>& A, Index time, std::size_t strip, const Work& work) const;
  void pair_up(std::span<std::vector<std::pair<Index, Source>>, strips_at_once> blocks, Index row);

  std::array<Index, strips_at_once + 1> begin_{};
  std::vector<std::int32_t> row_begin_;
  std::vector<StripColumn> column_;
  std::vector<std::array<Source, strips_at_once>> source_;
  std::vector<StripBlock> block_;
};

}  // namespace toile::internal
