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
namespace toile::internal::HWY_NAMESPACE {
namespace {

// Lanes of two particles: three numbers and a zero each.  Nothing crosses from one to the other.
namespace hn = hwy::HWY_NAMESPACE;
#if HWY_MAX_BYTES >= 32
using TwoTag = hn::FixedTag<float, 8>;
using Two = hn::Vec<TwoTag>;
constexpr TwoTag two;
constexpr hn::FixedTag<float, 4> one;

HWY_INLINE Two load(const float* a, const float* b) { return hn::Combine(two, hn::Load(one, b), hn::Load(one, a)); }
HWY_INLINE Two load_two(const Lane<float>* both) { return hn::LoadU(two, reinterpret_cast<const float*>(both)); }
HWY_INLINE void store(Two v, float* a, float* b) {
  hn::Store(hn::LowerHalf(one, v), one, a);
  hn::Store(hn::UpperHalf(one, v), one, b);
}
HWY_INLINE Two no_two() { return hn::Zero(two); }
// Of registers of any width.
template <class V>
HWY_INLINE V add(V a, V b) {
  return hn::Add(a, b);
}
template <class V>
HWY_INLINE V sub(V a, V b) {
  return hn::Sub(a, b);
}
template <class V>
HWY_INLINE V mul(V a, V b) {
  return hn::Mul(a, b);
}
template <int k, class V>
HWY_INLINE V all(V v) {
  return hn::Broadcast<k>(v);
}
HWY_INLINE Lane<float> halves(Two v) {  // their sum
  Lane<float> sum;
  hn::Store(hn::Add(hn::LowerHalf(one, v), hn::UpperHalf(one, v)), one, reinterpret_cast<float*>(&sum));
  return sum;
}
// (sum of a, sum of b, sum of c, 0) of each particle, as Block::column_sums has it.
template <class V>
HWY_INLINE V sums(V a, V b, V c) {
  const hn::DFromV<V> tag;
  const hn::Repartition<double, hn::DFromV<V>> pairs;
  const V zero = hn::Zero(tag);
  const auto low = hn::BitCast(pairs, hn::InterleaveLower(tag, a, b)),
             high = hn::BitCast(pairs, hn::InterleaveUpper(tag, a, b)),
             low_c = hn::BitCast(pairs, hn::InterleaveLower(tag, c, zero)),
             high_c = hn::BitCast(pairs, hn::InterleaveUpper(tag, c, zero));
  return hn::Add(hn::Add(hn::BitCast(tag, hn::InterleaveLower(pairs, low, low_c)),
                         hn::BitCast(tag, hn::InterleaveUpper(pairs, low, low_c))),
                 hn::BitCast(tag, hn::InterleaveLower(pairs, high, high_c)));
}
#else
struct Two {
  Lane<float> a, b;
};

HWY_INLINE Two load(const float* a, const float* b) {
  return {*reinterpret_cast<const Lane<float>*>(a), *reinterpret_cast<const Lane<float>*>(b)};
}
HWY_INLINE Two load_two(const Lane<float>* both) { return {both[0], both[1]}; }
HWY_INLINE void store(const Two& v, float* a, float* b) {
  *reinterpret_cast<Lane<float>*>(a) = v.a;
  *reinterpret_cast<Lane<float>*>(b) = v.b;
}
HWY_INLINE Two no_two() { return {Lane<float>{0, 0, 0, 0}, Lane<float>{0, 0, 0, 0}}; }
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

// Lanes of four particles, one of each strip: a register, or two of the above.
#if HWY_MAX_BYTES >= 64
using FourTag = hn::FixedTag<float, 16>;
using Four = hn::Vec<FourTag>;
constexpr FourTag four;

HWY_INLINE Four load(const float* const (&at)[4], std::ptrdiff_t offset) {
  return hn::Combine(four, load(at[2] + offset, at[3] + offset), load(at[0] + offset, at[1] + offset));
}
HWY_INLINE Four load(const float* base, const std::int32_t (&offset)[4]) {
  return hn::Combine(four, load(base + offset[2], base + offset[3]), load(base + offset[0], base + offset[1]));
}
HWY_INLINE Four load(const Lane<float>* all) { return hn::Load(four, reinterpret_cast<const float*>(all)); }
HWY_INLINE void store(Four v, float* const (&at)[4], std::ptrdiff_t offset) {
  store(hn::LowerHalf(two, v), at[0] + offset, at[1] + offset);
  store(hn::UpperHalf(two, v), at[2] + offset, at[3] + offset);
}
HWY_INLINE void store(Four v, float* base, const std::int32_t (&offset)[4]) {
  store(hn::LowerHalf(two, v), base + offset[0], base + offset[1]);
  store(hn::UpperHalf(two, v), base + offset[2], base + offset[3]);
}
HWY_INLINE Four no_four() { return hn::Zero(four); }
#else
struct Four {
  Two ab, cd;
};

HWY_INLINE Four load(const float* const (&at)[4], std::ptrdiff_t offset) {
  return {load(at[0] + offset, at[1] + offset), load(at[2] + offset, at[3] + offset)};
}
HWY_INLINE Four load(const float* base, const std::int32_t (&offset)[4]) {
  return {load(base + offset[0], base + offset[1]), load(base + offset[2], base + offset[3])};
}
HWY_INLINE Four load(const Lane<float>* all) { return {load_two(all), load_two(all + 2)}; }
HWY_INLINE void store(const Four& v, float* const (&at)[4], std::ptrdiff_t offset) {
  store(v.ab, at[0] + offset, at[1] + offset);
  store(v.cd, at[2] + offset, at[3] + offset);
}
HWY_INLINE void store(const Four& v, float* base, const std::int32_t (&offset)[4]) {
  store(v.ab, base + offset[0], base + offset[1]);
  store(v.cd, base + offset[2], base + offset[3]);
}
HWY_INLINE Four no_four() { return {no_two(), no_two()}; }
HWY_INLINE Four add(const Four& a, const Four& b) { return {add(a.ab, b.ab), add(a.cd, b.cd)}; }
HWY_INLINE Four sub(const Four& a, const Four& b) { return {sub(a.ab, b.ab), sub(a.cd, b.cd)}; }
HWY_INLINE Four mul(const Four& a, const Four& b) { return {mul(a.ab, b.ab), mul(a.cd, b.cd)}; }
template <int k>
HWY_INLINE Four all(const Four& v) {
  return {all<k>(v.ab), all<k>(v.cd)};
}
HWY_INLINE Four sums(const Four& a, const Four& b, const Four& c) {
  return {sums(a.ab, b.ab, c.ab), sums(a.cd, b.cd, c.cd)};
}
#endif

HWY_INLINE Four combine(const Four& c0, const Four& x0, const Four& c1, const Four& x1, const Four& c2,
                        const Four& x2) {
  return add(add(mul(c0, x0), mul(c1, x1)), mul(c2, x2));
}
HWY_INLINE Four times(const float* const (&G)[4], std::ptrdiff_t offset, const Four& x) {
  return combine(load(G, offset), all<0>(x), load(G, offset + 4), all<1>(x), load(G, offset + 8), all<2>(x));
}

// Where the numbers of the rows of a time begin, for each strip.
struct RowNumbers {
  RowNumbers(const Strips& strips, const Block<float>* of_G, Lane<float>* of_s, Lane<float>* of_As) {
    static_assert(strips_at_once == 4);
    for (int strip = 0; strip < 4; ++strip) {
      const std::ptrdiff_t first = strips.first[strip];
      G[strip] = reinterpret_cast<const float*>(of_G + first);
      s[strip] = reinterpret_cast<float*>(of_s + first);
      As[strip] = reinterpret_cast<float*>(of_As + first);
    }
  }
  const float* G[4];
  float *s[4], *As[4];
};

//   forward    h = r - L y,  y = G h,      pushed from a row into later ones
//   backward   s = y - G U s,              pulled;  As = h + L s is pushed while the blocks are at hand      [Eisenstat 1981]
// A sweep is a chain of rows, and the latency of the row before exceeds the work of a row: so independent rows are swept
// together.  A row pulls from its neighbour in the order of places last, and pushes into it first.
void forward(const Strips& strips, Index first, Index end, const Block<float>* G, Lane<float>* s_lanes,
             Lane<float>* As_lanes) {
  const RowNumbers rows(strips, G, s_lanes, As_lanes);
  float* As = reinterpret_cast<float*>(As_lanes);
  const float* const(&const_As)[4] = {rows.As[0], rows.As[1], rows.As[2], rows.As[3]};
  // By value: no store can alias it.
  const std::int32_t* begin = strips.begin;
  const StripColumn* column = strips.column;
  const StripBlock* blocks = strips.block;
  for (Index k = first; k < std::min(end, strips.rows); ++k) {
    const Four y = times(rows.G, 12 * k, load(const_As, 4 * k));
    store(y, rows.s, 4 * k);
    const Four y0 = all<0>(y), y1 = all<1>(y), y2 = all<2>(y);
    for (std::int32_t n = begin[k]; n < begin[k + 1]; ++n) {
      const StripBlock& block = blocks[n];
      const Four pushed = combine(load(block.row[0]), y0, load(block.row[1]), y1, load(block.row[2]), y2);
      store(sub(load(As, column[n].offset), pushed), As, column[n].offset);
    }
  }
  if (end <= strips.rows) return;
  for (int strip = 0; strip < strips.longer; ++strip) {  // a last row has no later one
    const auto last = static_cast<std::size_t>(strips.first[strip] + strips.rows);
    s_lanes[last] = G[last].times(As_lanes[last]);
  }
}

void backward(const Strips& strips, Index first, Index end, const Block<float>* G, Lane<float>* s_lanes,
              Lane<float>* As_lanes) {
  const RowNumbers rows(strips, G, s_lanes, As_lanes);
  float *s = reinterpret_cast<float*>(s_lanes), *As = reinterpret_cast<float*>(As_lanes);
  const float* const(&const_s)[4] = {rows.s[0], rows.s[1], rows.s[2], rows.s[3]};
  const std::int32_t* begin = strips.begin;
  const StripColumn* column = strips.column;
  const StripBlock* blocks = strips.block;
  for (Index k = std::min(end, strips.rows); k-- > first;) {
    Four sum0 = no_four(), sum1 = no_four(), sum2 = no_four();
    for (std::int32_t n = begin[k + 1]; n-- > begin[k];) {
      const StripBlock& block = blocks[n];
      const Four x = load(s, column[n].offset);
      sum0 = add(sum0, mul(load(block.row[0]), x));
      sum1 = add(sum1, mul(load(block.row[1]), x));
      sum2 = add(sum2, mul(load(block.row[2]), x));
    }
    const Four x = sub(load(const_s, 4 * k), times(rows.G, 12 * k, sums(sum0, sum1, sum2)));
    store(x, rows.s, 4 * k);
    const Four x0 = all<0>(x), x1 = all<1>(x), x2 = all<2>(x);
    for (std::int32_t n = begin[k]; n < begin[k + 1]; ++n) {
      const StripBlock& block = blocks[n];
      const Four pushed = combine(load(block.row[0]), x0, load(block.row[1]), x1, load(block.row[2]), x2);
      store(add(load(As, column[n].offset), pushed), As, column[n].offset);
    }
  }
}

// Columns 0, 2, 4, 6 of a particle's entries add up in one half, 1, 3, 5, 7 in the other, 8 on its own.
void add_columns(const CoarseColumns& coarse, Index begin, Index end, const Lane<float>* Zy, Lane<float>* t,
                 Lane<float>* At) {
  const std::int32_t* entry_begin = coarse.entry_begin;
  const Index* aggregate = coarse.aggregate;
  const Lane<float>*column = coarse.column, *y = coarse.y;
  for (Index p = begin; p < end; ++p) {
    Two pairs = no_two();
    Lane<float> last{0, 0, 0, 0};
    for (std::int32_t e = entry_begin[p]; e < entry_begin[p + 1]; ++e) {
      const Lane<float>*c = column + 9 * static_cast<std::ptrdiff_t>(e), *y_e = y + 9 * aggregate[e];
      for (int m = 0; m < 8; m += 2) pairs = add(pairs, mul(load_two(c + m), load_two(y_e + m)));
      last += c[8] * y_e[8];
    }
    t[p] += Zy[p];
    At[p] += halves(pairs) + last;
  }
}

}  // namespace
}  // namespace toile::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace toile::internal {
namespace {
HWY_EXPORT(forward);
HWY_EXPORT(backward);
HWY_EXPORT(add_columns);
}  // namespace

void sweep_forward(const Strips& strips, Index begin, Index end, const Block<float>* G, Lane<float>* s,
                   Lane<float>* As) {
  HWY_DYNAMIC_DISPATCH(forward)(strips, begin, end, G, s, As);
}

void sweep_backward(const Strips& strips, Index begin, Index end, const Block<float>* G, Lane<float>* s,
                    Lane<float>* As) {
  HWY_DYNAMIC_DISPATCH(backward)(strips, begin, end, G, s, As);
}

void add_coarse_columns(const CoarseColumns& coarse, Index begin, Index end, const Lane<float>* Zy, Lane<float>* t,
                        Lane<float>* At) {
  HWY_DYNAMIC_DISPATCH(add_columns)(coarse, begin, end, Zy, t, At);
}

}  // namespace toile::internal
#endif
