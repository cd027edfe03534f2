// solver/sweep_kernels.hpp: what the iteration spends its time in, for vector registers of any width.
//
// Compiled once for each instruction set that the compiler knows, chosen when the program runs.  Multiplications and additions are
// single and in one order, four lanes of three numbers each, so that every set gives the same bits.
#pragma once
#include "assembly/lane.hpp"

#include <cstddef>
#include <cstdint>

namespace toile {

// The blocks of two rows, one of each strip:  the rows of A_ij, j > i, beside those of A_i'j', each padded by a zero.
struct alignas(32) PairedBlock {
  Lane<float> row[3][2];
};
struct PairedColumn {
  std::int32_t offset[2];  // of the floats of particles j and j'
};

// Two strips of rows, no block between them, so that row k of one is swept beside row k of the other.
struct StripPair {
  Index first[2];              // particle of row 0
  Index pairs;                 // rows that both have
  bool single;                 // strip 0 has one more
  const std::int32_t* begin;   // [row] of its blocks, and the end of the last
  const PairedColumn* column;  // ascending in a row
  const PairedBlock* block;
};

// (D + L) D^-1 (D + U) s = r and As = (L + D + U) s on both strips, with G = D^-1.  Vectors begin with particle 0.
void sweep_strips(const StripPair& strips, const Block<float>* G, const Lane<float>* r, Lane<float>* s,
                  Lane<float>* As);

// A' Z, sparse (solver/coarse_space.hpp), and y of the coarse directions, each in all lanes.
struct CoarseColumns {
  const std::int32_t* entry_begin;  // [particle], and the end of the last
  const Index* aggregate;           // [entry]
  const Lane<float>*column, *y;     // [entry][9], [aggregate][9]
};
// sum += A' Z y of particles [begin, end).  `sum` begins with particle 0.
void add_coarse_columns(const CoarseColumns& coarse, Index begin, Index end, Lane<float>* sum);

}  // namespace toile
