// tests/contact/touch_oracle.hpp: ExactTouch with intervals in front, so that most motions cost microseconds.
//
// A piece [lo, hi] of the time holds the polynomials as Bernstein coefficients, which bound their values: where those
// of det, or of one `inside`, have one sign there is no touch; where det changes sign and all of `inside` are positive
// there is one.  Pieces are halved until all are decided, or too many are not.
#pragma once
#include "contact/exact_ccd.hpp"

#include <optional>

namespace toile::internal::exact {

class IntervalTouch {
 public:
  // Nothing where the intervals are too wide to tell.
  static std::optional<bool> touches(const Motion& motion) {
    std::array<Vector<Interval>, 4> x;
    for (std::size_t i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) {
        const Interval start(motion.start[i][k]), end(motion.end[i][k]);
        x[i][static_cast<std::size_t>(k)] = Polynomial<Interval>({start, end - start});
      }
    const TouchConditions<Interval> conditions = touch_conditions(motion.features, x);
    Piece piece{bernstein<4>(conditions.coplanar), {}, conditions.inside.size()};
    for (std::size_t k = 0; k < piece.count; ++k) piece.inside[k] = bernstein<5>(conditions.inside[k]);
    int left = most_pieces;
    return decide(piece, left);
  }

 private:
  static constexpr int most_pieces = 150;
  struct Piece {
    std::array<Interval, 4> coplanar;
    std::array<std::array<Interval, 5>, 4> inside;
    std::size_t count;
  };

  // b_j = sum over i <= j of (j over i) / (n over i) c_i,  n = Size - 1.
  template <std::size_t Size>
  static std::array<Interval, Size> bernstein(const Polynomial<Interval>& f) {
    const auto over = [](std::size_t n, std::size_t k) {
      double result = 1;
      for (std::size_t i = 1; i <= k; ++i) result = result * static_cast<double>(n - k + i) / static_cast<double>(i);
      return result;
    };
    std::array<Interval, Size> b;
    for (std::size_t j = 0; j < Size; ++j)
      for (std::size_t i = 0; i <= j; ++i) {
        const double ratio = over(j, i) / over(Size - 1, i);
        b[j] = b[j] + f.or_zero(i) * Interval(ratio * (1 - 0x1p-50), ratio * (1 + 0x1p-50));
      }
    return b;
  }

  template <std::size_t Size>
  static bool positive(const std::array<Interval, Size>& b) {
    return std::all_of(b.begin(), b.end(), [](const Interval& c) { return c.low > 0; });
  }
  template <std::size_t Size>
  static bool negative(const std::array<Interval, Size>& b) {
    return std::all_of(b.begin(), b.end(), [](const Interval& c) { return c.high < 0; });
  }

  // De Casteljau at 1/2: b becomes the half that is asked for.
  template <std::size_t Size>
  static void halve(std::array<Interval, Size>& b, bool upper) {
    const Interval half(0.5);
    if (!upper) std::reverse(b.begin(), b.end());
    for (std::size_t last = Size - 1; last > 0; --last)
      for (std::size_t i = 0; i < last; ++i) b[i] = (b[i] + b[i + 1]) * half;
    if (!upper) std::reverse(b.begin(), b.end());
  }

  static std::optional<bool> decide(const Piece& piece, int& left) {
    if (positive(piece.coplanar) || negative(piece.coplanar)) return false;
    bool all_inside = true;
    for (std::size_t k = 0; k < piece.count; ++k) {
      if (negative(piece.inside[k])) return false;
      all_inside = all_inside && positive(piece.inside[k]);
    }
    const Interval &first = piece.coplanar.front(), &last = piece.coplanar.back();
    if (all_inside && ((first.low > 0 && last.high < 0) || (first.high < 0 && last.low > 0))) return true;
    if (--left < 0) return std::nullopt;
    bool open = false;
    for (const bool upper : {false, true}) {
      Piece half = piece;
      halve(half.coplanar, upper);
      for (std::size_t k = 0; k < piece.count; ++k) halve(half.inside[k], upper);
      const std::optional<bool> touch = decide(half, left);
      if (touch == true) return true;
      open = open || !touch;
    }
    return open ? std::nullopt : std::optional<bool>(false);
  }
};

struct Touch {
  bool touches = false, exactly = false;  // whether the intervals had to leave it to whole numbers
};

inline Touch touch_of(const Motion& motion) {
  const std::optional<bool> quick = IntervalTouch::touches(motion);
  return quick ? Touch{*quick, false} : Touch{ExactTouch(motion).touches(), true};
}

}  // namespace toile::internal::exact
