#include "assembly/block_kernels.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "assembly/block_kernels.cpp"
#include <hwy/foreach_target.h>
// After it.
#include <hwy/highway.h>

// Registers that the baseline instruction set lacks are passed between inlined functions only, so no ABI is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

HWY_BEFORE_NAMESPACE();
namespace toile::internal::HWY_NAMESPACE {
namespace {

// Three numbers and one unused; the compiler splits them into the registers of the instruction set.
using Four [[gnu::vector_size(32)]] = double;
using Floats = Lane<float>;

HWY_INLINE Four three(const double* p) { return Four{p[0], p[1], p[2], 0}; }
HWY_INLINE Four four(const double* p) {
  Four v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
HWY_INLINE Four wide(const Floats& a) { return __builtin_convertvector(a, Four); }
HWY_INLINE void store(const Four& a, double* to) {
  to[0] = a[0];
  to[1] = a[1];
  to[2] = a[2];
}

// The rows of a block; the padding of each is that of the last column.
HWY_INLINE void rows_of(const Floats& c0, const Floats& c1, const Floats& c2, Floats& r0, Floats& r1, Floats& r2) {
  const Floats low = __builtin_shufflevector(c0, c1, 0, 4, 1, 5), high = __builtin_shufflevector(c0, c1, 2, 6, 3, 7);
  r0 = __builtin_shufflevector(low, c2, 0, 1, 4, 7);
  r1 = __builtin_shufflevector(low, c2, 2, 3, 5, 7);
  r2 = __builtin_shufflevector(high, c2, 0, 1, 6, 7);
}

void multiply_rows(const BlockRows& A, Index begin, Index end, const Vec3* x, Vec3* of_rows) {
  const BlockPattern& pattern = *A.pattern;
  for (Index i = begin; i < end; ++i) {
    const double* x_i = x[i].data();
    const double* G = A.grounded[i].data();
    Four sum = (three(G) * x_i[0] + three(G + 3) * x_i[1]) + three(G + 6) * x_i[2];
    for (const auto& above : pattern.above(i)) {
      const Block<float>& L = A.below[above.slot];
      const double* x_j = x[above.row].data();
      sum += (wide(L.c0) * (x_j[0] - x_i[0]) + wide(L.c1) * (x_j[1] - x_i[1])) + wide(L.c2) * (x_j[2] - x_i[2]);
    }
    for (Slot s = pattern.first_slot(i); s < pattern.end_slot(i); ++s) {
      const Block<float>& L = A.below[s];
      const double* x_j = x[pattern.column(s)].data();
      Floats r0, r1, r2;
      rows_of(L.c0, L.c1, L.c2, r0, r1, r2);
      sum += (wide(r0) * (x_j[0] - x_i[0]) + wide(r1) * (x_j[1] - x_i[1])) + wide(r2) * (x_j[2] - x_i[2]);
    }
    store(sum, of_rows[i - begin].data());
  }
}

void sum_diagonals(const BlockRows& A, Index begin, Index end, Mat3* of_rows) {
  const BlockPattern& pattern = *A.pattern;
  for (Index i = begin; i < end; ++i) {
    const double* G = A.grounded[i].data();
    Four d0 = three(G), d1 = three(G + 3), d2 = three(G + 6);
    for (const auto& above : pattern.above(i)) {
      const Block<float>& L = A.below[above.slot];
      d0 -= wide(L.c0);
      d1 -= wide(L.c1);
      d2 -= wide(L.c2);
    }
    for (Slot s = pattern.first_slot(i); s < pattern.end_slot(i); ++s) {
      Floats r0, r1, r2;
      rows_of(A.below[s].c0, A.below[s].c1, A.below[s].c2, r0, r1, r2);
      d0 -= wide(r0);
      d1 -= wide(r1);
      d2 -= wide(r2);
    }
    double* D = of_rows[i - begin].data();
    store(d0, D);
    store(d1, D + 3);
    store(d2, D + 6);
  }
}

void gather(const BlockParts& parts, Slot begin, Slot end, const Mat3* membranes, const BendResponse* bends,
            const double* weight, Block<float>* below) {
  for (Slot s = begin; s < end; ++s) {
    Four c0{0, 0, 0, 0}, c1 = c0, c2 = c0;  // of the block above the diagonal
    for (auto k = parts.triangle_begin[s]; k < parts.triangle_begin[s + 1]; ++k) {
      const auto [triangle, pair] = parts.triangles[k];
      const double* block = membranes[3 * static_cast<std::size_t>(triangle) + pair].data();
      c0 += four(block);
      c1 += four(block + 3);
      c2 += four(block + 6);
    }
    for (auto k = parts.hinge_begin[s]; k < parts.hinge_begin[s + 1]; ++k) {
      const auto [hinge, a, b] = parts.hinges[k];
      const double* g_b = bends[hinge].g[b].data();
      const Four row = three(bends[hinge].g[a].data()) * weight[hinge];
      c0 += row * g_b[0];
      c1 += row * g_b[1];
      c2 += row * g_b[2];
    }
    const Floats zero{0, 0, 0, 0};
    Floats r0, r1, r2;
    rows_of(__builtin_convertvector(c0, Floats), __builtin_convertvector(c1, Floats),
            __builtin_shufflevector(__builtin_convertvector(c2, Floats), zero, 0, 1, 2, 7), r0, r1, r2);
    below[s] = {r0, r1, r2};
  }
}

}  // namespace
}  // namespace toile::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace toile::internal {
namespace {
HWY_EXPORT(multiply_rows);
HWY_EXPORT(sum_diagonals);
HWY_EXPORT(gather);
}  // namespace

void multiply_block_rows(const BlockRows& A, Index begin, Index end, const Vec3* x, Vec3* of_rows) {
  HWY_DYNAMIC_DISPATCH(multiply_rows)(A, begin, end, x, of_rows);
}

void sum_block_diagonals(const BlockRows& A, Index begin, Index end, Mat3* of_rows) {
  HWY_DYNAMIC_DISPATCH(sum_diagonals)(A, begin, end, of_rows);
}

void gather_blocks(const BlockParts& parts, Slot begin, Slot end, const Mat3* membranes, const BendResponse* bends,
                   const double* weight, Block<float>* below) {
  HWY_DYNAMIC_DISPATCH(gather)(parts, begin, end, membranes, bends, weight, below);
}

}  // namespace toile::internal
#endif
