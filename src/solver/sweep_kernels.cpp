#include "solver/sweep_kernels.hpp"

#include <algorithm>

// Vectors of unknown width cannot be members of a struct.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/sweep_kernels.cpp"
#include <hwy/foreach_target.h>
// After it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace toile::HWY_NAMESPACE {
namespace {

// A number of three lanes and a zero for each of two strips.  Nothing crosses from one strip to the other.
#if HWY_MAX_BYTES >= 32
namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::FixedTag<float, 8>;
using Two = hn::Vec<Tag>;
constexpr Tag tag;
constexpr hn::FixedTag<float, 4> half;

HWY_INLINE Two load(const float* a, const float* b) { return hn::Combine(tag, hn::Load(half, b), hn::Load(half, a)); }
HWY_INLINE Two load(const Lane<float>* both) { return hn::LoadU(tag, reinterpret_cast<const float*>(both)); }
HWY_INLINE void store(Two v, float* a, float* b) {
  hn::Store(hn::LowerHalf(half, v), half, a);
  hn::Store(hn::UpperHalf(half, v), half, b);
}
HWY_INLINE Two zero() { return hn::Zero(tag); }
HWY_INLINE Two add(Two a, Two b) { return hn::Add(a, b); }
HWY_INLINE Two sub(Two a, Two b) { return hn::Sub(a, b); }
HWY_INLINE Two mul(Two a, Two b) { return hn::Mul(a, b); }
template <int k>
HWY_INLINE Two all(Two v) {
  return hn::Broadcast<k>(v);
}
HWY_INLINE Lane<float> halves(Two v) {  // their sum
  Lane<float> sum;
  hn::Store(hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)), half, reinterpret_cast<float*>(&sum));
  return sum;
}
// (sum of a, sum of b, sum of c, 0) as Block::column_sums has it.
HWY_INLINE Two sums(Two a, Two b, Two c) {
  const hn::Repartition<double, Tag> twice;
  const auto low = hn::BitCast(twice, hn::InterleaveLower(tag, a, b)),
             high = hn::BitCast(twice, hn::InterleaveUpper(tag, a, b)),
             low_c = hn::BitCast(twice, hn::InterleaveLower(tag, c, zero())),
             high_c = hn::BitCast(twice, hn::InterleaveUpper(tag, c, zero()));
  return hn::Add(hn::Add(hn::BitCast(tag, hn::InterleaveLower(twice, low, low_c)),
                         hn::BitCast(tag, hn::InterleaveUpper(twice, low, low_c))),
                 hn::BitCast(tag, hn::InterleaveLower(twice, high, high_c)));
}
#else
struct Two {
  Lane<float> a, b;
};

HWY_INLINE Two load(const float* a, const float* b) {
  return {*reinterpret_cast<const Lane<float>*>(a), *reinterpret_cast<const Lane<float>*>(b)};
}
HWY_INLINE Two load(const Lane<float>* both) { return {both[0], both[1]}; }
HWY_INLINE void store(const Two& v, float* a, float* b) {
  *reinterpret_cast<Lane<float>*>(a) = v.a;
  *reinterpret_cast<Lane<float>*>(b) = v.b;
}
HWY_INLINE Two zero() { return {Lane<float>{0, 0, 0, 0}, Lane<float>{0, 0, 0, 0}}; }
HWY_INLINE Two add(const Two& a, const Two& b) { return {a.a + b.a, a.b + b.b}; }
HWY_INLINE Two sub(const Two& a, const Two& b) { return {a.a - b.a, a.b - b.b}; }
HWY_INLINE Two mul(const Two& a, const Two& b) { return {a.a * b.a, a.b * b.b}; }
template <int k>
HWY_INLINE Two all(const Two& v) {
  return {__builtin_shufflevector(v.a, v.a, k, k, k, k), __builtin_shufflevector(v.b, v.b, k, k, k, k)};
}
HWY_INLINE Lane<float> halves(const Two& v) { return v.a + v.b; }
HWY_INLINE Two sums(const Two& a, const Two& b, const Two& c) {
  return {Block<float>::column_sums(a.a, b.a, c.a), Block<float>::column_sums(a.b, b.b, c.b)};
}
#endif

HWY_INLINE Two combine(const Two& c0, const Two& x0, const Two& c1, const Two& x1, const Two& c2, const Two& x2) {
  return add(add(mul(c0, x0), mul(c1, x1)), mul(c2, x2));
}
HWY_INLINE Two times(const float* G_a, const float* G_b, const Two& x) {
  return combine(load(G_a, G_b), all<0>(x), load(G_a + 4, G_b + 4), all<1>(x), load(G_a + 8, G_b + 8), all<2>(x));
}

