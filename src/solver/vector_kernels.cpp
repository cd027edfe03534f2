#include "solver/vector_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/vector_kernels.cpp"
#include <hwy/foreach_target.h>
// After it.
#include <hwy/highway.h>

// Registers that the baseline instruction set lacks are passed between inlined functions only, so no ABI is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

HWY_BEFORE_NAMESPACE();
namespace toile::internal::HWY_NAMESPACE {
namespace {

// Lanes of two particles; the compiler splits them into the registers of the instruction set.
using Two [[gnu::vector_size(32)]] = float;
using Wide [[gnu::vector_size(64)]] = double;

HWY_INLINE Two load(const Lane<float>* of) {
  Two v;
  std::memcpy(&v, of, sizeof v);
  return v;
}
HWY_INLINE void store(const Two& v, Lane<float>* to) { std::memcpy(to, &v, sizeof v); }
HWY_INLINE Wide product(const Two& a, const Two& b) {
  return __builtin_convertvector(a, Wide) * __builtin_convertvector(b, Wide);
}
HWY_INLINE double sum(const Wide& a, const Wide& b) {
  const Wide s = a + b;
  return ((s[0] + s[4]) + (s[1] + s[5])) + (s[2] + s[6]);
}
HWY_INLINE Two both(const Lane<float>& a, const Lane<float>& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
// G r of two particles.
HWY_INLINE Two times(const Block<float>* G, const Two& r) {
  return both(G[0].c0, G[1].c0) * __builtin_shufflevector(r, r, 0, 0, 0, 0, 4, 4, 4, 4) +
         both(G[0].c1, G[1].c1) * __builtin_shufflevector(r, r, 1, 1, 1, 1, 5, 5, 5, 5) +
         both(G[0].c2, G[1].c2) * __builtin_shufflevector(r, r, 2, 2, 2, 2, 6, 6, 6, 6);
}

// work(k, sum) for every pair of particles k, k + 1 of four at a time; the rest goes through copies padded by zeros.
constexpr Index step = 4;

double dot(Index begin, Index end, const Lane<float>* a, const Lane<float>* b) {
  Wide even{}, odd{};
  Index i = begin;
  for (; i + step <= end; i += step) {
    even += product(load(a + i), load(b + i));
    odd += product(load(a + i + 2), load(b + i + 2));
  }
  if (i < end) {
    std::array<Lane<float>, step> last_a{}, last_b{};
    std::copy(a + i, a + end, last_a.begin());
    std::copy(b + i, b + end, last_b.begin());
    even += product(load(&last_a[0]), load(&last_b[0]));
    odd += product(load(&last_a[2]), load(&last_b[2]));
  }
  return sum(even, odd);
}

HWY_INLINE Wide move_direction(bool first, float beta, const Lane<float>* s, const Lane<float>* As, Lane<float>* c,
                               Lane<float>* q) {
  Two c_new = load(s), q_new = load(As);
  if (!first) {
    c_new += load(c) * beta;
    q_new += load(q) * beta;
  }
  store(c_new, c);
  store(q_new, q);
  return product(c_new, q_new);
}

double direction(Index begin, Index end, bool first, float beta, const Lane<float>* s, const Lane<float>* As,
                 Lane<float>* c, Lane<float>* q) {
  Wide even{}, odd{};
  Index i = begin;
  for (; i + step <= end; i += step) {
    even += move_direction(first, beta, s + i, As + i, c + i, q + i);
    odd += move_direction(first, beta, s + i + 2, As + i + 2, c + i + 2, q + i + 2);
  }
  if (i < end) {
    std::array<Lane<float>, step> last[4] = {};
    const Lane<float>* from[4] = {s, As, c, q};
    for (int k = 0; k < 4; ++k) std::copy(from[k] + i, from[k] + end, last[k].begin());
    even += move_direction(first, beta, &last[0][0], &last[1][0], &last[2][0], &last[3][0]);
    odd += move_direction(first, beta, &last[0][2], &last[1][2], &last[2][2], &last[3][2]);
    std::copy_n(last[2].begin(), end - i, c + i);
    std::copy_n(last[3].begin(), end - i, q + i);
  }
  return sum(even, odd);
}

HWY_INLINE Wide move_residual(float alpha, const Lane<float>* c, const Lane<float>* q, const Block<float>* G,
                              Lane<float>* w, Lane<float>* r) {
  store(load(w) + load(c) * alpha, w);
  const Two r_new = load(r) - load(q) * alpha;
  store(r_new, r);
  return product(r_new, times(G, r_new));
}

double residual(Index begin, Index end, float alpha, const Lane<float>* c, const Lane<float>* q, const Block<float>* G,
                Lane<float>* w, Lane<float>* r) {
  Wide even{}, odd{};
  Index i = begin;
  for (; i + step <= end; i += step) {
    even += move_residual(alpha, c + i, q + i, G + i, w + i, r + i);
    odd += move_residual(alpha, c + i + 2, q + i + 2, G + i + 2, w + i + 2, r + i + 2);
  }
  if (i < end) {
    std::array<Lane<float>, step> last[4] = {};
    std::array<Block<float>, step> last_G{};
    const Lane<float>* from[4] = {c, q, w, r};
    for (int k = 0; k < 4; ++k) std::copy(from[k] + i, from[k] + end, last[k].begin());
    std::copy(G + i, G + end, last_G.begin());
    even += move_residual(alpha, &last[0][0], &last[1][0], &last_G[0], &last[2][0], &last[3][0]);
    odd += move_residual(alpha, &last[0][2], &last[1][2], &last_G[2], &last[2][2], &last[3][2]);
    std::copy_n(last[2].begin(), end - i, w + i);
    std::copy_n(last[3].begin(), end - i, r + i);
  }
  return sum(even, odd);
}

double norm2(Index begin, Index end, const Block<float>* G, const Lane<float>* r) {
  Wide even{}, odd{};
  Index i = begin;
  for (; i + step <= end; i += step) {
    const Two a = load(r + i), b = load(r + i + 2);
    even += product(a, times(G + i, a));
    odd += product(b, times(G + i + 2, b));
  }
  if (i < end) {
    std::array<Lane<float>, step> last{};
    std::array<Block<float>, step> last_G{};
    std::copy(r + i, r + end, last.begin());
    std::copy(G + i, G + end, last_G.begin());
    even += product(load(&last[0]), times(&last_G[0], load(&last[0])));
    odd += product(load(&last[2]), times(&last_G[2], load(&last[2])));
  }
  return sum(even, odd);
}

using Numbers [[gnu::vector_size(32)]] = double;  // three and one unused

HWY_INLINE void add_three(const Numbers& v, double* to) {
  for (int m = 0; m < 3; ++m) to[m] += v[m];
}

void moments(Index begin, Index end, const Lane<float>* r, const Lane<float>* At, const Vec3* basis,
             const Index* aggregate, double* sum) {
  for (Index p = begin; p < end;) {
    const Index of = aggregate[p];
    Numbers constant{}, along_u{}, along_v{};
    for (; p < end && aggregate[p] == of; ++p) {
      const Numbers d = __builtin_convertvector(r[p] - At[p], Numbers);
      constant += d;
      along_u += basis[p][1] * d;
      along_v += basis[p][2] * d;
    }
    double* y = sum + 9 * static_cast<std::ptrdiff_t>(of);
    add_three(constant, y);
    add_three(along_u, y + 3);
    add_three(along_v, y + 6);
  }
}

}  // namespace
}  // namespace toile::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace toile::internal {
namespace {
HWY_EXPORT(dot);
HWY_EXPORT(direction);
HWY_EXPORT(residual);
HWY_EXPORT(norm2);
HWY_EXPORT(moments);
}  // namespace

double dot_lanes(Index begin, Index end, const Lane<float>* a, const Lane<float>* b) {
  return HWY_DYNAMIC_DISPATCH(dot)(begin, end, a, b);
}
double next_direction(Index begin, Index end, bool first, float beta, const Lane<float>* s, const Lane<float>* As,
                      Lane<float>* c, Lane<float>* q) {
  return HWY_DYNAMIC_DISPATCH(direction)(begin, end, first, beta, s, As, c, q);
}
double next_residual(Index begin, Index end, float alpha, const Lane<float>* c, const Lane<float>* q,
                     const Block<float>* G, Lane<float>* w, Lane<float>* r) {
  return HWY_DYNAMIC_DISPATCH(residual)(begin, end, alpha, c, q, G, w, r);
}
double residual_norm2(Index begin, Index end, const Block<float>* G, const Lane<float>* r) {
  return HWY_DYNAMIC_DISPATCH(norm2)(begin, end, G, r);
}
void add_moments(Index begin, Index end, const Lane<float>* r, const Lane<float>* At, const Vec3* basis,
                 const Index* aggregate, double* sum) {
  HWY_DYNAMIC_DISPATCH(moments)(begin, end, r, At, basis, aggregate, sum);
}

double dot_lanes(Index begin, Index end, const Lane<double>* a, const Lane<double>* b) {
  double sum = 0;
  for (Index i = begin; i < end; ++i) sum += dot(a[i], b[i]);
  return sum;
}
double next_direction(Index begin, Index end, bool first, double beta, const Lane<double>* s, const Lane<double>* As,
                      Lane<double>* c, Lane<double>* q) {
  double sum = 0;
  for (Index i = begin; i < end; ++i) {
    c[i] = first ? s[i] : s[i] + c[i] * beta;
    q[i] = first ? As[i] : As[i] + q[i] * beta;
    sum += dot(c[i], q[i]);
  }
  return sum;
}
double next_residual(Index begin, Index end, double alpha, const Lane<double>* c, const Lane<double>* q,
                     const Block<double>* G, Lane<double>* w, Lane<double>* r) {
  double sum = 0;
  for (Index i = begin; i < end; ++i) {
    w[i] += c[i] * alpha;
    r[i] -= q[i] * alpha;
    sum += dot(r[i], G[i].times(r[i]));
  }
  return sum;
}
double residual_norm2(Index begin, Index end, const Block<double>* G, const Lane<double>* r) {
  double sum = 0;
  for (Index i = begin; i < end; ++i) sum += dot(r[i], G[i].times(r[i]));
  return sum;
}

void add_moments(Index begin, Index end, const Lane<double>* r, const Lane<double>* At, const Vec3* basis,
                 const Index* aggregate, double* sum) {
  for (Index p = begin; p < end; ++p) {
    const Lane<double> d = r[p] - At[p];
    for (Eigen::Index l = 0; l < 3; ++l) {
      for (std::size_t c = 0; c < 3; ++c)
        sum[9 * static_cast<std::size_t>(aggregate[p]) + 3 * static_cast<std::size_t>(l) + c] += basis[p][l] * d[c];
    }
  }
}

}  // namespace toile::internal
#endif
