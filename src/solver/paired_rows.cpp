#include "solver/paired_rows.hpp"

#include "core/parallel.hpp"

namespace toile {

void PairedRows::arrange(const BlockPattern& pattern, Index begin, Index middle, Index end) {
  begin_ = begin, middle_ = middle, end_ = end;
  row_begin_.assign(1, 0);
  column_.clear();
  slot_.clear();
  for (Index k = 0; k < end - middle; ++k) {
    const std::array<Index, 2> row = {begin + k, middle + k}, strip_end = {middle, end};
    std::array<Slot, 2> next = {pattern.first_slot(row[0]), pattern.first_slot(row[1])};
    while (true) {
      PairedColumn column{};
      std::array<Slot, 2> slot{};
      for (std::size_t strip = 0; strip < 2; ++strip) {
        const bool has = next[strip] < pattern.end_slot(row[strip]) && pattern.column(next[strip]) < strip_end[strip];
        column.offset[strip] = 4 * (has ? pattern.column(next[strip]) : row[strip]);
        slot[strip] = has ? next[strip]++ : -1;
      }
      if (slot[0] < 0 && slot[1] < 0) break;
      column_.push_back(column);
      slot_.push_back(slot);
    }
    row_begin_.push_back(static_cast<std::int32_t>(slot_.size()));
  }
  block_.assign(slot_.size(), PairedBlock{});
}

void PairedRows::copy(const BlockMatrix<float>& A) {
  constexpr std::size_t grain = 4096;
  parallel_for(slot_.size(), grain, [&](std::size_t n) {
    for (std::size_t strip = 0; strip < 2; ++strip) {
      if (slot_[n][strip] < 0) continue;                     // stays zero
      const Block<float>& below = A.below(slot_[n][strip]);  // its columns are the rows of the block above the diagonal
      block_[n].row[0][strip] = below.c0;
      block_[n].row[1][strip] = below.c1;
      block_[n].row[2][strip] = below.c2;
    }
  });
}

StripPair PairedRows::strips() const {
  return {{begin_, middle_}, end_ - middle_, middle_ - begin_ > end_ - middle_,
          row_begin_.data(), column_.data(), block_.data()};
}

}  // namespace toile
