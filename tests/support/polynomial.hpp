// tests/support/polynomial.hpp: polynomials, and the sign of one at a root of another, without rounding.
//                                                                   [Basu, Pollack, Roy 2006, ch. 2: Sturm and Tarski]
//
//   signed remainders  S_0 = f,  S_1 = f' g mod f,  S_(i+1) = -(S_(i-1) mod S_i)
//   V(t)               sign changes in S_0(t), S_1(t), ...
//   V(lo) - V(hi)      = number of roots of f in (lo, hi) where g > 0, less those where g < 0;  each root counts once
//
// With g = 1 that counts the roots; with one root in (lo, hi) it is the sign of g there, 0 included.  Remainders are
// taken after a multiplication by a positive whole number, so coefficients stay whole and signs right.
//
// Easily got wrong: f must not vanish at lo or hi.  Double roots are allowed.
#pragma once
#include "support/exact.hpp"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace toile::internal::exact {

// Coefficients, lowest power first; a Coefficient has + - * and is 0 when default-constructed.
template <class Coefficient>
class Polynomial {
 public:
  Polynomial() = default;
  explicit Polynomial(std::vector<Coefficient> coefficients) : c_(std::move(coefficients)) {}
  std::size_t size() const { return c_.size(); }  // the degree, plus one
  const Coefficient& operator[](std::size_t i) const { return c_[i]; }
  Coefficient or_zero(std::size_t i) const { return i < c_.size() ? c_[i] : Coefficient(); }

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b) {
    std::vector<Coefficient> c;
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) c.push_back(a.or_zero(i) + b.or_zero(i));
    return Polynomial(std::move(c));
  }
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b) {
    std::vector<Coefficient> c;
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) c.push_back(a.or_zero(i) - b.or_zero(i));
    return Polynomial(std::move(c));
  }
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    if (a.size() == 0 || b.size() == 0) return {};
    std::vector<Coefficient> c(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j) c[i + j] = c[i + j] + a[i] * b[j];
    return Polynomial(std::move(c));
  }

 private:
  std::vector<Coefficient> c_;
};

template <class Coefficient>
using Vector = std::array<Polynomial<Coefficient>, 3>;

template <class Coefficient>
Vector<Coefficient> operator-(const Vector<Coefficient>& a, const Vector<Coefficient>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Coefficient>
Polynomial<Coefficient> dot(const Vector<Coefficient>& a, const Vector<Coefficient>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Coefficient>
Vector<Coefficient> cross(const Vector<Coefficient>& a, const Vector<Coefficient>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

using WholePolynomial = Polynomial<Whole>;

// Without leading zeros; the zero polynomial has size 0.
inline WholePolynomial trimmed(const WholePolynomial& f) {
  std::size_t size = f.size();
  while (size > 0 && f[size - 1].sign() == 0) --size;
  std::vector<Whole> c;
  for (std::size_t i = 0; i < size; ++i) c.push_back(f[i]);
  return WholePolynomial(std::move(c));
}
inline bool is_zero(const WholePolynomial& f) { return trimmed(f).size() == 0; }

inline WholePolynomial derivative(const WholePolynomial& f) {
  std::vector<Whole> c;
  for (std::size_t i = 1; i < f.size(); ++i) c.push_back(f[i] * Whole(static_cast<std::int64_t>(i)));
  return WholePolynomial(std::move(c));
}

// A positive multiple of a mod b.  Both trimmed, b not zero; so is the result.
inline WholePolynomial remainder(WholePolynomial a, const WholePolynomial& b) {
  const Whole& lead = b[b.size() - 1];
  const Whole positive = lead.sign() < 0 ? -lead : lead;
  while (a.size() >= b.size()) {
    const std::size_t shift = a.size() - b.size();
    const Whole top = lead.sign() < 0 ? -a[a.size() - 1] : a[a.size() - 1];
    std::vector<Whole> c;
    for (std::size_t i = 0; i + 1 < a.size(); ++i)
      c.push_back(i < shift ? a[i] * positive : a[i] * positive - top * b[i - shift]);
    a = trimmed(WholePolynomial(std::move(c)));
  }
  return a;
}

// numerator / 2^level.
struct Dyadic {
  Whole numerator;
  int level = 0;
};

inline int sign_at(const WholePolynomial& f, const Dyadic& t) {
  Whole value;
  for (std::size_t i = f.size(); i-- > 0;)
    value = value * t.numerator + f[i].shifted(t.level * static_cast<int>(f.size() - 1 - i));
  return value.sign();
}

struct RootInterval {
  Dyadic low, high;
};

// The roots of f in the open (0, 1).
class UnitRoots {
 public:
  // f not zero, of degree 6 at most.  Roots at 0 and 1 are divided out: V would not be defined there.
  explicit UnitRoots(const WholePolynomial& f)
      : f_(mirrored(without_zero(mirrored(without_zero(trimmed(f)))))), slope_(derivative(f_)) {
    if (f_.size() > 1) separate({{Whole(0), 0}, {Whole(1), 0}});
  }

  // Intervals with one root each.
  const std::vector<RootInterval>& intervals() const { return found_; }

  // Sum of the signs of g over the roots in the interval; f does not vanish at its ends.
  int signs_of(const WholePolynomial& g, const RootInterval& in) const {
    const WholePolynomial reduced = remainder(trimmed(g), f_);
    WholePolynomial before = f_, now = remainder(slope_ * reduced, f_);
    int change = 0, low = sign_at(before, in.low), high = sign_at(before, in.high);
    const auto count = [&](int& last, int sign, int direction) {
      if (sign == 0) return;
      if (last != sign) change += direction;
      last = sign;
    };
    while (now.size() > 0) {
      count(low, sign_at(now, in.low), 1);
      count(high, sign_at(now, in.high), -1);
      WholePolynomial next = WholePolynomial() - remainder(before, now);
      before = std::exchange(now, std::move(next));
    }
    return change;
  }

 private:
  static WholePolynomial without_zero(const WholePolynomial& f) {
    std::size_t first = 0;
    while (f[first].sign() == 0) ++first;
    std::vector<Whole> c;
    for (std::size_t i = first; i < f.size(); ++i) c.push_back(f[i]);
    return WholePolynomial(std::move(c));
  }
  static WholePolynomial mirrored(const WholePolynomial& f) {  // f(1 - t), by Horner
    const WholePolynomial mirror({Whole(1), Whole(-1)});
    WholePolynomial result;
    for (std::size_t i = f.size(); i-- > 0;) result = result * mirror + WholePolynomial({f[i]});
    return trimmed(result);
  }

  void separate(const RootInterval& in) {
    const int roots = signs_of(WholePolynomial({Whole(1)}), in);
    if (roots == 1) found_.push_back(in);
    if (roots <= 1) return;
    // Cut at the first of seven points, in eighths of the interval, that is no root.
    const Whole width = in.high.numerator - in.low.numerator;
    const Dyadic low{in.low.numerator.shifted(3), in.low.level + 3}, high{in.high.numerator.shifted(3), low.level};
    for (const std::int64_t eighths : {4, 3, 5, 2, 6, 1, 7}) {
      const Dyadic cut{low.numerator + width * Whole(eighths), low.level};
      if (sign_at(f_, cut) == 0) continue;
      separate({low, cut});
      separate({cut, high});
      return;
    }
  }

  WholePolynomial f_, slope_;
  std::vector<RootInterval> found_;
};

}  // namespace toile::internal::exact
