// What a garment goes through between the weld and the motion of its body.
#include "sim/outfit_run.hpp"
#include "io/file.hpp"
#include "sim/setup.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace toile {
namespace {

// A sheet of 20 cm that was level when it was "sewn", and hangs by two of its corners.
struct Hanging {
  Scene scene = parse_scene(R"({"cloth": [{"name": "sheet",
      "grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.025}, "placement": {"rotation_deg": [-90, 0, 0]}}],
      "time": {"step_max_ms": 16}})",
                            "hanging.json");
  Hash inputs;
  std::vector<LoadedCloth> cloth;
  Outfit outfit;
  std::optional<OutfitRun> run;

  explicit Hanging(bool to_rest) {
    cloth.push_back(load_cloth(scene, scene.cloth.front(), read_text_file, inputs));
    outfit = outfit_of_shapes(cloth);
    Settling settling;
    settling.sewn = true;
    settling.to_rest = to_rest;
    run.emplace(scene, outfit, nullptr, step_options(scene, cloth.front().fabrics.front(), cloth.front().edge_m),
                settling, nullptr);
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
  void advance(double seconds) {
    const int frames = static_cast<int>(std::lround(seconds * scene.fps));
    for (int f = 0; f < frames; ++f) ASSERT_TRUE(run->frame().ok);
  }
  double fastest_m_per_s() const {
    double fastest = 0;
    for (const Vec3& v : outfit.state.v) fastest = std::max(fastest, v.norm());
    return fastest;
  }
};

TEST(OutfitRun, WhatIsToRestStopsSwinging) {
  Hanging awaited(true), timed(false);
  for (Hanging* one : {&awaited, &timed}) one->advance(0.9);
  EXPECT_EQ(awaited.fastest_m_per_s(), timed.fastest_m_per_s());  // it falls as it would
  for (Hanging* one : {&awaited, &timed}) one->advance(1.2);
  EXPECT_LT(awaited.fastest_m_per_s(), 0.3 * timed.fastest_m_per_s());
  EXPECT_GT(timed.fastest_m_per_s(), 0.01);
}

TEST(OutfitRun, DragBrakesNothingOnceTheBodyMoves) {
  Hanging awaited(true);
  awaited.advance(1.5);
  EXPECT_GT(awaited.run->model().drag_per_s, 0);
  awaited.run->start_motion([](double, std::span<Vec3>) {});
  awaited.advance(0.1);
  EXPECT_EQ(awaited.run->model().drag_per_s, 0);
}

}  // namespace
}  // namespace toile
