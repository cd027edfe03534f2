#include "solver/strip_rows.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>

namespace toile::internal {
Index StripRows::time(Index place) const {
  return place - *(std::upper_bound(begin_.begin(), begin_.end(), place) - 1);
}

void StripRows::arrange(const BlockPattern& pattern, std::span<const Index, strips_at_once + 1> begin) {
  std::copy(begin.begin(), begin.end(), begin_.begin());
  row_begin_.assign(1, 0);
  column_.clear();
  source_.clear();
  const Index rows = begin[strips_at_once] - begin[strips_at_once - 1];
  for (std::size_t strip = 0; strip < strips_at_once; ++strip)
    TOILE_ASSERT(begin[strip + 1] - begin[strip] - rows <= 1 && begin[strip + 1] - begin[strip] >= rows);
  std::array<std::vector<std::pair<Index, Source>>, strips_at_once> blocks;
  for (Index k = 0; k < rows; ++k) {
    for (std::size_t strip = 0; strip < strips_at_once; ++strip) {
      const Index row = pattern.row_at(begin[strip] + k);
      blocks[strip].clear();
      const auto add = [&](Index column, Slot slot) {
        const Index place = pattern.place(column);
        if (place >= begin[0] && place < begin[strips_at_once] && time(place) > k)
          blocks[strip].push_back({place, {slot, column < row}});
      };
      for (Slot slot = pattern.first_slot(row); slot < pattern.end_slot(row); ++slot) add(pattern.column(slot), slot);
      for (const auto& above : pattern.above(row)) add(above.row, above.slot);
      std::sort(blocks[strip].begin(), blocks[strip].end(),
                [](const auto& a, const auto& b) { return a.first < b.first; });
    }
    pair_up(blocks, k);
    row_begin_.push_back(static_cast<std::int32_t>(source_.size()));
  }
  block_.assign(source_.size(), StripBlock{});
}

// Takes a block of each strip, as long as there are any.  Blocks of one group have different columns, because all add to them at once.
void StripRows::pair_up(std::span<std::vector<std::pair<Index, Source>>, strips_at_once> blocks, Index row) {
  const auto any = [](const auto& of_strip) { return !of_strip.empty(); };
  while (std::any_of(blocks.begin(), blocks.end(), any)) {
    StripColumn column{};
    std::array<Source, strips_at_once> source{};
    std::array<Index, strips_at_once> taken;
    taken.fill(-1);
    for (std::size_t strip = 0; strip < strips_at_once; ++strip) {
      const auto found = std::find_if(blocks[strip].begin(), blocks[strip].end(), [&](const auto& block) {
        return std::find(taken.begin(), taken.end(), block.first) == taken.end();
      });
      column.offset[strip] = 4 * (begin_[strip] + row);
      if (found == blocks[strip].end()) continue;
      taken[strip] = found->first;
      column.offset[strip] = 4 * found->first;
      source[strip] = found->second;
      blocks[strip].erase(found);
    }
    column_.push_back(column);
    source_.push_back(source);
  }
}

void StripRows::copy(const BlockMatrix<float>& A) {
  constexpr std::size_t grain = 1024;
  parallel_for(source_.size(), grain, [&](std::size_t n) {
    for (std::size_t strip = 0; strip < strips_at_once; ++strip) {
      const Source source = source_[n][strip];
      if (source.slot < 0) continue;
      const Block<float>& stored = A.below(source.slot);  // its columns are the rows of the block above the diagonal
      const Block<float> block = source.below_diagonal ? stored.transpose() : stored;
      block_[n].row[0][strip] = block.c0;
      block_[n].row[1][strip] = block.c1;
      block_[n].row[2][strip] = block.c2;
    }
  });
}

Strips StripRows::strips() const {
  Strips strips{};
  strips.rows = begin_[strips_at_once] - begin_[strips_at_once - 1];
  for (std::size_t strip = 0; strip < strips_at_once; ++strip) {
    strips.first[strip] = begin_[strip];
    if (begin_[strip + 1] - begin_[strip] > strips.rows) strips.longer = static_cast<int>(strip) + 1;
  }
  strips.begin = row_begin_.data();
  strips.column = column_.data();
  strips.block = block_.data();
  return strips;
}

// work(strip, p) for the rows of one time.
template <class Work>
void StripRows::for_rows_at(Index time, const Work& work) const {
  for (std::size_t strip = 0; strip < strips_at_once; ++strip)
    if (begin_[strip] + time < begin_[strip + 1]) work(strip, static_cast<std::size_t>(begin_[strip] + time));
}

// work(q, stored, transposed) for the blocks of the row p of a strip at a time: A_qp is the stored block, or its transpose.
template <class Work>
void StripRows::for_blocks(const BlockMatrix<double>& A, Index time, std::size_t strip, const Work& work) const {
  if (time + 1 >= static_cast<Index>(row_begin_.size()))
    return;  // the last row of a longer strip, which no other follows
  for (auto n = static_cast<std::size_t>(row_begin_[at(time)]); n < static_cast<std::size_t>(row_begin_[at(time) + 1]);
       ++n) {
    const Source source = source_[n][strip];
    if (source.slot < 0) continue;
    const Block<double>& below = A.below(source.slot);
    const auto q = static_cast<std::size_t>(column_[n].offset[strip] / 4);
    work(q, below, source.below_diagonal);
  }
}

void StripRows::forward(const BlockMatrix<float>&, Index begin, Index end, std::span<const Block<float>> G,
                        std::span<Lane<float>> s, std::span<Lane<float>> As) const {
  sweep_forward(strips(), begin, end, G.data(), s.data(), As.data());
}

void StripRows::backward(const BlockMatrix<float>&, Index begin, Index end, std::span<const Block<float>> G,
                         std::span<Lane<float>> s, std::span<Lane<float>> As) const {
  sweep_backward(strips(), begin, end, G.data(), s.data(), As.data());
}

void StripRows::forward(const BlockMatrix<double>& A, Index begin, Index end, std::span<const Block<double>> G,
                        std::span<Lane<double>> s, std::span<Lane<double>> As) const {
  using B = Block<double>;
  for (Index time = begin; time < end; ++time) {
    for_rows_at(time, [&](std::size_t strip, std::size_t p) {
      s[p] = G[p].times(As[p]);
      for_blocks(A, time, strip, [&](std::size_t q, const B& A_qp, bool transposed) {
        As[q] -= transposed ? A_qp.transpose_times(s[p]) : A_qp.times(s[p]);
      });
    });
  }
}

void StripRows::backward(const BlockMatrix<double>& A, Index begin, Index end, std::span<const Block<double>> G,
                         std::span<Lane<double>> s, std::span<Lane<double>> As) const {
  using B = Block<double>;
  for (Index time = end; time-- > begin;) {
    for_rows_at(time, [&](std::size_t strip, std::size_t p) {
      Lane<double> sum{0, 0, 0, 0};
      for_blocks(A, time, strip, [&](std::size_t q, const B& A_qp, bool transposed) {
        sum += transposed ? A_qp.times(s[q]) : A_qp.transpose_times(s[q]);
      });
      s[p] -= G[p].times(sum);
      for_blocks(A, time, strip, [&](std::size_t q, const B& A_qp, bool transposed) {
        As[q] += transposed ? A_qp.transpose_times(s[p]) : A_qp.times(s[p]);
      });
    });
  }
}

}  // namespace toile::internal
