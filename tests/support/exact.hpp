// tests/support/exact.hpp: whole numbers of any size, and random bits, for exact tests of predicates and audits.
//
// Doubles are multiples of a power of two, so a set of them becomes whole numbers on one scale, and signs of their
// determinants are exact.  Schoolbook arithmetic, slow and obvious.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace toile::internal::exact {

class Whole {
 public:
  Whole() = default;
  explicit Whole(std::int64_t value) : negative_(value < 0) {
    auto magnitude = value < 0 ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
    for (; magnitude != 0; magnitude >>= 32) digit_.push_back(static_cast<std::uint32_t>(magnitude));
  }
  int sign() const { return digit_.empty() ? 0 : negative_ ? -1 : 1; }
  Whole shifted(int bits) const {  // times 2^bits, bits >= 0
    Whole result = *this;
    Whole two_power(std::int64_t{1} << (bits % 32));
    result = result * two_power;
    if (!result.digit_.empty()) result.digit_.insert(result.digit_.begin(), static_cast<std::size_t>(bits / 32), 0);
    return result;
  }
  friend Whole operator-(Whole a) {
    a.negative_ = !a.negative_;
    return a;
  }
  friend Whole operator+(const Whole& a, const Whole& b) {
    if (a.negative_ == b.negative_) return {a.negative_, sum(a.digit_, b.digit_)};
    const int order = compare(a.digit_, b.digit_);
    if (order == 0) return {};
    return order > 0 ? Whole(a.negative_, difference(a.digit_, b.digit_))
                     : Whole(b.negative_, difference(b.digit_, a.digit_));
  }
  friend Whole operator-(const Whole& a, const Whole& b) { return a + (-b); }
  friend Whole operator*(const Whole& a, const Whole& b) {
    Digits product(a.digit_.size() + b.digit_.size(), 0);
    for (std::size_t i = 0; i < a.digit_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < b.digit_.size() || carry != 0; ++j) {
        carry += product[i + j];
        if (j < b.digit_.size()) carry += std::uint64_t{a.digit_[i]} * b.digit_[j];
        product[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
    }
    return {a.negative_ != b.negative_, std::move(product)};
  }

 private:
  using Digits = std::vector<std::uint32_t>;  // base 2^32, lowest first
  Whole(bool negative, Digits digits) : negative_(negative), digit_(std::move(digits)) {
    while (!digit_.empty() && digit_.back() == 0) digit_.pop_back();
  }
  static int compare(const Digits& a, const Digits& b) {
    if (a.size() != b.size()) return a.size() > b.size() ? 1 : -1;
    for (std::size_t i = a.size(); i-- > 0;)
      if (a[i] != b[i]) return a[i] > b[i] ? 1 : -1;
    return 0;
  }
  static Digits sum(const Digits& a, const Digits& b) {
    Digits result;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < std::max(a.size(), b.size()) || carry != 0; ++i) {
      if (i < a.size()) carry += a[i];
      if (i < b.size()) carry += b[i];
      result.push_back(static_cast<std::uint32_t>(carry));
      carry >>= 32;
    }
    return result;
  }
  static Digits difference(const Digits& a, const Digits& b) {  // a >= b
    Digits result = a;
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      std::int64_t digit = std::int64_t{a[i]} - borrow - (i < b.size() ? std::int64_t{b[i]} : 0);
      borrow = digit < 0 ? 1 : 0;
      if (digit < 0) digit += std::int64_t{1} << 32;
      result[i] = static_cast<std::uint32_t>(digit);
    }
    return result;
  }

  bool negative_ = false;
  Digits digit_;
};

using Point = std::array<Whole, 3>;

// value = mantissa * 2^exponent with an odd mantissa, or 0.
struct Split {
  explicit Split(double value) {
    if (value == 0) return;
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    exponent -= 53;
    for (; mantissa % 2 == 0; mantissa /= 2) ++exponent;
  }
  std::int64_t mantissa = 0;
  int exponent = 0;
};

// The points times the smallest power of two that makes all of them whole.
inline std::vector<Point> whole_points(std::span<const Vec3> points) {
  int lowest = 0;
  bool any = false;
  for (const Vec3& p : points)
    for (const double x : p) {
      const Split split(x);
      if (split.mantissa == 0) continue;
      lowest = any ? std::min(lowest, split.exponent) : split.exponent;
      any = true;
    }
  std::vector<Point> result;
  for (const Vec3& p : points) {
    Point whole;
    for (int k = 0; k < 3; ++k) {
      const Split split(p[k]);
      if (split.mantissa != 0)
        whole[static_cast<std::size_t>(k)] = Whole(split.mantissa).shifted(split.exponent - lowest);
    }
    result.push_back(whole);
  }
  return result;
}

inline Whole determinant(const Point& a, const Point& b, const Point& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}
inline Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// Sign of (a - d) . ((b - d) x (c - d)).
inline int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  return determinant(a - d, b - d, c - d).sign();
}
inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const std::array<Vec3, 4> points = {a, b, c, d};
  const auto w = whole_points(points);
  return orient3d(w[0], w[1], w[2], w[3]);
}

// Bits of a fixed seed, mapped by hand: the same numbers with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  std::uint64_t bits() { return bits_(); }
  std::int64_t below(std::int64_t n) { return static_cast<std::int64_t>(bits() % static_cast<std::uint64_t>(n)); }
  std::int64_t between(std::int64_t low, std::int64_t high) { return low + below(high - low + 1); }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double real(double low, double high) { return low + (high - low) * unit(); }
  Vec3 point(double low, double high) {
    const double x = real(low, high), y = real(low, high), z = real(low, high);
    return {x, y, z};
  }
  Vec3 lattice_point(std::int64_t low, std::int64_t high) {
    const auto x = between(low, high), y = between(low, high), z = between(low, high);
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
  }
  template <class T>
  void shuffle(T& values) {
    for (std::size_t i = values.size(); i > 1; --i)
      std::swap(values[i - 1], values[static_cast<std::size_t>(below(static_cast<std::int64_t>(i)))]);
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace toile::internal::exact
