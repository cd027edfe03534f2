// assembly/block_kernels.hpp: gathers over blocks in double, compiled for each instruction set.
//
// No fused multiply-add, four numbers at a time, in one order: the same bits on every set.
#pragma once
#include "assembly/block_matrix.hpp"
#include "material/bend.hpp"
#include "material/membrane_batch.hpp"

namespace toile::internal {

// Rows [begin, end) of A x, with x of all rows.
void multiply_block_rows(const BlockRows& A, Index begin, Index end, const Vec3* x, Vec3* of_rows);
// A_ii = G_i - sum_j L_ij of rows [begin, end).
void sum_block_diagonals(const BlockRows& A, Index begin, Index end, Mat3* of_rows);

// The elements that add to each block, in the order of summation (assembly/elements.hpp).
struct BlockParts {
  struct OfTriangle {
    Index triangle;
    std::uint8_t pair;  // of corners: material/membrane_batch.hpp
  };
  struct OfHinge {
    Index hinge;
    std::uint8_t a, b;  // rows and columns
  };
  const std::int32_t *triangle_begin, *hinge_begin;  // [slot], and the end of the last
  const OfTriangle* triangles;
  const OfHinge* hinges;
};

// The transposes of h D + h^2 K of slots [begin, end).  `weight` is (h^2 + h tau) kappa, per hinge.
// `membranes`: three per triangle; one number after the last is read and not used.
void gather_blocks(const BlockParts& parts, Slot begin, Slot end, const Mat3* membranes, const BendResponse* bends,
                   const double* weight, Block<float>* below);

}  // namespace toile::internal
