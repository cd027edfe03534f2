// verify/predicates.cpp: see the header; exact sums of doubles and the order of perturbations.
#include "verify/predicates.hpp"

#include "core/error.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace toile::internal {
namespace {

struct Pair {
  double high, low;  // high + low is the exact value, high the nearest double to it
};

// Knuth's sum of two doubles: no condition on their order.
Pair two_sum(double a, double b) {
  const double high = a + b;
  const double b_seen = high - a;
  return {high, (a - (high - b_seen)) + (b - b_seen)};
}

// Dekker's product; splitting instead of a fused multiply-add, so that every processor gives the same bits.
Pair two_product(double a, double b) {
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const double ta = splitter * a, tb = splitter * b;
  const double ah = ta - (ta - a), bh = tb - (tb - b);
  const double al = a - ah, bl = b - bh;
  const double high = a * b;
  return {high, al * bl - (((high - ah * bh) - al * bh) - ah * bl)};
}

// An exact sum: nonzero doubles of increasing magnitude whose bits do not overlap.        [Shewchuk 1997, 2.3]
template <int Capacity>
class Expansion {
 public:
  // GROW-EXPANSION (theorem 10), leaving out the zeros.
  void add(double b) {
    int kept = 0;
    double carry = b;
    for (int i = 0; i < size_; ++i) {
      const Pair s = two_sum(carry, term_[static_cast<std::size_t>(i)]);
      carry = s.high;
      if (s.low != 0) term_[static_cast<std::size_t>(kept++)] = s.low;  // kept <= i: nothing unread is overwritten
    }
    if (carry != 0) {
      TOILE_ASSERT(kept < Capacity);
      term_[static_cast<std::size_t>(kept++)] = carry;
    }
    size_ = kept;
  }
  void add_product(double a, double b) {
    const Pair p = two_product(a, b);
    add(p.low);
    add(p.high);
  }
  template <int N, int M>
  void add_product(const Expansion<N>& a, const Expansion<M>& b, double sign = 1) {
    for (int i = 0; i < a.size(); ++i)
      for (int j = 0; j < b.size(); ++j) add_product(sign * a[i], b[j]);
  }
  int size() const { return size_; }
  double operator[](int i) const { return term_[static_cast<std::size_t>(i)]; }
  // The largest term outweighs all others together.
  int sign() const { return size_ == 0 ? 0 : term_[static_cast<std::size_t>(size_ - 1)] > 0 ? 1 : -1; }

 private:
  std::array<double, Capacity> term_;
  int size_ = 0;
};

Expansion<2> difference(double a, double b) {
  Expansion<2> result;
  const Pair d = two_sum(a, -b);
  result.add(d.low);
  result.add(d.high);
  return result;
}

int orient3d_expanded(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const std::array<const Vec3*, 3> row = {&a, &b, &c};
  std::array<std::array<Expansion<2>, 3>, 3> m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) m[i][k] = difference((*row[i])[static_cast<int>(k)], d[static_cast<int>(k)]);
  Expansion<192> determinant;  // 3 minors of 16 terms, times 2 terms, 2 doubles per product
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& r = m[(i + 1) % 3];
    const auto& s = m[(i + 2) % 3];
    Expansion<16> minor;
    minor.add_product(r[0], s[1]);
    minor.add_product(r[1], s[0], -1);
    determinant.add_product(minor, m[i][2]);
  }
  return determinant.sign();
}

// Sign of the determinant of rows (x_i, y_i, 1): a minor of the 4 x 4 determinant.
int orient2d_expanded(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  Expansion<12> determinant;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    determinant.add_product(x[i], y[j]);
    determinant.add_product(-x[j], y[i]);
  }
  return determinant.sign();
}

// Which displacements occur together in one term of the expanded determinant: bit 3 r + c stands for that of coordinate
// c of row r.  No two share a row or a column: 1 + 12 + 36 + 24 sets.  As numbers they ascend with the power of
// epsilon, because the exponents are distinct powers of two; so the first set with a nonzero coefficient decides the
// sign.
constexpr int term_count = 73;
constexpr bool is_term(unsigned set) {
  unsigned columns = 0;
  for (unsigned r = 0; r < 4; ++r) {
    const unsigned in_row = (set >> (3 * r)) & 7U;
    if ((in_row & (in_row - 1)) != 0 || (columns & in_row) != 0) return false;
    columns |= in_row;
  }
  return true;
}
constexpr std::array<unsigned, term_count> all_terms() {
  std::array<unsigned, term_count> terms{};
  std::size_t n = 0;
  for (unsigned set = 0; set < 4096; ++set)
    if (is_term(set)) terms[n++] = set;
  return terms;
}
constexpr std::array<unsigned, term_count> terms_by_size = all_terms();

