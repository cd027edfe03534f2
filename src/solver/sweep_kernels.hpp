// solver/sweep_kernels.hpp: the inner loops of the iteration, for vector registers of any width.
//
// Compiled once for each instruction set that the compiler knows, chosen when the program runs.  No fused multiply-add,
// and sums in one order, four lanes of three numbers each: every set gives the same bits.
#pragma once
#include "assembly/lane.hpp"

#include <cstddef>
#include <cstdint>

namespace toile::internal {

// The number of strips swept in parallel: lanes of each fill the widest registers.
constexpr std::size_t strips_at_once = 4;

// A block of a row of each strip: the rows of its A_ij, j later than i, in lanes, each padded by a zero.
struct alignas(64) StripBlock {
  Lane<float> row[3][strips_at_once];
};
struct StripColumn {
  std::int32_t offset[strips_at_once];  // of the floats of place j, for each strip
};

// Strips of rows.  Row k of each is swept at the same time: no block couples these rows, and the four columns of a
// StripColumn differ.
struct Strips {
  Index first[strips_at_once];  // place of row 0
  Index rows;                   // of every strip
  int longer;                   // strips 0 ... longer - 1 have one more row
  const std::int32_t* begin;    // [row] of its blocks, and the end of the last
  const StripColumn* column;
  const StripBlock* block;
};

// Rows of times [begin, end), forward or backward, of (D + L) D^-1 (D + U) s = r and As = (L + D + U) s, with G = D^-1
// and U the blocks of rows with later ones.  As is r before.  Vectors begin with place 0.
void sweep_forward(const Strips& strips, Index begin, Index end, const Block<float>* G, Lane<float>* s,
                   Lane<float>* As);
void sweep_backward(const Strips& strips, Index begin, Index end, const Block<float>* G, Lane<float>* s,
                    Lane<float>* As);

// y of the coarse directions (solver/coarse_space.hpp), and the tables to make A' Z y and Z y from it.
struct CoarseColumns {
  const std::int32_t* entry_begin;  // [place], and the end of the last
  const Index* aggregate;           // [entry]; the first of a place is its own
  const Lane<float>*column, *y;     // A' Z [entry][9], y [aggregate][9] in all lanes
};
// t += Zy and At += A' Z y of places [begin, end).  Vectors begin with place 0.
void add_coarse_columns(const CoarseColumns& coarse, Index begin, Index end, const Lane<float>* Zy, Lane<float>* t,
                        Lane<float>* At);

}  // namespace toile::internal
