// solver/block_cholesky_kernels.hpp: the loops of solver/block_cholesky.hpp, compiled for each instruction set.
//
// Multiplications and additions are single and every element sums in one order, so that each set gives the same bits.
#pragma once
#include "core/types.hpp"

#include <cstddef>
#include <cstdint>

namespace toile::internal {

// U by rows of 9 x 9 blocks, each by rows; a row's first block is its diagonal one, of which the upper triangle counts, with the
// reciprocals of the pivots on its diagonal: 0 where a direction is dead.
struct BlockFactor {
  std::size_t blocks;
  const std::int32_t* row_begin;  // [row], and the end of the last
  const Index* column;            // [slot]
  const double* value;            // [slot] 81 numbers
};

// Of the `count` blocks of a row, rows of the remaining matrix become rows of U; pivots below `least` are dead.
void finish_row(double* blocks, std::size_t count, double least);
// C -= A^T B
void subtract_product(const double* A, const double* B, double* C);
// x <- (U^T U)^-1 x, zero where a direction is dead
void substitute_blocks(const BlockFactor& factor, double* x);

}  // namespace toile::internal