//   forward    h = r - L y,  y = G h,      pushed from a row into later ones
//   backward   s = y - G U s,              pulled;  As = h + L s is pushed while the blocks are at hand      [Eisenstat 1981]
// A sweep is a chain of rows, and waiting for the row before would take longer than the work: so two rows that do not wait for
// each other share a register.  A row pulls from its neighbour in the order of particles last, and pushes into it first.
void sweep(const StripPair& strips, const Block<float>* G, const Lane<float>* r, Lane<float>* s_lanes,
           Lane<float>* As_lanes) {
  const Index first_a = strips.first[0], first_b = strips.first[1];
  float *s = reinterpret_cast<float*>(s_lanes), *As = reinterpret_cast<float*>(As_lanes);
  const float *G_a = reinterpret_cast<const float*>(G + first_a), *G_b = reinterpret_cast<const float*>(G + first_b);
  float *s_a = s + 4 * first_a, *s_b = s + 4 * first_b, *As_a = As + 4 * first_a, *As_b = As + 4 * first_b;
  // By value: of what `strips` refers to, no store can change it.
  const Index pairs = strips.pairs;
  const std::int32_t* begin = strips.begin;
  const PairedColumn* column = strips.column;
  const PairedBlock* blocks = strips.block;
  std::copy(r + first_a, r + first_a + strips.pairs + (strips.single ? 1 : 0), As_lanes + first_a);
  std::copy(r + first_b, r + first_b + strips.pairs, As_lanes + first_b);
  for (Index k = 0; k < pairs; ++k) {
    const Two y = times(G_a + 12 * k, G_b + 12 * k, load(As_a + 4 * k, As_b + 4 * k));
    store(y, s_a + 4 * k, s_b + 4 * k);
    const Two y0 = all<0>(y), y1 = all<1>(y), y2 = all<2>(y);
    for (std::int32_t n = begin[k]; n < begin[k + 1]; ++n) {
      const Lane<float>* block = blocks[n].row[0];
      float *to_a = As + column[n].offset[0], *to_b = As + column[n].offset[1];
      store(sub(load(to_a, to_b), combine(load(block), y0, load(block + 2), y1, load(block + 4), y2)), to_a, to_b);
    }
  }
  if (strips.single) {  // the last row has no later one
    const std::size_t last = static_cast<std::size_t>(strips.first[0] + pairs);
    s_lanes[last] = G[last].times(As_lanes[last]);
  }
  for (Index k = pairs; k-- > 0;) {
    Two sum0 = zero(), sum1 = zero(), sum2 = zero();
    for (std::int32_t n = begin[k + 1]; n-- > begin[k];) {
      const Lane<float>* block = blocks[n].row[0];
      const Two x = load(s + column[n].offset[0], s + column[n].offset[1]);
      sum0 = add(sum0, mul(load(block), x));
      sum1 = add(sum1, mul(load(block + 2), x));
      sum2 = add(sum2, mul(load(block + 4), x));
    }
    const Two x = sub(load(s_a + 4 * k, s_b + 4 * k), times(G_a + 12 * k, G_b + 12 * k, sums(sum0, sum1, sum2)));
    store(x, s_a + 4 * k, s_b + 4 * k);
    const Two x0 = all<0>(x), x1 = all<1>(x), x2 = all<2>(x);
    for (std::int32_t n = begin[k]; n < begin[k + 1]; ++n) {
      const Lane<float>* block = blocks[n].row[0];
      float *to_a = As + column[n].offset[0], *to_b = As + column[n].offset[1];
      store(add(load(to_a, to_b), combine(load(block), x0, load(block + 2), x1, load(block + 4), x2)), to_a, to_b);
    }
  }
}

// Columns 0, 2, 4, 6 of a particle's entries add up in one half, 1, 3, 5, 7 in the other, 8 on its own.
void add_columns(const CoarseColumns& coarse, Index begin, Index end, Lane<float>* sum) {
  const std::int32_t* entry_begin = coarse.entry_begin;
  const Index* aggregate = coarse.aggregate;
  const Lane<float>*column = coarse.column, *y = coarse.y;
  for (Index p = begin; p < end; ++p) {
    Two pairs = zero();
    Lane<float> last{0, 0, 0, 0};
    for (std::int32_t e = entry_begin[p]; e < entry_begin[p + 1]; ++e) {
      const Lane<float>*c = column + 9 * static_cast<std::ptrdiff_t>(e), *y_e = y + 9 * aggregate[e];
      for (int m = 0; m < 8; m += 2) pairs = add(pairs, mul(load(c + m), load(y_e + m)));
      last += c[8] * y_e[8];
    }
    sum[p] += halves(pairs) + last;
  }
}

}  // namespace
}  // namespace toile::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace toile {
namespace {
HWY_EXPORT(sweep);
HWY_EXPORT(add_columns);
}  // namespace

void sweep_strips(const StripPair& strips, const Block<float>* G, const Lane<float>* r, Lane<float>* s,
                  Lane<float>* As) {
  HWY_DYNAMIC_DISPATCH(sweep)(strips, G, r, s, As);
}

void add_coarse_columns(const CoarseColumns& coarse, Index begin, Index end, Lane<float>* sum) {
  HWY_DYNAMIC_DISPATCH(add_columns)(coarse, begin, end, sum);
}

}  // namespace toile
#endif
