// tests/support/run_cloth.hpp: a cloth that runs for a while, for tests of the step.
#pragma once
#include "step/adaptive_step.hpp"
#include "support/bare_step.hpp"
#include "support/fabrics.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace toile::internal::test {

inline ModelOptions weightless() {
  ModelOptions options;
  options.gravity_m_per_s2.setZero();
  return options;
}

struct ClothRun {
  ClothRun(const Sheet& sheet, const Fabric& fabric, const ModelOptions& options = {})
      : model(build_model(sheet.mesh, {&fabric, 1}, options)) {
    state.x = sheet.x;
    state.v.assign(sheet.x.size(), Vec3::Zero());
  }
  ClothRun(const ClothRun&) = delete;  // the stepper points at model and world
  ClothRun& operator=(const ClothRun&) = delete;
  void pin(Index particle) {
    Pin pin;
    pin.particle = particle;
    world.pins.push_back(pin);
  }
  template <class F, class... Arguments>
  void add_force(Arguments&&... arguments) {
    world.forces.push_back(std::make_unique<F>(std::forward<Arguments>(arguments)...));
  }
  void start() { stepper.emplace(model, world, step, adaptive); }
  FrameReport frame(double frame_s = 1.0 / 30) {
    if (!stepper) start();
    const FrameReport report = stepper->advance(state, time_s, frame_s);
    EXPECT_TRUE(report.ok) << report.diagnosis;
    time_s += frame_s;
    return report;
  }
  void run(int frames, double frame_s = 1.0 / 30) {
    for (int f = 0; f < frames; ++f) frame(frame_s);
  }
  double fastest() const {
    double speed = 0;
    for (const Vec3& v : state.v) speed = std::max(speed, v.norm());
    return speed;
  }
  ClothModel model;
  StepWorld world;
  StepOptions step = bare_step();
  AdaptiveOptions adaptive;
  ClothState state;
  std::optional<AdaptiveStep> stepper;
  double time_s = 0;
};

}  // namespace toile::internal::test
