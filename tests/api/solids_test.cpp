// Several colliders: friction, offset and motion of each; which of them the caller leads.
#include "arrays.hpp"
#include "support/message_of.hpp"
#include "toile/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace toile {
namespace {

using test::Arrays;
using test::message_of;

constexpr double gravity = 9.81, radians = std::numbers::pi / 180;

// A level sheet that is turned about the z axis and shifted.
Cloth sheet(const Point& to, double angle_deg = 0) {
  Arrays arrays = test::level_sheet(6, 0.02, 0);
  const double c = std::cos(angle_deg * radians), s = std::sin(angle_deg * radians);
  for (Point& p : arrays.vertices_m) p = {c * p[0] - s * p[1] + to[0], s * p[0] + c * p[1] + to[1], p[2] + to[2]};
  return Cloth::from_arrays({.vertices_m = arrays.vertices_m, .faces = arrays.faces});
}

std::vector<Point> part(std::span<const Point> x, std::size_t k) {
  const std::size_t n = x.size() / 2;
  return {x.begin() + static_cast<std::ptrdiff_t>(k * n), x.begin() + static_cast<std::ptrdiff_t>((k + 1) * n)};
}

Point mean(const std::vector<Point>& x) {
  Point sum{0, 0, 0};
  for (const Point& p : x)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += p[c] / static_cast<double>(x.size());
  return sum;
}

// Two slopes of 20 degrees (tan = 0.36) side by side: what sticks on one slides on the other, as Coulomb says.
TEST(Solids, EachHasItsOwnFriction) {
  constexpr double angle_deg = 20;
  const auto slope = [&](double z_m, double friction) {
    Body solid = Body::box({4, 0.2, 0.4});
    solid.place({0, 0, z_m}, {0, 0, angle_deg}).set_friction(friction);
    return solid;
  };
  const double c = std::cos(angle_deg * radians), s = std::sin(angle_deg * radians), above = 0.1 + 2.5e-3;
  const std::vector<Cloth> cloths{sheet({-s * above, c * above, 0}, angle_deg),
                                  sheet({-s * above, c * above, 1}, angle_deg)};
  const std::vector<Body> slopes{slope(0, 0.1), slope(1, 0.6)};
  Simulation sim(cloths, Body::none(), slopes, {.air_density_kg_per_m3 = 0});
  const std::vector<Point> started(sim.positions_m().begin(), sim.positions_m().end());
  for (int k = 0; k < 30; ++k) ASSERT_TRUE(sim.advance(1.0 / 60).ok());
  const double down = -mean(part(sim.velocities_m_per_s(), 0))[0] / c;
  EXPECT_NEAR(down / (gravity * (s - 0.1 * c) * sim.time_s()), 1, 0.05);
  const Point before = mean(part(started, 1)), after = mean(part(sim.positions_m(), 1));
  EXPECT_NEAR(after[0], before[0], 1e-3);
}

TEST(Solids, EachHasItsOwnOffset) {
  const auto table = [](double x_m, double offset_m) {
    Body solid = Body::box({0.4, 0.2, 0.4});
    solid.place({x_m, -0.1, 0}).set_offset(offset_m);
    return solid;
  };
  const std::vector<Cloth> cloths{sheet({0, 0.012, 0}), sheet({1, 0.012, 0})};
  const std::vector<Body> tables{table(0, 0.003), table(1, 0.009)};
  Simulation sim(cloths, Body::none(), tables);
  for (int k = 0; k < 60; ++k) ASSERT_TRUE(sim.advance(1.0 / 60).ok());
  EXPECT_NEAR(mean(part(sim.positions_m(), 0))[1], 0.003, 3e-4);
  EXPECT_NEAR(mean(part(sim.positions_m(), 1))[1], 0.009, 3e-4);
}

// Friction and offset of a solid that says nothing are the worn body's.
TEST(Solids, WithoutTheirOwnHaveWhatTheBodyHas) {
  Body body = Body::box({0.2, 0.2, 0.2});
  body.set_offset(0.008);
  Body table = Body::box({0.4, 0.2, 0.4});
  table.place({1, -0.1, 0});
  const Cloth cloth = sheet({1, 0.012, 0});
  Simulation sim(std::span(&cloth, 1), body, std::span(&table, 1));
  for (int k = 0; k < 60; ++k) ASSERT_TRUE(sim.advance(1.0 / 60).ok());
  EXPECT_NEAR(mean({sim.positions_m().begin(), sim.positions_m().end()})[1], 0.008, 3e-4);
}

// One lift goes by itself, the other one where the caller leads it, the third stands: each carries its own sheet.
TEST(Solids, MoveByThemselvesOrAsTheyAreLedOrNot) {
  const std::vector<BodyKey> up{{0, {0, 0, 0}}, {1, {0, 0.2, 0}}};
  Body lift = Body::box({0.3, 0.02, 0.3});
  lift.place({1, -0.01, 0}).set_moves(up);
  const Arrays led = test::box({2, -0.15, 0}, 0.15);
  const std::vector<Body> solids{lift, Body::from_arrays(led.vertices_m, led.faces)};
  const std::vector<Cloth> cloths{sheet({1, 0.004, 0}), sheet({2, 0.004, 0})};
  const Body stands = Body::box({0.3, 0.02, 0.3});
  Simulation sim(cloths, stands, solids);
  ASSERT_EQ(sim.collider_count(), 3);
  EXPECT_EQ(sim.collider_positions_m(1).size() + 16, sim.body_positions_m().size());
  std::vector<Point> to = led.vertices_m;
  for (int k = 1; k <= 30; ++k) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i][1] = led.vertices_m[i][1] + 0.1 * k / 30;
    sim.set_collider(2, to);
    ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  }
  EXPECT_NEAR(mean(part(sim.positions_m(), 0))[1], 0.2, 0.006);
  EXPECT_NEAR(mean(part(sim.positions_m(), 1))[1], 0.1, 0.006);
  EXPECT_EQ(sim.collider_positions_m(2)[0], to[0]);
  EXPECT_NEAR(mean({sim.collider_positions_m(1).begin(), sim.collider_positions_m(1).end()})[1], 0.19, 1e-12);
  EXPECT_NEAR(mean({sim.collider_positions_m(0).begin(), sim.collider_positions_m(0).end()})[1], 0, 1e-12);
  EXPECT_EQ(sim.crossings().cloth_body_edges, 0);
  EXPECT_NE(message_of<Error>([&] { sim.set_collider(1, sim.collider_positions_m(1)); }).find("motion of its own"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { sim.set_collider(3, to); }).find("from 0 to 2"), std::string::npos);
}

