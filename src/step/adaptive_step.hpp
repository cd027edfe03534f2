// step/adaptive_step.hpp: adaptive step size, by the change of stretch in a step.                              [BW98 7]
//
//   accept   no |w_u| or |w_v| changes by more than `stretch_limit`, the solve converged, and the safe filter could
//            keep cloth apart from cloth and from the body
//   reject   otherwise: h <- h / 2; the state is untouched and no element is evaluated again
//   grow     after two accepted steps try 2 h, up to h_max; after a failed increase wait 2, 4, 8 ... 40 accepted steps
//
// h = frame / ceil(frame / h_max) / 2^k.  A doubling waits until the time is a multiple of the longer step, so that
// steps end on frame boundaries.
#pragma once
#include "step/implicit_euler.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct AdaptiveOptions {
  double step_max_s = 1.0 / 30;
  double stretch_limit = 0.05;  // change of |w| per step
  int most_halvings = 10;       // frame / 1024: below it the run has collapsed
  int stretch_floor = 11;       // halvings from which stretch is no longer judged (sewing sets it lower)
  std::function<bool()> stop;   // called before every step; true ends the frame early
  // Halvings from which impacts that the safe filter cannot remove no longer refuse the step: pinched cloth may enter
  // the body; the motion of cloth against cloth is clipped (step/safe_filter.hpp); any cloth may enter the body.
  int pinch_piercing_floor = 1, truncation_floor = 4, piercing_floor = 5;
};

struct FrameReport {
  bool ok = true;
  bool interrupted = false;  // by `stop`: the state is somewhere within the frame
  int steps = 0, rejected = 0;
  double step_min_s = 0, step_max_s = 0;
  int cg_iterations = 0, cg_max = 0;  // summed over steps; the largest of one step
  int passes = 0;
  int corrected = 0,
      truncated = 0;             // particles moved by the safe filter, and of these clipped ones; summed over steps
  int met = 0;                   // steps with impacts in the safe filter
  int refused = 0;               // rejected by the safe filter
  int pierced = 0;               // impacts with the body that were allowed, summed over steps
  int pinched = 0;               // pinched particles, the most of any step
  StepReport last;               // of the last attempt: the reason when !ok
  std::string diagnosis;         // when !ok: which triangles and particles, in words
  std::vector<Index> offenders;  // when !ok: triangles of the cloth to look at, ascending
};

class AdaptiveStep {
 public:
  AdaptiveStep(const ClothModel& model, const StepWorld& world, const StepOptions& step, const AdaptiveOptions& options)
      : integrator_(model, world, step), options_(options) {}
  AdaptiveStep(const AdaptiveStep&) = delete;  // like the integrator
  AdaptiveStep& operator=(const AdaptiveStep&) = delete;

  // Advances from t_s by exactly frame_s.  When the step collapses, `state` is the last accepted one.
  FrameReport advance(ClothState& state, double t_s, double frame_s);

  // The accepted steps of the last advance, in order.
  std::span<const double> steps_s() const { return steps_s_; }

  ImplicitEuler& integrator() { return integrator_; }
  const ImplicitEuler& integrator() const { return integrator_; }
  AdaptiveOptions& options() { return options_; }

  // State that outlives a frame (core/state_archive.hpp).
  template <class Archive>
  void remember(Archive& archive) {
    archive(integrator_, halvings_, successes_, wait_, patience_, growing_);
  }

 private:
  std::string diagnose(const ClothState& state, const StepReport& report) const;
  Index most_strained(const ClothState& state) const;
  std::vector<Index> offenders(const ClothState& state, const StepReport& report) const;

  ImplicitEuler integrator_;
  AdaptiveOptions options_;
  ClothState candidate_;
  std::vector<double> steps_s_;
  int halvings_ = 0;  // h = base / 2^halvings
  int successes_ = 0, wait_ = 2, patience_ = 2;
  bool growing_ = false;  // the present h is the first try after a doubling
};

}  // namespace toile::internal
