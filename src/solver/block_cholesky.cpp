#include "solver/block_cholesky.hpp"

#include "core/parallel.hpp"
#include "solver/block_cholesky_kernels.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr std::size_t entries = BlockCholesky::side * BlockCholesky::side;
constexpr double nothing = 1e-9;               // of the largest diagonal element
constexpr std::size_t shared_from = 12;        // blocks in a row, from which on its products are worth several threads
constexpr std::size_t products_per_block = 4;  // rows of blocks

}  // namespace

void BlockCholesky::begin(Index blocks, std::span<const std::pair<Index, Index>> couples) {
  const auto n = static_cast<std::size_t>(blocks);
  if (blocks != blocks_) {
    blocks_ = blocks;
    was_coupled_.clear();
    slot_.assign(n * n, -1);
  }
  coupled_.assign(n * n, 0);
  for (const auto& [p, q] : couples) coupled_[index(p, q)] = 1;
  if (coupled_ != was_coupled_) {
    was_coupled_ = coupled_;
    eliminate();
  }
  std::fill(value_.begin(), value_.end(), 0.0);
}

// Row p of U couples every two of its columns.
void BlockCholesky::eliminate() {
  const auto n = static_cast<std::size_t>(blocks_);
  std::fill(slot_.begin(), slot_.end(), -1);
  row_begin_.assign(1, 0);
  column_.clear();
  for (std::size_t p = 0; p < n; ++p) {
    slot_[p * n + p] = static_cast<std::int32_t>(column_.size());
    column_.push_back(static_cast<Index>(p));
    const std::size_t first = column_.size();
    for (std::size_t q = p + 1; q < n; ++q) {
      if (!coupled_[p * n + q]) continue;
      slot_[p * n + q] = static_cast<std::int32_t>(column_.size());
      column_.push_back(static_cast<Index>(q));
    }
    for (std::size_t a = first; a < column_.size(); ++a) {
      for (std::size_t b = a + 1; b < column_.size(); ++b) coupled_[index(column_[a], column_[b])] = 1;
    }
    row_begin_.push_back(static_cast<std::int32_t>(column_.size()));
  }
  value_.resize(column_.size() * entries);
}

void BlockCholesky::factorise() {
  double largest = 0;
  for (Index p = 0; p < blocks_; ++p) {
    for (std::size_t k = 0; k < side; ++k) largest = std::max(largest, block(p, p)[k * side + k]);
  }
  for (std::size_t p = 0; p < static_cast<std::size_t>(blocks_); ++p) {
    const auto begin = static_cast<std::size_t>(row_begin_[p]), end = static_cast<std::size_t>(row_begin_[p + 1]);
    double* row = &value_[begin * entries];
    finish_row(row, end - begin, nothing * largest);
    // Eliminates this row from the rows of its columns.
    const std::size_t columns = end - begin - 1;
    const auto subtract = [&](std::size_t a) {
      const Index q = column_[begin + 1 + a];
      for (std::size_t b = a; b < columns; ++b)
        subtract_product(row + (1 + a) * entries, row + (1 + b) * entries, block(q, column_[begin + 1 + b]));
    };
    if (columns < shared_from) {
      for (std::size_t a = 0; a < columns; ++a) subtract(a);
    } else {
      parallel_for(columns, products_per_block, subtract);
    }
  }
}

void BlockCholesky::solve(std::span<double> x) const {
  substitute_blocks({static_cast<std::size_t>(blocks_), row_begin_.data(), column_.data(), value_.data()}, x.data());
}

}  // namespace toile::internal
