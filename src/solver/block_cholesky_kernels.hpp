// solver/block_cholesky_kernels.hpp: the loops of solver/block_cholesky.hpp, compiled for each instruction set.
//
// No fused multiply-add, and a fixed order of sums: each instruction set gives the same bits.
#pragma once
#include "core/types.hpp"

#include <cstddef>
#include <cstdint>

namespace toile::internal {

// U by rows of 9 x 9 blocks, each stored by rows.  A row's first block is its diagonal one: its upper triangle, with
// the reciprocals of the pivots on the diagonal, 0 for a dropped direction.
struct BlockFactor {
  std::size_t blocks;
  const std::int32_t* row_begin;  // [row], and the end of the last
  const Index* column;            // [slot]
  const double* value;            // [slot] 81 numbers
};

// Turns the `count` blocks of a row of the remaining matrix into a row of U; pivots below `least` are dropped.
void finish_row(double* blocks, std::size_t count, double least);
// C -= A^T B
void subtract_product(const double* A, const double* B, double* C);
// x <- (U^T U)^-1 x, zero in dropped directions
void substitute_blocks(const BlockFactor& factor, double* x);

}  // namespace toile::internal
