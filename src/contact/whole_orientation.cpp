#include "contact/whole_orientation.hpp"

#include "core/error.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <utility>

namespace toile::internal {
namespace {

__extension__ typedef __int128 Wide;
using Whole = std::int64_t;

int sign(Wide x) { return (x > 0) - (x < 0); }

Whole difference(double a, double b) { return static_cast<Whole>(a) - static_cast<Whole>(b); }

// Sign of m0 d0 + m1 d1 + m2 d2 with |m| <= 2^123, |d| <= 2^61.  m = 2^64 high + low with 0 <= low < 2^64:
//   sum of low d <= 3 * 2^125 < 2^127,   sum of high d <= 3 * 2^120.
int sign_of_sum(const std::array<Wide, 3>& m, const std::array<Whole, 3>& d) {
  Wide high = 0, low = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    high += (m[k] >> 64) * d[k];
    low += (m[k] & Wide{0xffffffffffffffff}) * d[k];
  }
  high += low >> 64;  // rounds down: the remainder is not negative
  if (high != 0) return sign(high);
  return (low & Wide{0xffffffffffffffff}) != 0 ? 1 : 0;
}

int whole_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const std::array<const Vec3*, 3> point = {&a, &b, &c};
  std::array<std::array<Whole, 3>, 3> r;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      r[i][k] = difference((*point[i])[static_cast<Eigen::Index>(k)], d[static_cast<Eigen::Index>(k)]);
  std::array<Wide, 3> minor;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    minor[k] = Wide{r[1][l]} * r[2][m] - Wide{r[1][m]} * r[2][l];
  }
  return sign_of_sum(minor, r[0]);
}

// Some rows and columns of the determinant.  Column 3 is that of ones; it is always there.
struct Minor {
  std::array<const Vec3*, 4> row;
  std::array<int, 4> row_number, column;
  int size = 0;

  int place_of_row(int number) const {
    for (int k = 0; k < size; ++k)
      if (row_number[static_cast<std::size_t>(k)] == number) return k;
    return -1;
  }
  int place_of_column(int number) const {
    for (int k = 0; k < size; ++k)
      if (column[static_cast<std::size_t>(k)] == number) return k;
    return -1;
  }
  Minor without(int i, int j) const {
    Minor smaller;
    for (int k = 0; k < size; ++k) {
      const auto from = static_cast<std::size_t>(k);
      if (k != i) {
        const auto to = static_cast<std::size_t>(k < i ? k : k - 1);
        smaller.row[to] = row[from];
        smaller.row_number[to] = row_number[from];
      }
      if (k != j) smaller.column[static_cast<std::size_t>(k < j ? k : k - 1)] = column[from];
    }
    smaller.size = size - 1;
    return smaller;
  }
  double at(std::size_t r, std::size_t c) const { return (*row[r])[column[c]]; }
  int value_sign() const {
    switch (size) {
      case 4:
        return whole_orientation(*row[0], *row[1], *row[2], *row[3]);
      case 3: {
        const Whole px = difference(at(0, 0), at(2, 0)), py = difference(at(0, 1), at(2, 1));
        const Whole qx = difference(at(1, 0), at(2, 0)), qy = difference(at(1, 1), at(2, 1));
        return sign(Wide{px} * qy - Wide{py} * qx);
      }
      case 2:
        return (at(0, 0) > at(1, 0)) - (at(0, 0) < at(1, 0));
      default:
        return 1;  // of the ones
    }
  }
};

// Sign of a minor whose displacements 0 ... last (3 row + column, in the order of ranks) are not zero.  Each is infinitely smaller than all
// products of those before it, and the minor is linear in it: its coefficient counts only where the rest vanishes.
int perturbed_sign(const Minor& minor, int last) {
  if (last < 0) return minor.value_sign();
  if (const int rest = perturbed_sign(minor, last - 1); rest != 0) return rest;
  const int i = minor.place_of_row(last / 3), j = minor.place_of_column(last % 3);
  if (i < 0 || j < 0) return 0;
  const int coefficient = perturbed_sign(minor.without(i, j), last - 1);
  return (i + j) % 2 == 0 ? coefficient : -coefficient;
}

}  // namespace

// The six products of three differences are at most XYZ each (X: the largest difference in x, ...).  Each carries a relative error of
// three differences, two products and three sums at most, 8 * 2^-53: together less than 6 * 8 * 2^-53 XYZ (1 + 2^-49) < 2^-47 XYZ.
// Whole numbers neither overflow here nor underflow.
int whole_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = a - d, v = b - d, w = c - d;
  const double determinant = u.dot(v.cross(w));
  const Vec3 largest = u.cwiseAbs().cwiseMax(v.cwiseAbs()).cwiseMax(w.cwiseAbs());
  const double bound = 0x1p-47 * largest.prod();
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return bound == 0 ? 0 : whole_sign(a, b, c, d);
}

int perturbed_orientation(const std::array<const WholePoint*, 4>& points) {
  if (const int sign = whole_orientation(points[0]->x, points[1]->x, points[2]->x, points[3]->x); sign != 0)
    return sign;
  std::array<const WholePoint*, 4> by_rank = points;
  bool odd = false;
  for (std::size_t i = 1; i < 4; ++i)
    for (std::size_t j = i; j > 0 && by_rank[j]->rank < by_rank[j - 1]->rank; --j) {
      std::swap(by_rank[j], by_rank[j - 1]);
      odd = !odd;
    }
  TOILE_ASSERT(by_rank[0]->rank < by_rank[1]->rank && by_rank[1]->rank < by_rank[2]->rank &&
               by_rank[2]->rank < by_rank[3]->rank);
  Minor whole{{}, {0, 1, 2, 3}, {0, 1, 2, 3}, 4};
  for (std::size_t i = 0; i < 4; ++i) whole.row[i] = &by_rank[i]->x;
  const int sign = perturbed_sign(whole, 11);
  return odd ? -sign : sign;
}

bool passes_through(const WholePoint& p, const WholePoint& q, const WholePoint& a, const WholePoint& b,
                    const WholePoint& c) {
  if (perturbed_orientation({&a, &b, &c, &p}) == perturbed_orientation({&a, &b, &c, &q})) return false;
  // The line pq has a, b and c on the same side of each edge.
  const int side = perturbed_orientation({&p, &q, &a, &b});
  return side == perturbed_orientation({&p, &q, &b, &c}) && side == perturbed_orientation({&p, &q, &c, &a});
}

}  // namespace toile::internal
