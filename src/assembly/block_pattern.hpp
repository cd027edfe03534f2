// assembly/block_pattern.hpp: the sparsity pattern of a symmetric block matrix, and an order of its rows for locality.
#pragma once
#include "mesh/topology.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

using Slot = std::int32_t;  // position of a block in the value array

class BlockPattern {
 public:
  // `links` are unordered particle pairs that share an element; duplicates are fine.
  BlockPattern(Index particle_count, std::vector<std::pair<Index, Index>> links);

  Index rows() const { return static_cast<Index>(row_begin_.size()) - 1; }
  Slot block_count() const { return static_cast<Slot>(column_.size()); }
  Slot first_slot(Index row) const { return row_begin_[static_cast<std::size_t>(row)]; }
  Slot end_slot(Index row) const { return row_begin_[static_cast<std::size_t>(row) + 1]; }
  Index column(Slot slot) const { return column_[static_cast<std::size_t>(slot)]; }
  Slot slot(Index row, Index column) const;  // row < column; asserts that the block exists
  // The stored blocks of column i, rows ascending: with row i, all that a gather over the whole matrix needs.
  struct Above {
    Index row;
    Slot slot;
  };
  std::span<const Above> above(Index i) const {
    const auto first = static_cast<std::size_t>(above_begin_[static_cast<std::size_t>(i)]);
    return {above_.data() + first, static_cast<std::size_t>(above_begin_[static_cast<std::size_t>(i) + 1]) - first};
  }
  // The number of the connected piece of cloth of each particle, from 0.
  Index piece(Index row) const { return piece_[static_cast<std::size_t>(row)]; }
  std::span<const Index> piece_sizes() const { return piece_size_; }

  // An order of the rows in which coupled rows are near each other, whatever the numbering of the mesh: a loop over it
  // finds its neighbours in the cache, and cutting a sweep into parts cuts few blocks (solver/sweep_domains.hpp).
  Index place(Index row) const { return place_[static_cast<std::size_t>(row)]; }
  Index row_at(Index place) const { return row_at_[static_cast<std::size_t>(place)]; }
  Index bandwidth() const { return bandwidth_; }  // the largest distance of the places of two coupled rows

 private:
  void find_pieces();
  void find_places();
  template <class Work>
  void for_neighbours(Index row, const Work& work) const;

  std::vector<Slot> row_begin_;
  std::vector<Index> column_;
  std::vector<std::int32_t> above_begin_;
  std::vector<Above> above_;
  std::vector<Index> piece_, piece_size_;
  std::vector<Index> place_, row_at_;
  Index bandwidth_ = 0;
};

// The links of cloth elements: corners of a triangle, and the two corners across a hinge.
BlockPattern pattern_of_cloth(Index particle_count, std::span<const Triangle> triangles, std::span<const Hinge> hinges);

}  // namespace toile::internal
