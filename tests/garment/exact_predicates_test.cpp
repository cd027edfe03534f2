// The predicates at the ends of their bit budget, where any narrower arithmetic gives a wrong sign.
#include "garment/exact_predicates.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace toile::internal {
namespace {

constexpr std::int32_t last_coordinate = (1 << 25) - 1;

TEST(ExactPredicates, SeeOneGridStepAcrossThirtyTwoMetres) {
  const GridPoint a{-last_coordinate, -last_coordinate}, b{last_coordinate, last_coordinate};
  EXPECT_EQ(orient2d(a, b, {0, 0}), 0);
  EXPECT_EQ(orient2d(a, b, {0, 1}), 2 * std::int64_t{last_coordinate});
  EXPECT_EQ(orient2d(a, b, {1, 0}), -2 * std::int64_t{last_coordinate});
  EXPECT_EQ(orient2d({-last_coordinate, -last_coordinate}, {last_coordinate, -last_coordinate},
                     {-last_coordinate, last_coordinate}),
            4 * std::int64_t{last_coordinate} * last_coordinate);
}

TEST(ExactPredicates, CallFourPointsOfOneCircleCocircularAndOneGridStepOffIt) {
  const GridPoint a{-last_coordinate, -last_coordinate}, b{last_coordinate, -last_coordinate},
      c{last_coordinate, last_coordinate};
  EXPECT_EQ(incircle(a, b, c, {-last_coordinate, last_coordinate}), 0);
  EXPECT_EQ(incircle(a, b, c, {-last_coordinate + 1, last_coordinate}), 1);
  EXPECT_EQ(incircle(a, b, c, {-last_coordinate, last_coordinate - 1}), 1);
  EXPECT_EQ(incircle(a, b, c, {-last_coordinate, last_coordinate + 1}), -1);
  EXPECT_EQ(incircle(a, b, c, {-last_coordinate - 1, last_coordinate}), -1);
}

TEST(ExactPredicates, CallTheWholeLatticeCircleOfALargePythagoreanRadiusCocircular) {
  // x^2 + y^2 = (5 * 13 * 17 * 29 * 37 * 28)^2 has many integer solutions built from Pythagorean triples.
  const std::int32_t r = 5 * 13 * 17 * 29 * 37 * 28;
  std::vector<GridPoint> circle;
  constexpr std::array<std::array<std::int32_t, 3>, 5> triples{
      {{3, 4, 5}, {5, 12, 13}, {8, 15, 17}, {20, 21, 29}, {12, 35, 37}}};
  for (const auto& [p, q, h] : triples)
    for (const std::int32_t s : {-1, 1})
      for (const std::int32_t t : {-1, 1}) {
        circle.push_back({s * p * (r / h), t * q * (r / h)});
        circle.push_back({s * q * (r / h), t * p * (r / h)});
      }
  int checked = 0;
  for (std::size_t i = 0; i < circle.size(); ++i)
    for (std::size_t j = 0; j < circle.size(); ++j)
      for (std::size_t k = 0; k < circle.size(); ++k) {
        if (orient2d(circle[i], circle[j], circle[k]) <= 0) continue;
        const GridPoint& d = circle[(i + 3 * j + 7 * k) % circle.size()];
        EXPECT_EQ(incircle(circle[i], circle[j], circle[k], d), 0);
        const GridPoint inward{d.x - (d.x > 0 ? 1 : -1), d.y}, outward{d.x, d.y + (d.y > 0 ? 1 : -1)};
        EXPECT_EQ(incircle(circle[i], circle[j], circle[k], inward), 1);
        EXPECT_EQ(incircle(circle[i], circle[j], circle[k], outward), -1);
        ++checked;
      }
  EXPECT_GT(checked, 10000);
}

TEST(ExactPredicates, DoNotDependOnTheOrderOfTheCorners) {
  std::mt19937_64 random(7);
  const auto coordinate = [&] { return static_cast<std::int32_t>(random() >> 38) - (1 << 25) + 1; };  // 26 bits
  for (int i = 0; i < 20000; ++i) {
    GridPoint a{coordinate(), coordinate()}, b{coordinate(), coordinate()}, c{coordinate(), coordinate()};
    const GridPoint d{coordinate(), coordinate()};
    if (orient2d(a, b, c) < 0) std::swap(b, c);
    EXPECT_EQ(orient2d(a, b, c), orient2d(b, c, a));
    EXPECT_EQ(orient2d(a, b, c), -orient2d(b, a, c));
    EXPECT_EQ(incircle(a, b, c, d), incircle(b, c, a, d));
    // d inside abc's circle and b inside acd's are the same statement when abcd is convex.
    if (orient2d(a, c, d) > 0 && orient2d(a, b, d) > 0 && orient2d(b, c, d) > 0) {
      EXPECT_EQ(incircle(a, b, c, d), incircle(a, c, d, b));
    }
  }
}

}  // namespace
}  // namespace toile::internal
