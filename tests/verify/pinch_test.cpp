// Which crossings lie where the body itself leaves no room, and what is inside.
#include "verify/pinch.hpp"

#include "support/box.hpp"
#include "verify/interior.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace toile::internal {
namespace {

struct Solid {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;

  // 60 x 60 cm, its top at the height `top_m`.
  void add_slab(double top_m, double thickness_m) {
    const auto first = static_cast<Index>(x.size());
    for (const double y : {top_m - thickness_m, top_m})
      for (const double z : {-0.3, 0.3})
        for (const double u : {-0.3, 0.3}) x.emplace_back(u, y, z);
    for (const auto& [a, b, c] : test::box_triangles) triangles.push_back({a + first, b + first, c + first});
  }
};

// 10 cm thick: the lower one's top at 0, the upper one's bottom at `gap_m`.
struct Slabs : Solid {
  explicit Slabs(double gap_m) {
    add_slab(0, 0.1);
    add_slab(gap_m + 0.1, 0.1);
  }
  // Of one triangle whose tip, at `tip`, pokes into something from 1 cm above it.
  std::size_t outside(const Vec3& tip, int& all) const {
    const std::vector<Vec3> cloth = {tip, tip + Vec3(0.011, 0.01, 0.003), tip + Vec3(-0.007, 0.01, 0.004)};
    const std::vector<Triangle> one = {{0, 1, 2}};
    const std::vector<Crossing> crossings = find_body_crossings(one, cloth, triangles, x);
    all = static_cast<int>(crossings.size());
    return outside_pinches(crossings, one, cloth, triangles, x).size();
  }
};

TEST(Pinches, ACrossingWithinAnotherPartOfTheBodyLiesInOne) {
  int all = 0;
  EXPECT_EQ(Slabs(-0.03).outside(Vec3(0.1, -0.005, 0.05), all), 0u)
      << "through the lower one's top, within the upper one";
  EXPECT_GT(all, 0);
  EXPECT_EQ(Slabs(-0.03).outside(Vec3(0.1, -0.035, 0.05), all), 0u)
      << "through the upper one's bottom, within the lower one";
  EXPECT_GT(all, 0);
}

TEST(Pinches, AnEdgeThroughAllOfItPassesTwoFacesThatLieInOne) {
  // From above both to below both: in by the upper one's top, where the bottom of the one and the top of the other are, out by the lower
  // one's bottom.  No end of it is near a pinch.
  const Slabs slabs(-0.03);
  const std::vector<Vec3> cloth = {{0.1, 0.2, 0.05}, {0.11, -0.2, 0.05}, {0.09, -0.2, 0.06}};
  const std::vector<Triangle> one = {{0, 1, 2}};
  const std::vector<Crossing> crossings = find_body_crossings(one, cloth, slabs.triangles, slabs.x);
  const std::vector<Crossing> outside = outside_pinches(crossings, one, cloth, slabs.triangles, slabs.x);
  EXPECT_EQ(2 * outside.size(), crossings.size());
  EXPECT_GT(outside.size(), 0u);
  for (const Crossing& crossing : outside) EXPECT_TRUE(crossing.position.y() > 0.069 || crossing.position.y() < -0.099);
}

TEST(Pinches, ACrossingBeforeANearFaceThatLooksBackLiesInOne) {
  int all = 0;
  EXPECT_EQ(Slabs(0.0029).outside(Vec3(0.1, -0.009, 0.05), all), 0u);
  EXPECT_GT(all, 0);
}

TEST(Pinches, WhereTheBodyLeavesRoomThereIsNone) {
  int all = 0;
  EXPECT_GT(Slabs(0.02).outside(Vec3(0.1, -0.005, 0.05), all), 0u) << "2 cm of room";
  EXPECT_GT(Slabs(0.0031).outside(Vec3(0.1, -0.001, 0.05), all), 0u) << "two offsets, and a hair more";
  EXPECT_GT(Slabs(-0.03).outside(Vec3(0.1, 0.065, 0.05), all), 0u) << "the upper one's top";
  EXPECT_GT(Slabs(1).outside(Vec3(0.1, -0.005, 0.05), all), 0u);
  // The back of a thin thing is nearer than 3 mm, and looks away.
  Solid plate;
  plate.add_slab(0, 0.002);
  const std::vector<Vec3> cloth = {{0.1, -0.001, 0.05}, {0.11, 0.01, 0.05}, {0.09, 0.01, 0.06}};
  const std::vector<Triangle> one = {{0, 1, 2}};
  const std::vector<Crossing> crossings = find_body_crossings(one, cloth, plate.triangles, plate.x);
  ASSERT_GT(crossings.size(), 0u);
  EXPECT_EQ(outside_pinches(crossings, one, cloth, plate.triangles, plate.x).size(), crossings.size());
}

TEST(Pinches, AnEdgeThatLeadsOutOfOneHasToComeOutSomewhere) {
  // From within both slabs, which overlap by 3 cm, past the rim at x = 0.3, through the lower one's side.
  const Slabs slabs(-0.03);
  const std::vector<Vec3> cloth = {{0.29, -0.015, 0.05}, {0.32, -0.05, 0.06}, {0.32, -0.05, 0.04}};
  const std::vector<Triangle> one = {{0, 1, 2}};
  const std::vector<Crossing> crossings = find_body_crossings(one, cloth, slabs.triangles, slabs.x);
  ASSERT_GT(crossings.size(), 0u);
  for (const Crossing& crossing : crossings) EXPECT_LT(crossing.position.y(), -0.0251) << "out of the lower one alone";
  EXPECT_EQ(outside_pinches(crossings, one, cloth, slabs.triangles, slabs.x).size(), 0u);
}

TEST(Pinches, AnEdgeOfTheBodyThroughClothIsAskedToo) {
  const auto outside = [](double gap_m, std::size_t& all) {
    const Slabs slabs(gap_m);
    // Around the lower slab's upper edge at x = 0.3, and through none of its own edges.
    const std::vector<Vec3> cloth = {{0.29, 0.01, 0.005}, {0.305, -0.02, 0.005}, {0.305, 0.02, 0.011}};
    const std::vector<Triangle> one = {{0, 1, 2}};
    std::vector<Crossing> crossings;
    for (const Crossing& crossing : find_body_crossings(one, cloth, slabs.triangles, slabs.x))
      if (crossing.edge_of_body) crossings.push_back(crossing);
    all = crossings.size();
    return outside_pinches(crossings, one, cloth, slabs.triangles, slabs.x).size();
  };
  std::size_t all = 0;
  EXPECT_EQ(outside(1, all), all);
  EXPECT_GT(all, 0u);
}

TEST(Winding, CountsThePartsAroundAPoint) {
  const Slabs slabs(-0.03);
  const ClosedSurface closed(slabs.triangles, slabs.x);
  EXPECT_EQ(closed.winding_number(Vec3(0.1, -0.01, 0.05)), 2);
  EXPECT_EQ(closed.winding_number(Vec3(0.1, -0.05, 0.05)), 1);
  EXPECT_EQ(closed.winding_number(Vec3(0.1, 0.5, 0.05)), 0);
  std::vector<Triangle> open(slabs.triangles.begin(), slabs.triangles.end() - 1);  // a hole is closed by a fan
  EXPECT_EQ(ClosedSurface(open, slabs.x).winding_number(Vec3(0.1, -0.01, 0.05)), 2);
}

// A room of 2 m, a box of 20 cm in it that has a hollow, and a box that sticks out through the room's wall.
struct Room {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;

