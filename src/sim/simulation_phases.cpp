// sim/simulation_phases.cpp: phases as data, and the loop over their frames.
#include "sim/simulation.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace toile::internal {
namespace {

constexpr double rest_s = 0.5;  // after a garment has settled, before it may count as still
constexpr double any_speed = std::numeric_limits<double>::infinity();
constexpr RestLimits rests_below_others{5, any_speed};  // of an inner garment
// Of cloth that is then cut finer: with 20 mm instead of 5 a garment comes to rest as soon or sooner (bench/notes.md).
constexpr RestLimits has_fallen{20, any_speed};
constexpr double longest_fall_s = 3;

PhasePlan plan_of(RunPhase which, const Phase& cloth, std::string_view doing) {
  PhasePlan plan;
  plan.which = which;
  plan.cloth = cloth;
  plan.doing = doing;
  return plan;
}

}  // namespace

// The outfit's run; started from the present outfit if there is none.
OutfitRun& Simulation::outfit_run() {
  if (!run_) run_.emplace(run_options(scene_, step_, stop()), outfit_, body(), new_garment_.value_or(NewGarment{}));
  return *run_;
}

Pace Simulation::pace() const {
  if (!sewn()) return steps_of(frame_s());
  return awaits_rest() ? awaiting_rest : Pace{};
}

Phase Simulation::drape_phase() const {
  if (!new_garment_ || fallen_) return as_drawn(pace(), sewn() ? Pace{} : pace());
  return after_weld(new_garment_->worn_before == 0, pace());
}

// The thin body grows to its full size within the garment.
PhasePlan Simulation::growth_plan() {
  PhasePlan plan = plan_of(RunPhase::growth, within_growing(pose_.falls_s == 0), "fitting");
  plan.meanwhile = "while the body grew into the garment";
  plan.frames = frames_in(dressing_body_->growth_s());
  return plan;
}

// An inner garment comes to rest before the next is put on; the last one has fallen before it is cut finer.
PhasePlan Simulation::first_drape_plan(std::size_t cloth) {
  const bool is_inner = cloth + 1 < cloth_.size();
  PhasePlan plan = plan_of(RunPhase::first_drape, drape_phase(), "draping");
  plan.meanwhile = "while " + printable(cloth_[cloth].garment.name) + " was draped";
  plan.frames = is_inner ? frames_in(scene_.drape_seconds) - 1
                         : std::min<std::int64_t>(frames_in(longest_fall_s), drape_plan().frames);
  plan.awaits = is_inner ? rests_below_others : has_fallen;
  plan.rest_from_s = settling_s + rest_s;
  return plan;
}

PhasePlan Simulation::drape_plan() {
  const bool moves_at_once = motion_ && !(scene_.drape_seconds > 0);
  PhasePlan plan = plan_of(RunPhase::drape, drape_phase(), "draping");
  plan.meanwhile = "while draping";
  plan.frames = (moves_at_once ? 1 : frames_in(motion_ ? scene_.drape_seconds : scene_.seconds)) - 1;
  if (awaits_rest()) plan.awaits = still;
  plan.rest_from_s = new_garment_ ? settling_s + rest_s : 0;
  plan.shown = true;
  plan.reports = {&report_.drape, nullptr};
  return plan;
}

// The cloth keeps the phase of the drape.
PhasePlan Simulation::motion_plan() {
  PhasePlan plan = plan_of(RunPhase::motion, {}, "moving");
  plan.meanwhile = "while moving";
  plan.frames = frames_in_motion();
  plan.shown = true;
  plan.reports = {&report_.drape, &report_.motion};
  return plan;
}

// From its beginning, or from the saved frame.
void Simulation::enter(const PhasePlan& plan, std::size_t cloth, const BodyAt& moves) {
  outfit_run().begin(plan.cloth);
  if (moves) run_->start_motion(moves);
  const bool resumed = resumes();
  if (!resumed) rest_ = {};
  rest_.begin(outfit_.state.x, scene_.fps, plan.awaits.value_or(still));
  if (resumed) {
    restore(*run_);
    return;
  }
  place_ = {plan.which, cloth, 0};
  between_frames(*run_, true);
}

bool Simulation::at_rest(const PhasePlan& plan) const {
  return plan.awaits && place_.frame > 0 && run_->settled() && run_->time_s() - frame_s() > plan.rest_from_s &&
         rest_.at_rest();
}

// False: it failed, see failure(), or was stopped.
bool Simulation::go_through(const PhasePlan& plan) {
  if (plan.shown && place_.frame > 0 && !goes_on()) return false;
  const std::int64_t first = place_.frame;
  const Stopwatch watch;
  while (place_.frame < plan.frames && !at_rest(plan)) {
    if (!frame(plan)) return false;
    const auto done = static_cast<double>(place_.frame - first);
    say(plan.doing, static_cast<double>(place_.frame) / static_cast<double>(plan.frames),
        watch.seconds() * static_cast<double>(plan.frames - place_.frame) / done);
  }
  return true;
}

bool Simulation::frame(const PhasePlan& plan) {
  if (plan.which == RunPhase::motion) motion_->at(static_cast<double>(place_.frame + 1) * frame_s(), body_x_, body_x_);
  const Stopwatch watch;
  const FrameReport frame = run_->frame();
  for (PhaseReport* report : plan.reports) {
    if (report == nullptr) continue;
    report->seconds += watch.seconds();
    if (!frame.interrupted) add_frame(*report, frame);
  }
  const std::string after = plan.shown ? fmt::sprintf(", after frame %d", place_.frame) : "";
  if (frame.interrupted) {
    cut_off(plan.meanwhile + after);
    return false;
  }
  if (!frame.ok) {
    collapse(plan.shown ? fmt::sprintf("in frame %d", place_.frame + 1) : plan.meanwhile, frame, run_->model().mesh,
             outfit_.state.x);
    stopped_short_ = stopped_short_ || !plan.shown;
    return false;
  }
  ++place_.frame;
  rest_.frame(outfit_.state.x);
  if (plan.shown) {
    ++frames_shown_;
    observer_->frame(outfit_.state.x, body_x_);
  }
  if (fall_watch_ || !plan.shown) note_touches(outfit_.parts, *run_, touches_);
  between_frames(*run_);
  return !plan.shown || goes_on();
}

}  // namespace toile::internal
