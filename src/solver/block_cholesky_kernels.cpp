#include "solver/block_cholesky_kernels.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/block_cholesky_kernels.cpp"
#include <hwy/foreach_target.h>
// After it.
#include <hwy/highway.h>

// Registers that the baseline instruction set lacks are passed between inlined functions only, so no ABI is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

HWY_BEFORE_NAMESPACE();
namespace toile::internal::HWY_NAMESPACE {
namespace {

constexpr std::size_t side = 9, entries = side * side;

// Nine numbers: eight in a register, or in as many as the instruction set needs, and one.
using Eight [[gnu::vector_size(64)]] = double;
struct Nine {
  Eight most;
  double last;
};
HWY_INLINE Nine load(const double* from) {
  Nine v;
  __builtin_memcpy(&v.most, from, sizeof v.most);
  v.last = from[8];
  return v;
}
HWY_INLINE void store(const Nine& v, double* to) {
  __builtin_memcpy(to, &v.most, sizeof v.most);
  to[8] = v.last;
}
HWY_INLINE void subtract(Nine& from, double factor, const Nine& row) {
  from.most -= factor * row.most;
  from.last -= factor * row.last;
}

void finish(double* blocks, std::size_t count, double least) {
  for (std::size_t k = 0; k < side; ++k) {
    const double pivot = blocks[k * side + k];
    const double inverse = pivot > least ? 1 / std::sqrt(pivot) : 0;
    double factor[side];  // of row k in the elimination of the rows below it
    for (std::size_t i = k + 1; i < side; ++i) factor[i] = blocks[k * side + i] * inverse;
    for (std::size_t b = 0; b < count; ++b) {
      double* block = blocks + b * entries;
      Nine row = load(block + k * side);
      row.most *= inverse;
      row.last *= inverse;
      store(row, block + k * side);
      for (std::size_t i = k + 1; i < side; ++i) {
        Nine below = load(block + i * side);
        subtract(below, factor[i], row);
        store(below, block + i * side);
      }
    }
    blocks[k * side + k] = inverse;
  }
}

void product(const double* A, const double* B, double* C) {
  Nine row[side];
  for (std::size_t k = 0; k < side; ++k) row[k] = load(B + k * side);
  for (std::size_t i = 0; i < side; ++i) {
    Nine sum = load(C + i * side);
    for (std::size_t k = 0; k < side; ++k) subtract(sum, A[k * side + i], row[k]);
    store(sum, C + i * side);
  }
}

void substitute(const BlockFactor& factor, double* x) {
  for (std::size_t p = 0; p < factor.blocks; ++p) {  // U^T y = x
    const double* blocks = factor.value + static_cast<std::size_t>(factor.row_begin[p]) * entries;
    double* y = x + p * side;
    for (std::size_t k = 0; k < side; ++k) {
      y[k] *= blocks[k * side + k];
      for (std::size_t i = k + 1; i < side; ++i) y[i] -= y[k] * blocks[k * side + i];
    }
    for (auto slot = factor.row_begin[p] + 1; slot < factor.row_begin[p + 1]; ++slot) {
      const double* block = factor.value + static_cast<std::size_t>(slot) * entries;
      double* to = x + static_cast<std::size_t>(factor.column[slot]) * side;
      Nine rest = load(to);
      for (std::size_t k = 0; k < side; ++k) subtract(rest, y[k], load(block + k * side));
      store(rest, to);
    }
  }
  for (std::size_t p = factor.blocks; p-- > 0;) {  // U x = y
    Nine sum[side] = {};                           // [row] of products, eight and one at a time
    for (auto slot = factor.row_begin[p] + 1; slot < factor.row_begin[p + 1]; ++slot) {
      const double* block = factor.value + static_cast<std::size_t>(slot) * entries;
      const Nine known = load(x + static_cast<std::size_t>(factor.column[slot]) * side);
      for (std::size_t k = 0; k < side; ++k) {
        const Nine row = load(block + k * side);
        sum[k].most += row.most * known.most;
        sum[k].last += row.last * known.last;
      }
    }
    const double* diagonal = factor.value + static_cast<std::size_t>(factor.row_begin[p]) * entries;
    double* y = x + p * side;
    for (std::size_t k = side; k-- > 0;) {
      const Eight& s = sum[k].most;
      double rest = y[k] - ((((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]))) + sum[k].last);
      for (std::size_t i = k + 1; i < side; ++i) rest -= diagonal[k * side + i] * y[i];
      y[k] = rest * diagonal[k * side + k];
    }
  }
}

}  // namespace
}  // namespace toile::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace toile::internal {
namespace {
HWY_EXPORT(finish);
HWY_EXPORT(product);
HWY_EXPORT(substitute);
}  // namespace

void finish_row(double* blocks, std::size_t count, double least) { HWY_DYNAMIC_DISPATCH(finish)(blocks, count, least); }
void subtract_product(const double* A, const double* B, double* C) { HWY_DYNAMIC_DISPATCH(product)(A, B, C); }
void substitute_blocks(const BlockFactor& factor, double* x) { HWY_DYNAMIC_DISPATCH(substitute)(factor, x); }

}  // namespace toile::internal
#endif
