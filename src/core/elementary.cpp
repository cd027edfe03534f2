#include "core/elementary.hpp"

#include <array>
#include <cmath>  // sqrt, abs, copysign, round, lround, isnan, isinf: exact, the same everywhere
#include <limits>
#include <utility>

namespace toile::internal {
namespace {

struct Pair {  // hi + lo, unevaluated; |lo| at most half a unit in the last place of hi
  double hi, lo;
};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr Pair pi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Pair half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

// a + b without loss: the rounded sum and what was lost.  (Knuth)
Pair exact_sum(double a, double b) {
  const double sum = a + b, b_seen = sum - a;
  return {sum, (a - (sum - b_seen)) + (b - b_seen)};
}

constexpr int arc_steps = 8;                                       // per unit of the tangent
constexpr std::array<Pair, arc_steps + 1> arc_of_step = {{{0, 0},  // atan(k/8)
                                                          {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                                          {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                                          {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                                          {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                                          {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                                          {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                                          {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                                          {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};

// base + sign * atan(rise/run) for 0 <= rise <= run; base is 0, pi/2 or pi.
//   atan(t) = atan(c) + atan(r),   r = (t - c)/(1 + t c) = (rise - c run)/(run + c rise),   c the nearest k/8: |r| <= 1/16
// The second form of r, because rounding t first would cost a unit where atan(t) lies below a power of two and t above.
// atan(r) by its Taylor series: the first term left out, r^14/15 of the whole, is below 2^-59.
double arc(Pair base, double sign, double rise, double run) {
  const double t = run > 0 ? rise / run : 0;  // 0/0: the axis that the signs name
  const auto step = static_cast<int>(std::lround(t * arc_steps));
  double r = t;
  if (step > 0) {
    // Into the middle of the range, so that nothing overflows or loses digits; the two are within 16 of each other.
    const double scale = run > 0x1p+500 ? 0x1p-520 : run < 0x1p-500 ? 0x1p+520 : 1.0;
    const double c = static_cast<double>(step) / arc_steps, n = rise * scale, d = run * scale;
    r = (n - c * d) / (d + c * n);
  }
  const double r2 = r * r;
  const double series =
      r2 * (-1.0 / 3 +
            r2 * (1.0 / 5 + r2 * (-1.0 / 7 + r2 * (1.0 / 9 + r2 * (-1.0 / 11 + r2 * (1.0 / 13))))));  // atan(r)/r-1
  const Pair of_step = arc_of_step[static_cast<std::size_t>(step)];
  const Pair whole = exact_sum(base.hi, sign * of_step.hi);
  const double rest = whole.lo + base.lo + sign * (of_step.lo + r * series);
  return whole.hi + (sign * r + rest);  // small before large
}

struct Reduced {
  double hi, lo;  // x - quadrant pi/2, within pi/4 of zero
  int quadrant;   // modulo 4
};

// |x| <= 1e6.  pi/2 in three parts, the first two of 33 bits: their products with n < 2^20 are exact.
Reduced reduce(double x) {
  constexpr double part_1 = 0x1.921fb544p+0, part_2 = 0x1.0b4611a6p-34, part_3 = 0x1.3198a2e037073p-69;
  const double n = std::round(x * (1 / half_pi.hi));
  const Pair a = exact_sum(x, -n * part_1);
  const Pair b = exact_sum(a.hi, -n * part_2);
  const Pair c = exact_sum(b.hi, a.lo + b.lo - n * part_3);
  return {c.hi, c.lo, static_cast<int>(static_cast<long long>(n) & 3)};
}

// Taylor series about zero; for |r| <= pi/4 the first term left out is below 2^-62 (sine) and 2^-64 (cosine) of the result.
double sine_near_zero(double r, double lo) {
  const double r2 = r * r;
  constexpr std::array<double, 7> factorials = {120.0,        -5040.0,          362880.0,         -39916800.0,
                                                6227020800.0, -1307674368000.0, 355687428096000.0};
  double tail = 0;
  for (std::size_t k = factorials.size(); k-- > 0;) tail = r2 * (1 / factorials[k] + tail);
  return r + (r * (r2 * (tail - 1.0 / 6)) + lo * (1 - 0.5 * r2));
}

double cosine_near_zero(double r, double lo) {
  const double r2 = r * r;
  constexpr std::array<double, 8> factorials = {24.0,        -720.0,         40320.0,          -3628800.0,
                                                479001600.0, -87178291200.0, 20922789888000.0, -6402373705728000.0};
  double tail = 0;
  for (std::size_t k = factorials.size(); k-- > 0;) tail = r2 * (1 / factorials[k] + tail);
  const Pair first = exact_sum(1, -0.5 * r2);
  return first.hi + (first.lo + (r2 * tail - r * lo));
}

}  // namespace

double ieee_atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return nan;
  double rise = std::abs(y), run = std::abs(x);
  if (std::isinf(rise) && std::isinf(run)) rise = run = 1;  // the diagonal, by definition
  const bool left = std::signbit(x), steep = rise > run;
  if (steep) std::swap(rise, run);
  Pair base = {0, 0};
  double sign = 1;
  if (steep) {
    base = half_pi, sign = left ? 1 : -1;
  } else if (left) {
    base = pi, sign = -1;
  }
  return std::copysign(arc(base, sign, rise, run), y);
}

double ieee_sin(double x) {
  if (!(std::abs(x) <= 1e6)) return nan;
  const Reduced r = reduce(x);
  if (r.hi == 0) return x;  // no multiple of pi/2 but zero is a double; -0 keeps its sign
  const double magnitude = r.quadrant % 2 == 0 ? sine_near_zero(r.hi, r.lo) : cosine_near_zero(r.hi, r.lo);
  return r.quadrant < 2 ? magnitude : -magnitude;
}

double ieee_cos(double x) {
  if (!(std::abs(x) <= 1e6)) return nan;
  const Reduced r = reduce(x);
  const double magnitude = r.quadrant % 2 == 0 ? cosine_near_zero(r.hi, r.lo) : sine_near_zero(r.hi, r.lo);
  return r.quadrant == 0 || r.quadrant == 3 ? magnitude : -magnitude;
}

double ieee_asin(double x) {
  if (!(std::abs(x) <= 1)) return nan;
  return ieee_atan2(x, std::sqrt((1 - x) * (1 + x)));
}

}  // namespace toile::internal
