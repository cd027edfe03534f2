#include "dress/phase.hpp"

namespace toile::internal {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double weightless_s = 0.2;
constexpr double labels_held_s = 0.5, labels_fade_s = 0.5;
constexpr double frictionless_s = 1;  // a first garment slips into place before friction holds it
// A tangled triangle changes its stretch in every step, however short: without a floor one takes all of a garment to 1/3840 s.  Two such garments
// grow in 120 and 197 steps with 1, in 468 with 3, in more than 1237 and 2241 without; others in as many (bench/notes.md).
constexpr int growth_stretch_floor = 1;
constexpr Ramp none{0, 0, 0, 0};
constexpr Ramp growing{weightless_s, settling_s, 0, 1};

constexpr Ramp from(double t_s) { return {t_s, t_s, 0, 1}; }

}  // namespace

Phase after_weld(bool first, const Pace& pace) {
  Phase phase;
  phase.gravity = phase.elastic = growing;
  phase.friction = from(first ? frictionless_s : settling_s);
  phase.labels = {labels_held_s, labels_held_s + labels_fade_s, 1, 0};
  phase.held_until_s = phase.settled_s = settling_s;
  phase.pace = pace;
  return phase;
}

Phase within_growing(bool weightless) {
  Phase phase;
  phase.gravity = weightless ? none : growing;
  phase.elastic = phase.friction = none;
  phase.held_until_s = phase.settled_s = never;
  phase.moving = steps_of(1.0 / 30);  // the body moves
  phase.moving.stretch_floor = growth_stretch_floor;
  return phase;
}

Phase coming_apart(const Pace& pace) {
  Phase phase = within_growing(true);
  phase.pace = pace;
  return phase;
}

Phase as_drawn(const Pace& pace, const Pace& moving) {
  Phase phase;
  phase.labels = none;
  phase.pace = pace;
  phase.moving = moving;
  return phase;
}

}  // namespace toile::internal
