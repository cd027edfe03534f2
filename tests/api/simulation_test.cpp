// The library as a caller uses it: include/toile/ alone.
#include "toile/simulation.hpp"

#include "arrays.hpp"
#include "support/message_of.hpp"
#include "support/paths.hpp"
#include "toile/version.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <thread>

namespace toile {
namespace {

using test::Arrays;
using test::message_of;

Cloth sheet(double height_m, int cells = 12, double edge_m = 0.03) {
  const Arrays arrays = test::level_sheet(cells, edge_m, height_m);
  return Cloth::from_arrays({.vertices_m = arrays.vertices_m, .faces = arrays.faces});
}

Body block(double half_m = 0.15) {
  const Arrays arrays = test::box({0, 0, 0}, half_m);
  return Body::from_arrays(arrays.vertices_m, arrays.faces);
}

TEST(Simulation, FallsAsFreelyAsAStone) {
  Simulation sim(sheet(1), Body::none(), {.air_density_kg_per_m3 = 0});
  for (int k = 0; k < 12; ++k) ASSERT_TRUE(sim.advance(1.0 / 60).ok());
  EXPECT_NEAR(sim.time_s(), 0.2, 1e-12);
  for (const Point& v : sim.velocities_m_per_s()) EXPECT_NEAR(v[1], -9.81 * 0.2, 1e-6);
}

TEST(Simulation, ClothOfArraysKeepsTheOrderOfVerticesFacesAndPanels) {
  Arrays arrays = test::level_sheet(4, 0.05, 0.5);
  std::vector<std::int32_t> panel(arrays.faces.size(), 0);
  panel.back() = 1;
  const std::vector<std::string> names{"front", "pocket"};
  const Cloth cloth = Cloth::from_arrays(
      {.vertices_m = arrays.vertices_m, .faces = arrays.faces, .panel = panel, .panel_names = names});
  const Simulation sim(cloth);
  EXPECT_TRUE(std::equal(sim.positions_m().begin(), sim.positions_m().end(), arrays.vertices_m.begin()));
  EXPECT_TRUE(std::equal(sim.faces().begin(), sim.faces().end(), arrays.faces.begin(), arrays.faces.end()));
  EXPECT_TRUE(std::equal(sim.panel().begin(), sim.panel().end(), panel.begin(), panel.end()));
  EXPECT_EQ(sim.panel_names(), names);
}

// Cut as it starts: nothing is strained, so without weight nothing moves.
TEST(Simulation, ClothWithoutDrawingIsAtRestAsItStarts) {
  Arrays arrays = test::level_sheet(8, 0.03, 0);
  for (Point& p : arrays.vertices_m) p = {p[0] + 0.3 * p[2], 0.2 * p[0], p[2]};  // a slope, cut obliquely
  Simulation sim(Cloth::from_arrays({.vertices_m = arrays.vertices_m, .faces = arrays.faces}), Body::none(),
                 {.gravity_m_per_s2 = {0, 0, 0}, .air_density_kg_per_m3 = 0});
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  for (std::size_t i = 0; i < arrays.vertices_m.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(sim.positions_m()[i][c], arrays.vertices_m[i][c], 1e-9);
}

// A drawing of twice the width: the cloth pushes outwards.
TEST(Simulation, RestsAsItWasCutNotAsItStarts) {
  const Arrays arrays = test::level_sheet(6, 0.03, 0);
  std::vector<CornerUvs> uv;
  for (const Face& face : arrays.faces) {
    CornerUvs& corners = uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& p = arrays.vertices_m[static_cast<std::size_t>(face[k])];
      corners[k] = {-p[2], -1.2 * p[0]};
    }
  }
  Simulation sim(Cloth::from_arrays({.vertices_m = arrays.vertices_m, .faces = arrays.faces, .uv_m = uv}), Body::none(),
                 {.gravity_m_per_s2 = {0, 0, 0}});
  ASSERT_TRUE(sim.advance(0.5).ok());
  const auto x = sim.positions_m();
  EXPECT_GT(x[6][0] - x[0][0], 1.05 * 6 * 0.03);
}

TEST(Simulation, PinsHoldAndAreLedToTheBit) {
  Simulation sim(sheet(1));
  const std::vector<std::int32_t> corners{0, 12};
  sim.pin(corners);
  EXPECT_EQ(sim.pinned(), corners);
  const Point first = sim.positions_m()[0];
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  EXPECT_EQ(sim.positions_m()[0], first);
  EXPECT_LT(sim.positions_m()[168][1], first[1] - 0.05) << "the far side hangs";
  const std::vector<Point> to{{first[0] - 0.01, 1.03, 0.2}, {first[0] + 0.35, 1.01, 0.2}};
  sim.move_pins(corners, to);
  ASSERT_TRUE(sim.advance(0.1).ok());
  EXPECT_EQ(sim.positions_m()[0], to[0]);
  ASSERT_TRUE(sim.advance(0.1).ok());
  EXPECT_EQ(sim.positions_m()[12], to[1]) << "there it stays";
  sim.release(std::vector<std::int32_t>{0});
  ASSERT_TRUE(sim.advance(0.1).ok());
  EXPECT_LT(sim.positions_m()[0][1], to[0][1] - 0.01);
  EXPECT_EQ(sim.pinned(), std::vector<std::int32_t>{12});
}

TEST(Simulation, AHandPullsAndLetsGo) {
  Simulation sim(sheet(1), Body::none(), {.gravity_m_per_s2 = {0, 0, 0}});
  const int hand = sim.grab({.face = 100, .stiffness_N_per_m = 200, .max_force_N = 20});
  const Point from = sim.positions_m()[static_cast<std::size_t>(sim.faces()[100][0])];
  for (int k = 1; k <= 30; ++k) {
    sim.drag(hand, {from[0], from[1] + 0.01 * k, from[2]});
    ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  }
  EXPECT_NEAR(sim.positions_m()[static_cast<std::size_t>(sim.faces()[100][0])][1], from[1] + 0.3, 0.05);
  for (int k = 0; k < 30; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  EXPECT_NEAR(sim.positions_m()[static_cast<std::size_t>(sim.faces()[100][0])][1], from[1] + 0.3, 5e-3)
      << "a hand that is told nothing rests where it is";
  sim.let_go(hand);
  EXPECT_NE(message_of<InputError>([&] { sim.drag(hand, from); }).find("hand"), std::string::npos);
  ASSERT_TRUE(sim.advance(1.0 / 30).ok());
}

TEST(Simulation, LiesOnABodyThatTheCallerLeads) {
  Simulation sim(sheet(0.16), block());
  EXPECT_EQ(sim.dress(4).ended, "still");
  double top = sim.positions_m()[84][1];
  EXPECT_NEAR(top, 0.15 + 0.0025, 1e-3);
  const Arrays lifted = test::box({0, 0.1, 0}, 0.15);
  for (int k = 1; k <= 20; ++k) {
    sim.set_body(test::box({0, 0.005 * k, 0}, 0.15).vertices_m);
    ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  }
  EXPECT_TRUE(std::equal(lifted.vertices_m.begin(), lifted.vertices_m.end(), sim.body_positions_m().begin(),
                         [](const Point& a, const Point& b) { return std::abs(a[1] - b[1]) < 1e-12; }));
  EXPECT_NEAR(sim.positions_m()[84][1], top + 0.1, 2e-3);
  const Crossings crossings = sim.crossings();
  EXPECT_EQ(crossings.cloth_body_edges, 0);
  EXPECT_EQ(crossings.cloth_cloth_edges, 0);
}

TEST(Simulation, TheTimeThatDressingMayTakeIsForDressingAlone) {
  Simulation sim(sheet(0.16), block());
  const DressReport cut = sim.dress(4, 1e-9);
  EXPECT_EQ(cut.ended, "time_limit");
  EXPECT_FALSE(cut.ok());
  for (int k = 0; k < 3; ++k) {
    const StepReport step = sim.advance(1.0 / 30);
    EXPECT_TRUE(step.ok()) << step.explain();
  }
  EXPECT_GT(sim.time_s(), 0.09);
}

TEST(Simulation, FollowsABodyOfFrames) {
  std::vector<Point> frames;
  for (int k = 0; k <= 30; ++k) {
    const Arrays then = test::box({0, 0.1 * k / 30.0, 0}, 0.15);
    frames.insert(frames.end(), then.vertices_m.begin(), then.vertices_m.end());
  }
  Simulation sim(sheet(0.16), Body::from_frames(frames, 8, test::box({0, 0, 0}, 1).faces, 30));
  sim.dress(4);
  const double top = sim.positions_m()[84][1];
  for (int k = 0; k < 30; ++k) {
    if (k == 10) sim.pin(std::vector<std::int32_t>{0});
    if (k == 20) sim.release(std::vector<std::int32_t>{0});
    ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  }
  EXPECT_NEAR(sim.positions_m()[84][1], top + 0.1, 2e-3) << "pins that come and go do not stop it";
  EXPECT_NEAR(sim.body_positions_m()[0][1], -0.05, 1e-6);
  EXPECT_THROW(sim.set_body(test::box({0, 0, 0}, 0.15).vertices_m), Error);
}

// Pins, a hand and a led body, left in the middle.
struct Scripted {
  Simulation sim{sheet(0.16), block()};
  int hand = -1;

  void begin() {
    sim.pin(std::vector<std::int32_t>{0});
    hand = sim.grab({.face = 287});
  }
  void frame(int k) {
    const double t = k / 30.0;
    sim.move_pins(std::vector<std::int32_t>{0}, std::vector<Point>{{-0.18, 0.16 + 0.2 * t, -0.18}});
    sim.drag(hand, {0.18, 0.16 + 0.3 * t, 0.18});
    sim.set_body(test::box({0.1 * t, 0, 0}, 0.15).vertices_m);
    ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  }
};

TEST(State, GoesOnWithTheSameBitsHereAndInAnotherSimulation) {
  Scripted whole;
  whole.begin();
  for (int k = 1; k <= 10; ++k) whole.frame(k);
  const State middle = whole.sim.state();
  const std::string hash = whole.sim.state_hash();
  for (int k = 11; k <= 20; ++k) whole.frame(k);
  const std::string end = whole.sim.state_hash();
  EXPECT_NE(end, hash);

  whole.sim.set_state(middle);
  EXPECT_EQ(whole.sim.state_hash(), hash);
  EXPECT_NEAR(whole.sim.time_s(), 10 / 30.0, 1e-12);
  for (int k = 11; k <= 20; ++k) whole.frame(k);
  EXPECT_EQ(whole.sim.state_hash(), end) << "in the same simulation";

  const std::string file = (std::filesystem::temp_directory_path() / "toile_state_test.bin").string();
  middle.save(file);
  Scripted other;
  other.hand = whole.hand;
  other.sim.set_state(State::load(file));
  std::filesystem::remove(file);
  for (int k = 11; k <= 20; ++k) other.frame(k);
  EXPECT_EQ(other.sim.state_hash(), end) << "in another one";
}

TEST(State, RefusesWhatIsNotItsOwnOrNotWhole) {
  Simulation sim(sheet(1)), finer(sheet(1, 14));
  const State state = sim.state();
  EXPECT_NE(message_of<InputError>([&] { finer.set_state(state); }).find("input_hash"), std::string::npos);
  for (std::size_t k = 0; k < state.bytes().size(); k += 997) {
    std::string bytes = state.bytes();
    bytes[k] = static_cast<char>(bytes[k] ^ 1);
    EXPECT_THROW(sim.set_state(State(bytes)), InputError) << k;
  }
  EXPECT_THROW(sim.set_state(State(state.bytes().substr(0, state.bytes().size() / 2))), InputError);
  EXPECT_THROW(sim.set_state(State{}), InputError);
  ASSERT_TRUE(sim.advance(0.1).ok()) << "it is as it was";
}

TEST(Simulation, ResetTakesEverythingBack) {
  Scripted run;
  const std::string at_first = run.sim.state_hash();
  run.begin();
  for (int k = 1; k <= 5; ++k) run.frame(k);
  const std::string end = run.sim.state_hash();
  run.sim.reset();
  EXPECT_EQ(run.sim.state_hash(), at_first);
  EXPECT_EQ(run.sim.time_s(), 0);
  EXPECT_TRUE(run.sim.pinned().empty());
  run.begin();
  for (int k = 1; k <= 5; ++k) run.frame(k);
  EXPECT_EQ(run.sim.state_hash(), end);
}

TEST(Simulation, TheSameBitsOnOneThreadAndInSeveralAtOnce) {
  const auto end_of = [](int threads) {
    Simulation sim(sheet(0.16, 30, 0.012), block(), {.threads = threads});
    for (int k = 0; k < 10; ++k) sim.advance(1.0 / 30);
    return sim.state_hash();
  };
  const std::string alone = end_of(1);
  EXPECT_EQ(end_of(2), alone);
  std::vector<std::string> hashes(3);
  std::vector<std::thread> threads;
  for (std::string& hash : hashes) threads.emplace_back([&] { hash = end_of(1); });
  for (std::thread& thread : threads) thread.join();
  for (const std::string& hash : hashes) EXPECT_EQ(hash, alone);
}

TEST(Simulation, MovesSafely) {
  Simulation sim(sheet(1));
  sim.pin(std::vector<std::int32_t>{0});
  ASSERT_TRUE(sim.advance(0.1).ok());
  const State state = sim.state();
  ASSERT_TRUE(sim.advance(0.1).ok());
  const std::string end = sim.state_hash();
  Simulation moved(std::move(sim));
  moved.set_state(state);
  Simulation assigned(sheet(2));
  assigned = std::move(moved);
  ASSERT_TRUE(assigned.advance(0.1).ok());
  EXPECT_EQ(assigned.state_hash(), end);
}

TEST(Simulation, DressesAPatternAndGoesOnFromIt) {
  const std::string patterns = internal::test::source_path("patterns/");
  const auto make = [&] {
    return Simulation(Cloth::from_pattern(patterns + "skirt.json", {.edge_m = 0.04}), Body::mannequin("woman", "sway"));
  };
  Simulation sim = make();
  const std::size_t panels = sim.positions_m().size();
  EXPECT_NE(message_of<Error>([&] { sim.advance(0.1); }).find("dress"), std::string::npos);
  const DressReport worn = sim.dress();
  ASSERT_TRUE(worn.ok()) << worn.explain();
  EXPECT_EQ(worn.ended, "still");
  EXPECT_LT(sim.positions_m().size(), panels) << "seams are welded";
  const State dressed = sim.state();
  const Point before = sim.body_positions_m()[0];
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(sim.advance(1.0 / 30).ok());
  EXPECT_NE(sim.body_positions_m()[0], before) << "she sways";
  const std::string end = sim.state_hash();

  Simulation again = make();  // not dressed: the state says what is on
  again.set_state(dressed);
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(again.advance(1.0 / 30).ok());
  EXPECT_EQ(again.state_hash(), end);
  EXPECT_TRUE(
      std::equal(sim.body_positions_m().begin(), sim.body_positions_m().end(), again.body_positions_m().begin()));
}

TEST(Simulation, ACancelledDressIsAsItWasBefore) {
  bool cancel = true;
  int asked = 0;
  Simulation sim(Cloth::from_pattern(internal::test::source_path("patterns/skirt.json"), {.edge_m = 0.04}),
                 Body::mannequin("woman"), {.cancelled = [&] { return ++asked > 5 && cancel; }});
  const std::string before = sim.state_hash();
  const DressReport report = sim.dress();
  EXPECT_EQ(report.ended, "interrupted");
  EXPECT_FALSE(report.ok());
  EXPECT_EQ(sim.state_hash(), before);
  cancel = false;
  EXPECT_TRUE(sim.dress().ok());
}

TEST(Simulation, HemsAndTapesAreThoseOfThePatternsOptions) {
  const auto worn = [](const PatternOptions& options) {
    Simulation sim(Cloth::from_pattern(internal::test::source_path("patterns/skirt.json"), options),
                   Body::mannequin("woman"));
    EXPECT_TRUE(sim.dress().ok());
    return sim.state_hash();
  };
  const std::string usual = worn({.edge_m = 0.06});
  EXPECT_EQ(worn({.edge_m = 0.06, .hem_m = 0, .tape_m = 0.01}), usual);
  EXPECT_NE(worn({.edge_m = 0.06, .tape_m = 0}), usual);
  EXPECT_NE(worn({.edge_m = 0.06, .hem_m = 0.03}), usual);
  EXPECT_THROW(Cloth::from_pattern("p.json", {.hem_m = -0.01}), InputError);
  EXPECT_THROW(Cloth::from_pattern("p.json", {.tape_m = std::numeric_limits<double>::infinity()}), InputError);
}

TEST(Simulation, SeamAllowancesAreThoseOfThePatternsOptions) {
  const auto worn = [](const PatternOptions& options) {
    Simulation sim(Cloth::from_pattern(internal::test::source_path("patterns/skirt.json"), options),
                   Body::mannequin("woman"));
    EXPECT_TRUE(sim.dress().ok());
    return sim.state_hash();
  };
  const std::string loose = worn({.edge_m = 0.06, .allowance_m = 0.015});
  EXPECT_NE(loose, worn({.edge_m = 0.06}));
  EXPECT_NE(loose, worn({.edge_m = 0.06, .allowance_m = 0.015, .topstitched = true}));
  EXPECT_THROW(Cloth::from_pattern("p.json", {.allowance_m = -0.01}), InputError);
  EXPECT_THROW(Cloth::from_pattern("p.json", {.topstitched = true}), InputError);
}

TEST(Simulation, ACancelledAdvanceIsGoneOnWith) {
  bool cancel = true;
  Simulation sim(sheet(1), Body::none(), {.cancelled = [&] { return cancel; }});
  const StepReport first = sim.advance(0.1);
  EXPECT_TRUE(first.cancelled);
  EXPECT_FALSE(first.ok());
  cancel = false;
  EXPECT_TRUE(sim.advance(0.1).ok());
  EXPECT_DOUBLE_EQ(sim.time_s(), 0.1);
}

// It begins through the body, so that it has to be taken apart before it hangs.
TEST(Simulation, IsWholeThoughItIsCancelledWhileItIsMade) {
  Simulation sim(sheet(0.14), block(), {.cancelled = [] { return true; }});
  EXPECT_EQ(sim.state_hash(), Simulation(sheet(0.14), block()).state_hash());
}

TEST(Simulation, SaysWhatCannotBeMeant) {
  const Arrays good = test::level_sheet(3, 0.1, 0);
  const auto cloth_of = [](const Arrays& arrays) {
    return Cloth::from_arrays({.vertices_m = arrays.vertices_m, .faces = arrays.faces});
  };
  Arrays bad = good;
  bad.faces[2][1] = 99;
  EXPECT_NE(message_of<InputError>([&] { cloth_of(bad); }).find("triangle 2"), std::string::npos);
  bad = good;
  bad.vertices_m[5][1] = std::nan("");
  EXPECT_NE(message_of<InputError>([&] { cloth_of(bad); }).find("5"), std::string::npos);
  bad = good;
  bad.faces.push_back(bad.faces.front());
  EXPECT_THROW(cloth_of(bad), InputError);
  EXPECT_THROW(
      Cloth::from_arrays({.vertices_m = good.vertices_m, .faces = good.faces, .uv_m = std::vector<CornerUvs>(3)}),
      InputError);
  EXPECT_THROW(Cloth::grid({.width_m = -1}), InputError);
  EXPECT_NE(message_of<InputError>([] { fabric("coton"); }).find("cotton"), std::string::npos);
  EXPECT_THROW(Body::mannequin("giant"), InputError);
  Arrays open = test::box({0, 0, 0}, 1);
  open.faces.pop_back();
  EXPECT_THROW(Simulation(sheet(2), Body::from_arrays(open.vertices_m, open.faces)), InputError);
  EXPECT_NE(message_of<InputError>([] { Body::cylinder({.radius_m = -1}); }).find("radius_m"), std::string::npos);
  EXPECT_NE(message_of<InputError>([] {
              Simulation(sheet(1), Body::none(), {.wind_m_per_s = {0, std::numeric_limits<double>::infinity(), 0}});
            }).find("wind_m_per_s"),
            std::string::npos);
  try {
    Simulation(Cloth::grid({.width_m = 30, .height_m = 30, .edge_m = 5e-4}));
    ADD_FAILURE() << "eight thousand million triangles";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::resource_limit) << error.what();
  }
  Simulation sim(sheet(1));
  EXPECT_NE(message_of<InputError>([&] {
              sim.grab({.stiffness_N_per_m = std::numeric_limits<double>::infinity()});
            }).find("stiffness_N_per_m"),
            std::string::npos);
  EXPECT_THROW(sim.advance(0), InputError);
  EXPECT_THROW(sim.advance(std::nan("")), InputError);
  EXPECT_THROW(sim.pin(std::vector<std::int32_t>{-1}), InputError);
  EXPECT_THROW(sim.move_pins(std::vector<std::int32_t>{3}, std::vector<Point>{{0, 0, 0}}), InputError);
  EXPECT_EQ(message_of<IoError>([] { Simulation::from_scene("/no/such.json"); }).find("/no/such.json"), 0U);
  EXPECT_STREQ(version(), TOILE_TEST_VERSION);
}

}  // namespace
}  // namespace toile
