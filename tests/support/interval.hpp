// tests/support/interval.hpp: intervals of doubles that hold the true result of every operation.
//
// Widened outwards after each operation by four rounding errors and a denormal, whatever the rounding mode does.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

namespace toile::internal::exact {

struct Interval {
  double low = 0, high = 0;

  Interval() = default;
  Interval(double lowest, double highest) : low(lowest), high(highest) {}
  explicit Interval(double value) : low(value), high(value) {}

  friend Interval operator+(const Interval& a, const Interval& b) { return widened(a.low + b.low, a.high + b.high); }
  friend Interval operator-(const Interval& a, const Interval& b) { return widened(a.low - b.high, a.high - b.low); }
  friend Interval operator*(const Interval& a, const Interval& b) {
    const std::array<double, 4> p = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    return widened(std::min({p[0], p[1], p[2], p[3]}), std::max({p[0], p[1], p[2], p[3]}));
  }

 private:
  static Interval widened(double low, double high) {
    return {low - (std::abs(low) * 0x1p-51 + 0x1p-1060), high + (std::abs(high) * 0x1p-51 + 0x1p-1060)};
  }
};

}  // namespace toile::internal::exact
