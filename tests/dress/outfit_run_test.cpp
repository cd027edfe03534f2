// What a garment goes through between the weld and the motion of its body.
#include "dress/outfit_run.hpp"
#include "io/file.hpp"
#include "sim/setup.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

// A sheet of 20 cm that has just been welded, and hangs by two of its corners.
struct Hanging {
  Scene scene;
  std::vector<LoadedCloth> cloth;
  Outfit outfit;
  std::optional<OutfitRun> run;

  explicit Hanging(bool to_rest, const char* time = "{}", const char* tolerance = "0.002", bool waits = false,
                   bool weightless = false) {
    scene = parse_scene(R"({"cloth": [{"name": "sheet", "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.025},
        "placement": {"rotation_deg": [-90, 0, 0]}}], "time": )" +
                            std::string(time) + R"(, "solver": {"tolerance": )" + tolerance + "}}",
                        "hanging.json");
    cloth.push_back(load_cloth(scene, 0, read_text_file));
    outfit = outfit_of_shapes(cloth);
    run.emplace(run_options(scene, step_options(scene, cloth.front().edge_m)), outfit, nullptr);
    run->begin(waits ? within_growing(weightless) : after_weld(true, to_rest ? awaiting_rest : Pace{}));
    const auto along = [](const Vec3& a, const Vec3& b) { return a.z() != b.z() ? a.z() < b.z() : a.x() < b.x(); };
    const auto first = std::min_element(outfit.state.x.begin(), outfit.state.x.end(), along);
    const auto last = std::max_element(outfit.state.x.begin(), outfit.state.x.end(), [](const Vec3& a, const Vec3& b) {
      return a.z() != b.z() ? a.z() > b.z() : a.x() < b.x();
    });
    Events events;
    for (const auto corner : {first, last}) {
      TimedPin held;
      held.pin.particle = static_cast<Index>(corner - outfit.state.x.begin());
      events.pins.push_back(held);
    }
    run->set_events(std::move(events));
  }
  double longest_step_s() { return run->frame().step_max_s; }
};

TEST(OutfitRun, StepsAreTwiceAsLongWhileRestIsAwaited) {
  EXPECT_DOUBLE_EQ(Hanging(false).longest_step_s(), 1.0 / 60);
  Hanging awaited(true);
  for (int frame = 0; frame < 3; ++frame) EXPECT_DOUBLE_EQ(awaited.longest_step_s(), 1.0 / 30);
  awaited.run->start_motion([](double, std::span<Vec3>) {});
  EXPECT_DOUBLE_EQ(awaited.longest_step_s(), 1.0 / 60);
}

// A particle that flies off changes the stretch beside it in every step.
TEST(OutfitRun, StretchHalvesTheStepsOfAGrowingBodyOnceAtMost) {
  const auto shortest_step_s = [](bool grows) {
    Hanging hanging(false, "{}", "0.002", grows);
    if (grows) hanging.run->start_motion([](double, std::span<Vec3>) {});
    hanging.outfit.state.v[hanging.outfit.state.v.size() / 2] = Vec3(0, 100, 0);
    const FrameReport report = hanging.run->frame();
    EXPECT_TRUE(report.ok) << report.diagnosis;
    return report.step_min_s;
  };
  EXPECT_LT(shortest_step_s(false), 1.0 / 100);
  EXPECT_DOUBLE_EQ(shortest_step_s(true), 1.0 / 60);
}

// At 60 frames per second steps have the same length whether rest is awaited or not, and states are the same until the first that is
// solved again for its slow motion.
TEST(OutfitRun, SlowMotionIsSolvedForWhileRestIsAwaited) {
  const auto solved_again = [](Hanging& hanging) {
    std::vector<int> counts;
    for (int frame = 0; frame < 60; ++frame) counts.push_back(hanging.run->frame().last.relinearised);
    return counts;
  };
  Hanging timed(false, R"({"fps": 60})"), awaited(true, R"({"fps": 60})"), moving(true, R"({"fps": 60})");
  moving.run->start_motion([](double, std::span<Vec3>) {});
  const std::vector<int> without = solved_again(timed), with = solved_again(awaited);
  const auto [first, differs] = std::mismatch(without.begin(), without.end(), with.begin());
  ASSERT_NE(first, without.end());
  EXPECT_EQ(*first, 0);
  EXPECT_EQ(*differs, 1);
  EXPECT_EQ(solved_again(moving), without);
}

TEST(OutfitRun, StepsAreSolvedBetterWhileRestIsAwaited) {
  const auto iterations = [](bool to_rest, const char* tolerance) {
    return Hanging(to_rest, R"({"fps": 60})", tolerance).run->frame().cg_iterations;
  };
  EXPECT_GT(iterations(true, "0.01"), iterations(false, "0.01"));
  EXPECT_EQ(iterations(true, "0.01"), iterations(false, "0.002"));
  EXPECT_EQ(iterations(true, "0.0005"), iterations(false, "0.0005"));
}

// As long as it moves: cloth that falls is not about to rest.
TEST(OutfitRun, FastStepsAreSolvedNoBetterWhileRestIsAwaited) {
  const auto iterations = [](bool to_rest, const char* tolerance, double speed_m_per_s) {
    Hanging hanging(to_rest, R"({"fps": 60})", tolerance);
    for (Vec3& v : hanging.outfit.state.v) v = Vec3(0, speed_m_per_s, 0);
    return hanging.run->frame().cg_iterations;
  };
  EXPECT_EQ(iterations(true, "0.01", 0.2), iterations(false, "0.01", 0.2));
  EXPECT_NE(iterations(true, "0.01", 0.02), iterations(false, "0.01", 0.02));
  EXPECT_EQ(iterations(true, "0.01", 0.02), iterations(false, "0.002", 0.02));
}

