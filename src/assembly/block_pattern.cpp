#include "assembly/block_pattern.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <numeric>

namespace toile::internal {
namespace {

constexpr double own_is_enough = 1.25;  // of the bandwidth of the best order found

}  // namespace

BlockPattern::BlockPattern(Index particle_count, std::vector<std::pair<Index, Index>> links) {
  for (auto& [a, b] : links) {
    if (a > b) std::swap(a, b);
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  row_begin_.assign(static_cast<std::size_t>(particle_count) + 1, 0);
  column_.reserve(links.size());
  for (const auto& [a, b] : links) {
    if (a == b) continue;
    ++row_begin_[static_cast<std::size_t>(a) + 1];
    column_.push_back(b);
  }
  for (std::size_t i = 1; i < row_begin_.size(); ++i) row_begin_[i] += row_begin_[i - 1];

  above_begin_.assign(row_begin_.size(), 0);
  for (const Index j : column_) ++above_begin_[static_cast<std::size_t>(j) + 1];
  for (std::size_t i = 1; i < above_begin_.size(); ++i) above_begin_[i] += above_begin_[i - 1];
  above_.resize(column_.size());
  std::vector<std::int32_t> next(above_begin_.begin(), above_begin_.end() - 1);
  for (Index i = 0; i < rows(); ++i) {
    for (Slot s = first_slot(i); s < end_slot(i); ++s)
      above_[static_cast<std::size_t>(next[static_cast<std::size_t>(column(s))]++)] = {i, s};
  }
  find_pieces();
  find_places();
}

template <class Work>
void BlockPattern::for_neighbours(Index row, const Work& work) const {
  for (const Above& above : this->above(row)) work(above.row);
  for (Slot s = first_slot(row); s < end_slot(row); ++s) work(column(s));
}

void BlockPattern::find_pieces() {
  piece_.assign(static_cast<std::size_t>(rows()), -1);
  std::vector<Index> reached;
  const auto reach = [&](Index i) {
    if (piece_[static_cast<std::size_t>(i)] >= 0) return;
    piece_[static_cast<std::size_t>(i)] = static_cast<Index>(piece_size_.size()) - 1;
    ++piece_size_.back();
    reached.push_back(i);
  };
  for (Index start = 0; start < rows(); ++start) {
    if (piece(start) >= 0) continue;
    piece_size_.push_back(0);
    reach(start);
    while (!reached.empty()) {
      const Index i = reached.back();
      reached.pop_back();
      for_neighbours(i, reach);
    }
  }
}

// From a row at the rim of a piece: neighbours of the rows ordered so far, those with few blocks first.            [Cuthill & McKee 1969]
// The rim: a pseudo-peripheral row, by breadth-first searches that each start where the last one ended.            [George & Liu 1979]
void BlockPattern::find_places() {
  const auto n = static_cast<std::size_t>(rows());
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> blocks(n), seen(n, -1), level, next, around;
  for (Index i = 0; i < rows(); ++i)
    blocks[at(i)] = static_cast<Index>(above(i).size()) + static_cast<Index>(end_slot(i) - first_slot(i));
  const auto fewer = [&](Index a, Index b) {
    return blocks[at(a)] != blocks[at(b)] ? blocks[at(a)] < blocks[at(b)] : a < b;
  };
  Index search = 0;
  // The number of levels of the breadth-first search from `start`, and the row of the last level with the fewest blocks.
  const auto farthest = [&](Index start) {
    ++search;
    level.assign(1, start);
    seen[at(start)] = search;
    int levels = 0;
    Index last = start;
    while (!level.empty()) {
      ++levels;
      last = *std::min_element(level.begin(), level.end(), fewer);
      next.clear();
      for (const Index i : level) {
        for_neighbours(i, [&](Index j) {
          if (seen[at(j)] == search) return;
          seen[at(j)] = search;
          next.push_back(j);
        });
      }
      std::swap(level, next);
    }
    return std::pair(levels, last);
  };
  place_.assign(n, -1);
  row_at_.clear();
  row_at_.reserve(n);
  const auto put = [&](Index i) {
    place_[at(i)] = static_cast<Index>(row_at_.size());
    row_at_.push_back(i);
  };
  for (Index first = 0; first < rows(); ++first) {
    if (place_[at(first)] >= 0) continue;
    Index start = first;
    for (auto [levels, last] = farthest(start); last != start;) {
      start = last;
      const auto [more, beyond] = farthest(start);
      if (more <= levels) break;
      levels = more;
      last = beyond;
    }
    std::size_t done = row_at_.size();
    put(start);
    for (; done < row_at_.size(); ++done) {
      around.clear();
      for_neighbours(row_at_[done], [&](Index j) {
        if (place_[at(j)] < 0) around.push_back(j);
      });
      std::sort(around.begin(), around.end(), fewer);
      for (const Index j : around) put(j);
    }
  }
  std::reverse(row_at_.begin(), row_at_.end());
  const auto bandwidth = [&](const auto& place_of) {
    Index widest = 0;
    for (Index i = 0; i < rows(); ++i)
      for_neighbours(i, [&](Index j) { widest = std::max(widest, place_of(j) - place_of(i)); });
    return widest;
  };
  // The mesh's own order, if it is hardly worse: arrays in that order are then read in sequence.
  bandwidth_ = bandwidth([&](Index i) { return place(i); });
  const Index own = bandwidth([](Index i) { return i; });
  if (static_cast<double>(own) <= own_is_enough * static_cast<double>(bandwidth_)) {
    bandwidth_ = own;
    std::iota(row_at_.begin(), row_at_.end(), 0);
  }
  for (std::size_t p = 0; p < n; ++p) place_[at(row_at_[p])] = static_cast<Index>(p);
}

Slot BlockPattern::slot(Index row, Index column) const {
  const auto begin = column_.begin() + first_slot(row), end = column_.begin() + end_slot(row);
  const auto found = std::lower_bound(begin, end, column);
  TOILE_ASSERT(found != end && *found == column);
  return static_cast<Slot>(found - column_.begin());
}

BlockPattern pattern_of_cloth(Index particle_count, std::span<const Triangle> triangles,
                              std::span<const Hinge> hinges) {
  std::vector<std::pair<Index, Index>> links;
  links.reserve(3 * triangles.size() + hinges.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) links.emplace_back(t[k], t[(k + 1) % 3]);
  }
  for (const Hinge& hinge : hinges) links.emplace_back(hinge.particle[2], hinge.particle[3]);
  return {particle_count, std::move(links)};
}

}  // namespace toile::internal
