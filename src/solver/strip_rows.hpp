// solver/strip_rows.hpp: a copy of the blocks inside a domain, in the order in which sweep_kernels.hpp walks through them.
//
// The domain is cut into strips of consecutive places, and row k of every strip is swept at the same time k.  A block of two rows
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
  // Strip s has the rows of the places [begin[s], begin[s + 1]); as many as the last one, or one more.
  void arrange(const BlockPattern& pattern, std::span<const Index, strips_at_once + 1> begin);
  void copy(const BlockMatrix<float>& A);

  // When the row of a place of the domain is swept.
  Index time(Index place) const;
  Strips strips() const;

  // The same without a copy, one after the other.  work(place) for the rows of one time:
  template <class Work>
  void for_rows_at(Index time, const Work& work) const {
    for (std::size_t strip = 0; strip < strips_at_once; ++strip)
      if (begin_[strip] + time < begin_[strip + 1]) work(begin_[strip] + time);
  }
  // work(q, A_qp, A_pq) for the blocks of a place p with later ones of the domain.
  template <class T, class Work>
  void for_later(const BlockMatrix<T>& A, Index p, const Work& work) const {
    const BlockPattern& pattern = A.pattern();
    const Index row = pattern.row_at(p), own_time = time(p);
    const auto add = [&](Index q, Slot slot, bool below_diagonal) {
      if (q < begin_.front() || q >= begin_.back() || time(q) <= own_time) return;
      const Block<T>& below = A.below(slot);
      if (below_diagonal) {
        work(q, below.transpose(), below);
      } else {
        work(q, below, below.transpose());
      }
    };
    for (Slot slot = pattern.first_slot(row); slot < pattern.end_slot(row); ++slot)
      add(pattern.place(pattern.column(slot)), slot, false);
    for (const auto& above : pattern.above(row)) add(pattern.place(above.row), above.slot, true);
  }

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