TEST(OutfitRun, StepsAreNoLongerThanTheSceneSaysAlsoWhileRestIsAwaited) {
  EXPECT_DOUBLE_EQ(Hanging(true, R"({"step_max_ms": 5})").longest_step_s(), 1.0 / 30 / 7);
  EXPECT_DOUBLE_EQ(Hanging(true, R"({"fps": 60})").longest_step_s(), 1.0 / 60);
}

// Garments are sewn as cut: a tape that pulled at once would jerk a weightless edge, and so would threads that seams have made half as long again.
TEST(OutfitRun, TapesPullAndThreadsStiffenAsGravityGrows) {
  Hanging sheet(true);
  const Triangle corner = sheet.outfit.mesh.triangles.front();
  sheet.outfit.mesh.finished = {{corner[0], corner[1], 0, 0.01}};
  OutfitRun run(run_options(sheet.scene, step_options(sheet.scene, 0.025)), sheet.outfit, nullptr);
  ASSERT_FALSE(run.model().threads.empty());
  run.begin(after_weld(true, awaiting_rest));
  run.frame();
  EXPECT_EQ(run.model().finished, 0);
  EXPECT_EQ(run.model().stiffened, 0);
  while (run.time_s() < 0.4) run.frame();
  EXPECT_GT(run.model().finished, 0.2);
  EXPECT_GT(run.model().stiffened, 0.2);
  EXPECT_LT(run.model().finished, 0.8);
  EXPECT_LT(run.model().stiffened, 0.8);
  while (run.time_s() < 0.6) run.frame();
  EXPECT_EQ(run.model().finished, 1);
  EXPECT_EQ(run.model().stiffened, 1);
}

// While something of the weld is tangled, the time in which a garment gets its weight does not begin.
TEST(OutfitRun, AGarmentThatWaitsHasWeightUnlessItIsToHaveNone) {
  Hanging weightless(true, "{}", "0.002", true, true), waits(true, "{}", "0.002", true), falls(true);
  const Vec3s start = waits.outfit.state.x;
  const auto moved_m = [&](const Hanging& sheet) {
    double most_m = 0;
    for (std::size_t i = 0; i < start.size(); ++i)
      most_m = std::max(most_m, (sheet.outfit.state.x[i] - start[i]).norm());
    return most_m;
  };
  for (int frame = 0; frame < 30; ++frame)
    for (Hanging* sheet : {&weightless, &waits, &falls}) sheet->run->frame();
  EXPECT_FALSE(weightless.run->settled());
  EXPECT_FALSE(waits.run->settled());
  EXPECT_TRUE(falls.run->settled());
  EXPECT_LT(moved_m(weightless), 1e-6);
  EXPECT_GT(moved_m(waits), 0.05);
  EXPECT_GT(moved_m(falls), 0.05);
}

// A sheet that friction holds on a slope, in as many phases as frames or in one: what holds it is known from phase to phase.  A run that begins
// anew takes hold where the sheet has slid to.
TEST(OutfitRun, ContactsAreKnownFromPhaseToPhase) {
  const Scene scene = parse_scene(R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.025},
        "placement": {"translation_m": [0, 0.054, 0], "rotation_deg": [-90, 0, 0]}}],
      "body": {"box": {"size_m": [1, 0.1, 1]}, "friction": 0.6},
      "world": {"gravity_m_per_s2": [3.4, -9.2, 0]}})",
                                  "slope.json");
  const std::vector<LoadedCloth> cloth{load_cloth(scene, 0, read_text_file)};
  const auto slid = [&](bool in_phases, bool anew) {
    SolidMesh loaded = load_collider(scene.body).surface;
    BodySurface body(std::move(loaded.positions), std::move(loaded.triangles));
    Outfit outfit = outfit_of_shapes(cloth);
    const StepOptions step = step_options(scene, cloth.front().edge_m);
    std::optional<OutfitRun> run;
    for (int frame = 0; frame < 40; ++frame) {
      if (!run || anew) run.emplace(run_options(scene, step), outfit, &body);
      if (in_phases) run->begin(as_drawn(steps_of(1 / scene.fps), steps_of(1 / scene.fps)));
      EXPECT_TRUE(run->frame().ok);
    }
    return outfit.state.x;
  };
  const Vec3s whole = slid(false, false);
  EXPECT_EQ(slid(true, false), whole);
  EXPECT_NE(slid(true, true), whole);
}

TEST(OutfitRun, CountsTimeAndSecondsByPhase) {
  Hanging hanging(false);
  for (int frame = 0; frame < 3; ++frame) hanging.run->frame();
  EXPECT_DOUBLE_EQ(hanging.run->time_s(), 0.1);
  EXPECT_GT(hanging.run->seconds().eval, 0);
  hanging.run->begin(after_weld(true, Pace{}));
  EXPECT_EQ(hanging.run->time_s(), 0);
  EXPECT_EQ(hanging.run->seconds().eval, 0);
  EXPECT_EQ(hanging.run->seconds().cg, 0);
}

}  // namespace
}  // namespace toile::internal
