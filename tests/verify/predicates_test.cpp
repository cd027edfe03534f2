// Orientation against whole-number arithmetic, and the perturbation against a literal power series.
#include "verify/predicates.hpp"

#include "support/exact.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

namespace toile::internal {
namespace {

using exact::Random;

// Compares and counts; one message for the first difference only, so that a broken predicate does not flood the log.
class Tally {
 public:
  void compare(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const int truth = exact::orient3d(a, b, c, d), answer = orient3d_exact(a, b, c, d);
    ++signs[static_cast<std::size_t>(truth + 1)];
    if (truth != answer && wrong++ == 0)
      ADD_FAILURE() << "truth " << truth << ", answer " << answer << " for\n"
                    << a.transpose() << "\n"
                    << b.transpose() << "\n"
                    << c.transpose() << "\n"
                    << d.transpose();
  }
  int wrong = 0;
  std::array<int, 3> signs{};  // how many truths were -1, 0, +1
};

Vec3 nudged(Vec3 p, Random& random, int ulps) {
  for (double& x : p)
    for (auto k = random.below(ulps + 1); k > 0; --k) x = std::nextafter(x, (random.bits() & 1) != 0 ? 1e9 : -1e9);
  return p;
}

TEST(Orient3d, IsPositiveForAPointBelowACounterClockwiseTriangle) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(orient3d_exact(a, b, c, Vec3(0.2, 0.2, -1)), 1);
  EXPECT_EQ(orient3d_exact(a, b, c, Vec3(0.2, 0.2, 1)), -1);
  EXPECT_EQ(orient3d_exact(a, b, c, Vec3(7, -5, 0)), 0);
}

TEST(Orient3d, AgreesWithWholeNumbersOnRandomPoints) {
  Random random(1);
  Tally tally;
  for (int n = 0; n < 5000; ++n)
    tally.compare(random.point(-1, 1), random.point(-1, 1), random.point(-1, 1), random.point(-1, 1));
  for (int n = 0; n < 20000; ++n)
    tally.compare(random.lattice_point(-2, 2), random.lattice_point(-2, 2), random.lattice_point(-2, 2),
                  random.lattice_point(-2, 2));
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.signs[1], 1000);  // the lattice has many coplanar quadruples
}

TEST(Orient3d, AgreesWithWholeNumbersOneUnitInTheLastPlaceFromAPlane) {
  Random random(2);
  Tally tally;
  for (int n = 0; n < 15000; ++n) {
    const Vec3 a = random.point(-1, 1), b = random.point(-1, 1), c = random.point(-1, 1);
    const Vec3 in_plane = a + random.real(-2, 2) * (b - a) + random.real(-2, 2) * (c - a);
    tally.compare(a, b, c, nudged(in_plane, random, n % 3));
    const Vec3 in_line = a + random.real(-2, 2) * (b - a);
    tally.compare(a, b, nudged(in_line, random, n % 2), c);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.signs[0], 5000);
  EXPECT_GT(tally.signs[2], 5000);
}

TEST(Orient3d, AgreesWithWholeNumbersOnCoplanarCollinearAndCoincidentPoints) {
  Random random(3);
  Tally tally;
  for (int n = 0; n < 5000; ++n) {
    // Exactly coplanar: whole-number combinations of whole-number vectors; then exactly one unit off.
    const Vec3 a = random.lattice_point(-1000, 1000), u = random.lattice_point(-1000, 1000),
               v = random.lattice_point(-1000, 1000);
    const auto combination = [&] {
      return Vec3(a + static_cast<double>(random.between(-1000, 1000)) * u +
                  static_cast<double>(random.between(-1000, 1000)) * v);
    };
    const Vec3 b = combination(), c = combination(), d = combination();
    const double scale = std::ldexp(1.0, static_cast<int>(random.between(-60, 20)));
    tally.compare(scale * a, scale * b, scale * c, scale * d);
    tally.compare(scale * a, scale * b, scale * c, scale * (d + Vec3(0, 0, 1)));
    tally.compare(scale * a, scale * (a + u), scale * (a + 2 * u), scale * d);  // collinear
    tally.compare(scale * a, scale * b, scale * b, scale * d);                  // coincident
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.signs[1], 14000);
}

// A fine grid of points around a plane through two far ones: rounding shows as a pattern of wrong signs.
TEST(Orient3d, AgreesWithWholeNumbersOnAGridOfNeighbouringDoubles) {
  Tally tally;
  const Vec3 b(12, 12, 0), c(24, 24, 0), d(17, 17, 31);
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) tally.compare(Vec3(0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53, 0.3), b, c, d);
  EXPECT_EQ(tally.wrong, 0);
}

TEST(Orient3d, AgreesWithWholeNumbersWhenCoordinatesDifferGreatlyInSize) {
  Random random(4);
  Tally tally;
  const auto wild = [&] {
    Vec3 p = random.point(-1, 1);
    for (double& x : p) x = std::ldexp(x, static_cast<int>(random.between(-120, 60)));
    return p;
  };
  for (int n = 0; n < 5000; ++n) {
    const Vec3 a = wild(), b = wild(), c = wild();
    tally.compare(a, b, c, wild());
    tally.compare(a, b, c, a + (b - a) * 0.5 + (c - a) * 0.25);
  }
  EXPECT_EQ(tally.wrong, 0);
}

