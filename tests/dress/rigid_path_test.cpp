// How what is led moves: between keys, about its centre, and back.
#include "dress/rigid_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace toile::internal {
namespace {

RigidPath turning_and_growing() {
  return {{{1, {0, 0, 0}, {0, 0, 0}, 1}, {3, {0.4, 0, -0.2}, {0, 0, 360}, 3}, {4, {0, 0, 0}, {90, 0, 360}, 0.5}},
          Vec3(1, 2, 3)};
}

TEST(RigidPath, GoesStraightFromKeyToKeyAndStaysOutside) {
  const RigidPath path = turning_and_growing();
  const Vec3 x(1.1, 2, 3);
  EXPECT_EQ(path.place(0, x), x);
  EXPECT_EQ(path.duration_s(), 4);
  // Half of the way: half a turn about z at twice the size.
  EXPECT_LT((path.place(2, x) - Vec3(1 + 0.2 - 0.2, 2, 3 - 0.1)).norm(), 1e-14);
  EXPECT_LT((path.place(3, x) - Vec3(1 + 0.4 + 0.3, 2, 3 - 0.2)).norm(), 1e-14) << "a whole turn";
  EXPECT_LT((path.place(9, x) - Vec3(1 + 0.05, 2, 3)).norm(), 1e-14) << "stays at its last key";
  const Vec3 above(1, 2.1, 3);
  EXPECT_LT((path.place(4, above) - Vec3(1, 2, 3.05)).norm(), 1e-14) << "Rx of 90 degrees takes y to z";
}

TEST(RigidPath, AnEmptyOneMovesNothing) {
  const Vec3 x(1, 2, 3);
  EXPECT_EQ(RigidPath().place(5, x), x);
  EXPECT_EQ(RigidPath().before(5, x), x);
  EXPECT_EQ(RigidPath().fastest(1).m_per_s, 0);
}

TEST(RigidPath, BeforeIsTheWayBack) {
  const RigidPath path = turning_and_growing();
  for (const double t_s : {0.0, 1.3, 2.9, 3.7, 5.0}) {
    const Vec3 x(0.3, -0.7, 1.9);
    EXPECT_LT((path.place(t_s, path.before(t_s, x)) - x).norm(), 1e-13) << t_s;
    EXPECT_LT((path.before(t_s, path.place(t_s, x)) - x).norm(), 1e-13) << t_s;
  }
}

TEST(RigidPath, NoPointIsFasterThanTheFastestPieceSays) {
  const RigidPath path = turning_and_growing();
  const double reach = 0.25, dt = 1e-5;
  double most = 0;
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.6, 0, -0.8)})
    for (double t_s = 0; t_s < 4; t_s += 0.01) {
      const Vec3 x = path.centre() + reach * direction;
      most = std::max(most, (path.place(t_s + dt, x) - path.place(t_s, x)).norm() / dt);
    }
  const auto [key, m_per_s] = path.fastest(reach);
  EXPECT_EQ(key, 1u);
  EXPECT_GE(m_per_s, most);
  EXPECT_LT(m_per_s, 1.5 * most) << "and not far from it";
}

}  // namespace
}  // namespace toile::internal