// Sign of the coefficient of one term: the minor of the rows and columns that it leaves, with its sign in the
// expansion.
int term_sign(unsigned set, const std::array<const Vec3*, 4>& rows) {
  std::array<int, 4> row_left{}, column_left{}, column_of_row{};
  std::size_t rows_left = 0, columns_left = 0;
  unsigned columns_used = 0;
  for (int r = 0; r < 4; ++r) {
    const unsigned in_row = (set >> (3 * r)) & 7U;
    columns_used |= in_row;
    column_of_row[static_cast<std::size_t>(r)] = in_row == 0 ? -1 : std::countr_zero(in_row);
    if (in_row == 0) row_left[rows_left++] = r;
  }
  for (int c = 0; c < 3; ++c)
    if ((columns_used >> c & 1U) == 0) column_left[columns_left++] = c;
  column_left[columns_left] = 3;  // the column of ones is never displaced

  // The permutation that sends displaced rows to their columns and the remaining rows, in order, to the remaining
  // columns.
  std::array<int, 4> permutation = column_of_row;
  for (std::size_t k = 0; k < rows_left; ++k) permutation[static_cast<std::size_t>(row_left[k])] = column_left[k];
  bool odd = false;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) odd ^= permutation[i] > permutation[j];

  const auto at = [&](std::size_t r, std::size_t c) {
    return (*rows[static_cast<std::size_t>(row_left[r])])[column_left[c]];
  };
  int sign = 1;
  switch (rows_left) {
    case 4:
      sign = orient3d_exact(*rows[0], *rows[1], *rows[2], *rows[3]);
      break;
    case 3:
      sign = orient2d_expanded({at(0, 0), at(1, 0), at(2, 0)}, {at(0, 1), at(1, 1), at(2, 1)});
      break;
    case 2:
      sign = (at(0, 0) > at(1, 0)) - (at(0, 0) < at(1, 0));
      break;
    default:
      break;  // all three coordinates displaced: the coefficient is the 1 of the last column
  }
  return odd ? -sign : sign;
}

int sign_of(double x) { return (x > 0) - (x < 0); }

}  // namespace

int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double adx = a.x() - d.x(), bdx = b.x() - d.x(), cdx = c.x() - d.x();
  const double ady = a.y() - d.y(), bdy = b.y() - d.y(), cdy = c.y() - d.y();
  const double adz = a.z() - d.z(), bdz = b.z() - d.z(), cdz = c.z() - d.z();
  const double bxcy = bdx * cdy, cxby = cdx * bdy;
  const double cxay = cdx * ady, axcy = adx * cdy;
  const double axby = adx * bdy, bxay = bdx * ady;
  const double determinant = adz * (bxcy - cxby) + bdz * (cxay - axcy) + cdz * (axby - bxay);
  const double permanent = (std::abs(bxcy) + std::abs(cxby)) * std::abs(adz) +
                           (std::abs(cxay) + std::abs(axcy)) * std::abs(bdz) +
                           (std::abs(axby) + std::abs(bxay)) * std::abs(cdz);
  // [Shewchuk 1997, 4.3: the bound A of ORIENT3D]
  constexpr double u = std::numeric_limits<double>::epsilon() / 2;
  constexpr double bound = (7 + 56 * u) * u;
  if (std::abs(determinant) > bound * permanent) return sign_of(determinant);
  // A difference rounds to zero only when it is zero, so a vanishing permanent means that all six products vanish
  // exactly.
  if (permanent == 0) return 0;
  return orient3d_expanded(a, b, c, d);
}

int orient3d_perturbed(RankedPoint a, RankedPoint b, RankedPoint c, RankedPoint d) {
  if (const int sign = orient3d_exact(a.x, b.x, c.x, d.x); sign != 0) return sign;
  std::array<const Vec3*, 4> row = {&a.x, &b.x, &c.x, &d.x};
  std::array<std::int64_t, 4> rank = {a.rank, b.rank, c.rank, d.rank};
  bool odd = false;
  for (std::size_t i = 1; i < 4; ++i)
    for (std::size_t j = i; j > 0 && rank[j] < rank[j - 1]; --j) {
      std::swap(rank[j], rank[j - 1]);
      std::swap(row[j], row[j - 1]);
      odd = !odd;
    }
  TOILE_ASSERT(rank[0] < rank[1] && rank[1] < rank[2] && rank[2] < rank[3]);
  for (std::size_t k = 1; k < terms_by_size.size(); ++k)
    if (const int sign = term_sign(terms_by_size[k], row); sign != 0) return odd ? -sign : sign;
  return 0;  // not reached: the coefficient of a triple is +-1
}

bool segment_crosses_triangle(RankedPoint p, RankedPoint q, RankedPoint a, RankedPoint b, RankedPoint c) {
  if (orient3d_perturbed(a, b, c, p) == orient3d_perturbed(a, b, c, q)) return false;
  // The line pq passes a, b and c on the same side of each edge.
  const int side = orient3d_perturbed(p, q, a, b);
  return side == orient3d_perturbed(p, q, b, c) && side == orient3d_perturbed(p, q, c, a);
}

bool segment_crosses_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  return segment_crosses_triangle(RankedPoint{p, 0}, RankedPoint{q, 1}, RankedPoint{a, 2}, RankedPoint{b, 3},
                                  RankedPoint{c, 4});
}

}  // namespace toile::internal