TEST(Orient3d, DoesNotChangeUnderPowersOfTwoWithinItsRange) {
  Random random(5);
  for (int n = 0; n < 3000; ++n) {
    const Vec3 a = random.point(1, 2), b = random.point(1, 2), c = random.point(1, 2);
    const Vec3 d = nudged(a + 0.25 * (b - a) + 0.25 * (c - a), random, 1);
    const int sign = orient3d_exact(a, b, c, d);
    for (const int exponent : {-290, -149, 127, 320}) {
      const double s = std::ldexp(1.0, exponent);
      ASSERT_EQ(orient3d_exact(s * a, s * b, s * c, s * d), sign) << exponent;
    }
  }
}

// --- the perturbation ---------------------------------------------------------------------------------------------

// A polynomial in epsilon: exponent -> coefficient.
using Series = std::map<std::int64_t, std::int64_t>;
Series operator*(const Series& a, const Series& b) {
  Series product;
  for (const auto& [i, x] : a)
    for (const auto& [j, y] : b) product[i + j] += x * y;
  return product;
}

// The determinant of rows (x + eps, y + eps, z + eps, 1) multiplied out over all 24 permutations; the sign is that of
// its lowest power.  Coordinates are small whole numbers.
int sign_of_series(const std::array<Vec3, 4>& points, const std::array<int, 4>& rank) {
  Series determinant;
  std::array<std::size_t, 4> column = {0, 1, 2, 3};
  do {
    bool odd = false;
    Series product = {{0, 1}};
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t s = r + 1; s < 4; ++s) odd ^= column[r] > column[s];
      const auto c = static_cast<int>(column[r]);
      if (c == 3) continue;
      product =
          product * Series{{0, static_cast<std::int64_t>(points[r][c])}, {std::int64_t{1} << (3 * rank[r] + c), 1}};
    }
    for (const auto& [exponent, x] : product) determinant[exponent] += odd ? -x : x;
  } while (std::next_permutation(column.begin(), column.end()));
  for (const auto& [exponent, x] : determinant)
    if (x != 0) return x > 0 ? 1 : -1;
  return 0;
}

TEST(Perturbation, HasTheSignOfTheDeterminantAsAPowerSeries) {
  Random random(6);
  int degenerate = 0;
  for (int n = 0; n < 20000; ++n) {
    // Few values: coplanar, collinear, coincident, all four the same.
    const int values = n % 4;
    std::array<Vec3, 4> p;
    for (Vec3& x : p) x = random.lattice_point(0, values);
    std::array<int, 10> ranks;
    std::iota(ranks.begin(), ranks.end(), 0);
    random.shuffle(ranks);
    const std::array<int, 4> rank = {ranks[0], ranks[1], ranks[2], ranks[3]};
    degenerate += orient3d_exact(p[0], p[1], p[2], p[3]) == 0;
    ASSERT_EQ(orient3d_perturbed({p[0], rank[0]}, {p[1], rank[1]}, {p[2], rank[2]}, {p[3], rank[3]}),
              sign_of_series(p, rank))
        << n;
  }
  EXPECT_GT(degenerate, 5000);
}

TEST(Perturbation, ChangesSignWhenTwoPointsAreExchanged) {
  Random random(7);
  for (int n = 0; n < 5000; ++n) {
    std::array<Vec3, 4> p;
    for (Vec3& x : p) x = random.lattice_point(0, 1);
    const RankedPoint a{p[0], 5}, b{p[1], 2}, c{p[2], 9}, d{p[3], 4};
    const int sign = orient3d_perturbed(a, b, c, d);
    ASSERT_NE(sign, 0);
    ASSERT_EQ(orient3d_perturbed(b, a, c, d), -sign);
    ASSERT_EQ(orient3d_perturbed(a, c, b, d), -sign);
    ASSERT_EQ(orient3d_perturbed(a, b, d, c), -sign);
    ASSERT_EQ(orient3d_perturbed(d, b, c, a), -sign);
    ASSERT_EQ(orient3d_perturbed(b, c, a, d), sign);
  }
}

TEST(SegmentCrossesTriangle, DoesNotDependOnTheOrderOfItsPoints) {
  Random random(8);
  int crossings = 0;
  for (int n = 0; n < 5000; ++n) {
    std::array<Vec3, 5> x;
    for (Vec3& point : x) point = random.lattice_point(-2, 2);
    const RankedPoint p{x[0], 0}, q{x[1], 1}, a{x[2], 2}, b{x[3], 3}, c{x[4], 4};
    const bool crosses = segment_crosses_triangle(p, q, a, b, c);
    crossings += crosses;
    ASSERT_EQ(crosses, segment_crosses_triangle(q, p, a, b, c));
    ASSERT_EQ(crosses, segment_crosses_triangle(p, q, b, c, a));
    ASSERT_EQ(crosses, segment_crosses_triangle(p, q, c, b, a));
    ASSERT_EQ(crosses, segment_crosses_triangle(x[0], x[1], x[2], x[3], x[4]));
  }
  EXPECT_GT(crossings, 300);
}

}  // namespace
}  // namespace toile::internal
