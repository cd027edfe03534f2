// dress/phase.hpp: the parameters of a phase of a run: shares of gravity, elastic and friction, and the step control.
//
//   after_weld      0.2 s weightless, 0.3 s in which gravity and elastic grow; the garments worn before stand still that long.
//                   A first garment slips on the body for 1 s before friction holds it; labels let go between 0.5 and 1 s.
//   within_growing  as just welded, for as long as the body grows: labels hold, elastic waits, nothing sticks.  Steps are halved once at most
//                   because of stretch: nobody sees these frames, and the push of the body is no divergence
//   coming_apart    the same without weight
//   as_drawn        all in full from the start: a grid, or a drape that is taken up again
#pragma once
#include <limits>
#include <optional>

namespace toile::internal {

// `before` until from_s, `after` from to_s on, straight in between.
struct Ramp {
  double from_s = 0, to_s = 0, before = 1, after = 1;
  double at(double t_s) const {
    if (t_s >= to_s) return after;
    return t_s <= from_s ? before : before + (after - before) * ((t_s - from_s) / (to_s - from_s));
  }
};

// Step control.
struct Pace {
  double step_max_s = 1.0 / 60;       // unless the scene sets it
  std::optional<double> slow_motion;  // instead of StepOptions::slow_motion
  double slow_tolerance =
      std::numeric_limits<double>::infinity();          // of the solver at most, once nearly all cloth is slow
  int stretch_floor = std::numeric_limits<int>::max();  // halvings from which stretch refuses no step: never
};
constexpr Pace steps_of(double step_max_s) {
  Pace pace;
  pace.step_max_s = step_max_s;
  return pace;
}
// For a phase that ends at rest: the number of steps does not depend on their length, so each is solved better; slow turns must not be
// braked, and the residual of a solve lets folds drift.
inline constexpr Pace awaiting_rest{1.0 / 30, 0.01, 0.002};

struct Phase {
  Ramp gravity, elastic, friction;  // shares of the run's values
  Ramp labels;                      // strength of the labels that hold a new garment
  double held_until_s = 0;          // the garments worn before stand still until then
  double settled_s = 0;             // from then on gravity and elastic are in full, and thinned layers grow back
  Pace pace, moving;                // before the body moves, and afterwards
};

inline constexpr double settling_s = 0.5;  // after a weld, until gravity and elastic are in full

// `first`: nothing is worn below, which would slide down without friction.
Phase after_weld(bool first, const Pace& pace);
Phase within_growing(bool weightless);
Phase coming_apart(const Pace& pace);
Phase as_drawn(const Pace& pace, const Pace& moving);

}  // namespace toile::internal
