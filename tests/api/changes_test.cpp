// What changes between two frames: friction, stiffness, and what the body carries.
#include "arrays.hpp"
#include "toile/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace toile {
namespace {

using test::Arrays;

constexpr double slope_radians = std::numbers::pi / 180, slope_deg = 20;

Body slope() {
  Body solid = Body::box({4, 0.2, 0.4});
  solid.place({0, 0, 0}, {0, 0, slope_deg}).set_friction(0.6);
  return solid;
}

Cloth on_slope() {
  Arrays arrays = test::level_sheet(6, 0.02, 0.1 + 2.5e-3);
  const double c = std::cos(slope_deg * slope_radians), s = std::sin(slope_deg * slope_radians);
  for (Point& p : arrays.vertices_m) p = {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
  return Cloth::from_arrays({.vertices_m = arrays.vertices_m, .faces = arrays.faces});
}

double mean_x(const Simulation& sim) {
  double sum = 0;
  for (const Point& p : sim.positions_m()) sum += p[0] / static_cast<double>(sim.positions_m().size());
  return sum;
}

TEST(Changes, ASheetBeginsToSlideWhenItsFrictionIsGone) {
  const Cloth cloth = on_slope();
  const Body solid = slope();
  Simulation sim(std::span(&cloth, 1), Body::none(), std::span(&solid, 1), {.air_density_kg_per_m3 = 0});
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(sim.advance(1.0 / 60).ok());
  const double stuck = mean_x(sim);
  EXPECT_NEAR(stuck, -0.1025 * std::sin(slope_deg * slope_radians), 1e-3);
  sim.set_friction(0, 0.1);
  const State changed = sim.state();
  const auto slide = [](Simulation& one) {
    for (int k = 0; k < 20; ++k) ASSERT_TRUE(one.advance(1.0 / 60).ok());
  };
  slide(sim);
  const double t_s = 20 / 60.0, c = std::cos(slope_deg * slope_radians), s = std::sin(slope_deg * slope_radians);
  EXPECT_NEAR((stuck - mean_x(sim)) / (0.5 * 9.81 * (s - 0.1 * c) * t_s * t_s * c), 1, 0.1);
  Simulation other(std::span(&cloth, 1), Body::none(), std::span(&solid, 1), {.air_density_kg_per_m3 = 0});
  other.set_state(changed);
  slide(other);
  EXPECT_EQ(other.state_hash(), sim.state_hash()) << "a state knows the friction";
}

// Held by its upper edge it hangs longer the softer it is; its extension is weight over stiffness.
TEST(Changes, APanelThatSoftensHangsLonger) {
  const Arrays arrays = test::level_sheet(10, 0.03, 0);
  std::vector<Point> upright = arrays.vertices_m;
  for (Point& p : upright) p = {p[0], -p[2], 0};
  Fabric fabric = toile::fabric("cotton");
  fabric.strain_limit = 0;
  Cloth cloth = Cloth::from_arrays({.vertices_m = upright, .faces = arrays.faces});
  cloth.set_fabric(fabric);
  Simulation sim(cloth);
  std::vector<std::int32_t> edge;
  for (std::size_t i = 0; i < upright.size(); ++i)
    if (upright[i][1] > 0.149) edge.push_back(static_cast<std::int32_t>(i));
  ASSERT_EQ(edge.size(), 11U);
  sim.pin(edge);
  const auto longer_by = [&] {
    for (int k = 0; k < 90; ++k) EXPECT_TRUE(sim.advance(1.0 / 30).ok());
    double lowest = 0;
    for (const Point& p : sim.positions_m()) lowest = std::min(lowest, p[1]);
    return -0.15 - lowest;
  };
  const double usual = longer_by();
  sim.set_stiffness(0, {.stretch = 0.1, .shear = 0.1});
  const State changed = sim.state();
  const double soft = longer_by();
  EXPECT_NEAR(soft / usual, 10, 1);
  Simulation other(cloth);
  other.set_state(changed);
  for (int k = 0; k < 90; ++k) ASSERT_TRUE(other.advance(1.0 / 30).ok());
  EXPECT_EQ(other.state_hash(), sim.state_hash()) << "a state knows the stiffness";
  sim.set_stiffness(0, {});
  EXPECT_NEAR(longer_by() / usual, 1, 0.05);
  EXPECT_THROW(sim.set_stiffness(1, {}), InputError);
  EXPECT_THROW(sim.set_stiffness(0, {.bend = 0}), InputError);
}

// What lifts a sheet, and what a state knows of it.
TEST(Changes, PressureBetweenFrames) {
  const Arrays arrays = test::level_sheet(6, 0.03, 0);
  Cloth cloth = Cloth::from_arrays({.vertices_m = arrays.vertices_m, .faces = arrays.faces});
  cloth.set_name("sheet");
  Fabric fabric = toile::fabric("cotton");
  fabric.density_kg_per_m2 = 0.2;
  cloth.set_fabric(fabric).set_panel_pressure("sheet", 0.2 * 9.81);
  SimulationOptions options;
  options.air_density_kg_per_m3 = 0;
  Simulation sim(cloth, Body::none(), options);
  const auto height = [](const Simulation& of) {
    double mean = 0;
    for (const Point& p : of.positions_m()) mean += p[1] / static_cast<double>(of.positions_m().size());
    return mean;
  };
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  EXPECT_NEAR(height(sim), 0, 1e-6) << "it carries the weight";
  sim.set_pressure(0, 2 * 0.2 * 9.81);
  const State changed = sim.state();
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  EXPECT_NEAR(height(sim), 0.5 * 9.81 * 0.25, 0.1) << "as much again lifts it";
  Simulation other(cloth, Body::none(), options);
  other.set_state(changed);
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(other.advance(1.0 / 30).ok());
  EXPECT_EQ(other.state_hash(), sim.state_hash()) << "a state knows the pressure";
  sim.reset();
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  EXPECT_NEAR(height(sim), 0, 1e-6) << "as it was made";
  EXPECT_THROW(sim.set_pressure(1, 5), InputError);
  EXPECT_THROW(sim.set_pressure(0, std::nan("")), InputError);
  EXPECT_THROW(cloth.set_panel_pressure("sheet", 1e6), InputError);
  cloth.set_panel_pressure("other", 5);
  EXPECT_THROW(Simulation(cloth, Body::none(), options), InputError) << "no such panel";
}

// A flag on a pole that turns once around.
TEST(Changes, WhatIsAttachedGoesWithTheBodyUntilItIsReleased) {
  const Cloth cloth = [] {
    Arrays arrays = test::level_sheet(6, 0.03, 0);
    for (Point& p : arrays.vertices_m) p = {p[0] + 0.12, p[2], 0};
    return Cloth::from_arrays({.vertices_m = arrays.vertices_m, .faces = arrays.faces});
  }();
  Body pole = Body::box({0.04, 0.4, 0.04});
  pole.set_friction(0);  // the flag falls along it
  pole.set_moves(std::vector<BodyKey>{{.t_s = 0}, {.t_s = 2, .shift_m = {0, 0.1, 0}, .rotation_deg = {0, 180, 0}}});
  const auto make = [&] { return Simulation(std::span(&cloth, 1), Body::none(), std::span(&pole, 1)); };
  Simulation sim = make();
  std::vector<std::int32_t> edge;
  const std::vector<Point> start(sim.positions_m().begin(), sim.positions_m().end());
  for (std::size_t i = 0; i < start.size(); ++i)
    if (start[i][0] < 0.031) edge.push_back(static_cast<std::int32_t>(i));
  ASSERT_EQ(edge.size(), 7U);
  sim.attach(edge);
  EXPECT_EQ(sim.pinned(), edge);
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  Simulation other = make();
  other.set_state(sim.state());
  for (int k = 0; k < 45; ++k) {
    ASSERT_TRUE(sim.advance(1.0 / 30).ok());
    ASSERT_TRUE(other.advance(1.0 / 30).ok());
  }
  for (const std::int32_t i : edge) {
    const Point &from = start[static_cast<std::size_t>(i)], &now = sim.positions_m()[static_cast<std::size_t>(i)];
    EXPECT_NEAR(now[0], -from[0], 1e-6);
    EXPECT_NEAR(now[1], from[1] + 0.1, 1e-6);
    EXPECT_NEAR(now[2], -from[2], 1e-6);
  }
  EXPECT_EQ(other.state_hash(), sim.state_hash()) << "a state knows what is attached, and where";
  EXPECT_THROW(sim.move_pins(edge, std::vector<Point>(edge.size())), InputError) << "the body moves it";
  sim.release(edge);
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  const auto first = static_cast<std::size_t>(edge[0]);
  const double fall_m = start[first][1] + 0.1 - sim.positions_m()[first][1];
  EXPECT_NEAR(fall_m, 0.5 * 9.81 * 0.25, 0.05) << "through air";
  Simulation alone(cloth);
  EXPECT_THROW(alone.attach(edge), Error) << "nothing to hold on to";
}

// The same in a scene file: friction, stiffness and what the body carries.
TEST(Changes, AreKeyedInAScene) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "toile_changes_scene.json";
  const auto lowest_after = [&](const std::string& cloth, const std::string& rest, double seconds) {
    std::ofstream(file) << R"({"cloth": [{"name": "sheet", "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.04}, )"
                        << cloth << "}]" << rest << R"(, "world": {"air_density_kg_per_m3": 0}})";
    Simulation sim = Simulation::from_scene(file.string());
    for (int k = 0; k < static_cast<int>(30 * seconds); ++k) EXPECT_TRUE(sim.advance(1.0 / 30).ok());
    double lowest = 1e9;
    for (const Point& p : sim.positions_m()) lowest = std::min(lowest, p[1]);
    return lowest;
  };
  const std::string hangs =
      R"("pins": [{"in_box_m": [[-1, 0.099, -1], [1, 0.101, 1]]}], "fabric": {"base": "cotton", "strain_limit": 0})";
  const double usual = -0.1 - lowest_after(hangs, "", 2);
  const double soft =
      -0.1 -
      lowest_after(hangs + R"(, "panels": {"sheet": {"stiffness_path": [[0.5, 1, 1, 1], [1, 0.05, 0.05, 1]]}})", "", 2);
  EXPECT_GT(soft, 5 * usual);
  // On a slope that gets slippery; and glued to a lift.
  const std::string lies = R"("placement": {"translation_m": [0, 0.104, 0], "rotation_deg": [-90, 0, 0]})";
  const auto tilted = [](const std::string& path) {
    return R"(, "solids": [{"box": {"size_m": [3, 0.2, 3]}, "friction": 0.9, "moves": [{"t_s": 0}, {"t_s": 0.5, "rotation_deg": [0, 0, 20]}])" +
           path + "}]";
  };
  const double sticks = lowest_after(lies, tilted(""), 1.2);
  const double slides = lowest_after(lies, tilted(R"(, "friction_path": [[0.5, 0.9], [0.6, 0.05]])"), 1.2);
  EXPECT_LT(slides, sticks - 0.1);
  const std::string glued = lies + R"(, "pins": [{"in_box_m": [[-1, -1, -1], [1, 1, 1]], "hold": "body"}])";
  const double lifted = lowest_after(
      glued,
      R"(, "solids": [{"box": {"size_m": [1, 0.2, 1]}, "moves": [{"t_s": 0}, {"t_s": 1, "shift_m": [0, 0.5, 0]}]}])",
      1.2);
  EXPECT_NEAR(lifted, 0.604, 1e-6);
  std::ofstream(file) << R"({"cloth": [{"grid": {}, "pins": [{"near_m": [0, 0, 0], "hold": "body"}]}]})";
  try {
    Simulation::from_scene(file.string());
    ADD_FAILURE() << "there is no body";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/cloth/0/pins/0/hold: expected a body or a solid"), std::string::npos)
        << error.what();
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace toile