// A state holds how far each was led: another simulation goes on with the same bits.
TEST(Solids, AreWhereTheyWereAfterAState) {
  const Arrays led = test::box({0, -0.15, 0}, 0.15);
  Body lift = Body::box({0.3, 0.02, 0.3});
  lift.place({1, -0.01, 0}).set_moves(std::vector<BodyKey>{{0, {0, 0, 0}}, {1, {0, 0.2, 0}}});
  const std::vector<Body> solids{Body::from_arrays(led.vertices_m, led.faces), lift};
  const std::vector<Cloth> cloths{sheet({0, 0.004, 0}), sheet({1, 0.004, 0})};
  const auto lead = [&](Simulation& sim, int k) {
    std::vector<Point> to = led.vertices_m;
    for (Point& p : to) p[1] += 0.005 * k;
    sim.set_collider(0, to);
    ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  };
  Simulation one(cloths, Body::none(), solids), other(cloths, Body::none(), solids);
  for (int k = 1; k <= 4; ++k) lead(one, k);
  other.set_state(one.state());
  for (int k = 5; k <= 8; ++k) {
    lead(one, k);
    lead(other, k);
  }
  EXPECT_EQ(one.state_hash(), other.state_hash());
  EXPECT_EQ(one.body_positions_m()[0], other.body_positions_m()[0]);
}

TEST(Solids, KeepClothInARoomAndOffARevolvedShape) {
  Body room = Body::box({1, 1, 1});
  room.set_inside_out().place({0, 0.5, 0});
  const std::vector<std::array<double, 2>> cone{{0, 0.3}, {0.2, 0.02}, {0, 0.02}};
  const std::vector<Body> solids{room, Body::revolved(cone)};
  const Cloth cloth = sheet({0, 0.33, 0});
  Simulation sim(std::span(&cloth, 1), Body::none(), solids);
  for (int k = 0; k < 90; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  for (const Point& p : sim.positions_m()) {
    EXPECT_GT(p[1], 0);
    EXPECT_LT(std::abs(p[0]), 0.5);
  }
  EXPECT_EQ(sim.crossings().cloth_body_edges, 0);
}

TEST(Solids, ThatCannotBeMeantAreRefused) {
  const Cloth cloth = sheet({0, 0.5, 0});
  const auto made = [&](const Body& body, const std::vector<Body>& solids) {
    return message_of<InputError>([&] { const Simulation sim(std::span(&cloth, 1), body, solids); });
  };
  Body placed = Body::sphere(0.1);
  placed.place({1, 0, 0});
  EXPECT_NE(made(placed, {}).find("body: expected a body that stands where it was made"), std::string::npos);
  EXPECT_NE(made(Body::none(), {Body::none()}).find("solids: expected surfaces"), std::string::npos);
  Body fast = Body::sphere(0.1);
  fast.set_moves(std::vector<BodyKey>{{0, {0, 0, 0}}, {0.1, {100, 0, 0}}});
  EXPECT_NE(made(Body::none(), {fast}).find("no point faster than"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { Body::sphere(-1); }).find("radius_m"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { Body::box({1, 0, 1}); }).find("size_m"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] {
              fast.set_moves(std::vector<BodyKey>{{1}, {1}});
            }).find("ascend"),
            std::string::npos);
  EXPECT_NE(made(Body::none(), {Body::capsule(0.1, {0, 1, 0}, {0, 1, 0})}).find("another place"), std::string::npos);
  EXPECT_NE(made(Body::none(), {Body::revolved(std::vector<std::array<double, 2>>{{0, 0}, {1, 1}})}).find("profile"),
            std::string::npos);
}

}  // namespace
}  // namespace toile