  Room() {
    add(Vec3::Zero(), 2, true);
    add(Vec3::Zero(), 0.2, false);
    add(Vec3::Zero(), 0.1, true);
    add(Vec3(1, 0, 0), 0.4, false);
  }
  void add(const Vec3& middle, double edge_m, bool inwards) {
    const auto first = static_cast<Index>(x.size());
    const double half = 0.5 * edge_m;
    for (const double y : {-half, half})
      for (const double z : {-half, half})
        for (const double u : {-half, half}) x.push_back(middle + Vec3(u, y, z));
    for (auto [a, b, c] : test::box_triangles) {
      if (inwards) std::swap(b, c);
      triangles.push_back({a + first, b + first, c + first});
    }
  }
};

TEST(Interior, OfARoomIsItsWallAndOfAHollowItsShell) {
  const Room room;
  const Interior interior(room.triangles, room.x);
  EXPECT_EQ(interior.depth(Vec3(0.5, 0.3, 0.2)), 0) << "in the room";
  EXPECT_EQ(interior.depth(Vec3(0.073, 0.02, 0.01)), 1) << "in the box's shell";
  EXPECT_EQ(interior.depth(Vec3(0.02, 0.01, 0.013)), 0) << "in its hollow";
  EXPECT_EQ(interior.depth(Vec3(0.93, 0.05, 0.02)), 1) << "in the other box";
  EXPECT_EQ(interior.depth(Vec3(1.07, 0.05, 0.02)), 2) << "where it is in the wall";
  EXPECT_EQ(interior.depth(Vec3(3, 0.1, 0.2)), 1) << "outside of the room is wall";
  const Room other;
  EXPECT_EQ(Interior(std::span(other.triangles).subspan(12), other.x).depth(Vec3(3, 0.1, 0.2)), 0) << "without rooms";
}

}  // namespace
}  // namespace toile::internal
