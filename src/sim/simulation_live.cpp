// sim/simulation_live.cpp: from the first written frame to the last: the drape, then the motion.
#include "body/arms.hpp"
#include "dress/forces.hpp"
#include "sim/simulation.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

// Share of the height of the hips, or of the waist for a bodice: a garment wholly below has passed the widest place, and a static body
// does not lift it again.  The run ends, instead of waiting for folds about the feet to rest.
constexpr double beyond_return = 0.75;

}  // namespace

void Simulation::begin(const std::function<void(OutfitRun&)>& prepare) {
  const bool resumed = resumes();
  outfit_run().begin(drape_phase());
  run_->set_events(events());
  if (prepare) prepare(*run_);
  if (!resumed) rest_ = {};
  rest_.begin(outfit_.state.x, scene_.fps);
  begun_ = true;
  show_first();
  watch_falling();
  // The run owns the cloth now: further copies of a fine mesh are large.
  for (const LoadedCloth& cloth : cloth_) belongings_.push_back(belonging_of(cloth.garment));
  cloth_.clear();
  outfit_.mesh = {};
  report_.ended = "time";
  end_startup();
  if (resumed) {
    // In motion, run() restores once the body moves, as `prepare` has arranged.
    if (prepare || place_.phase == RunPhase::drape) restore(*run_);
    return;
  }
  place_ = {RunPhase::drape, scene_.cloth.size() - 1, 0};
  between_frames(*run_, true);
}

// Pins of a garment choose their particles once all garments are on.
Events Simulation::events() {
  Events events = events_of(scene_, outfit_, cloth_);
  if (!sewn()) return events;
  Index first = 0;
  for (std::size_t k = 0; k < cloth_.size(); ++k) {
    const Index particles = outfit_.parts[k].particles;
    if (!resumes())
      pinned_.push_back(pinned_particles(
          scene_, k,
          std::span(outfit_.state.x).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(particles))));
    for (const PinnedParticle& pinned : pinned_[k])
      events.pins.push_back(timed_pin(scene_.cloth[k].pins[pinned.pin], first + pinned.particle));
    first += particles;
  }
  return events;
}

void Simulation::show_first() {
  std::vector<Vec2> rest_stretch = outfit_.rest_stretch;  // at the end
  for (const auto& [panel, own] : run_->events().panels)
    if (!own.rest_stretch_path.empty()) rest_stretch[at(panel)] = own.rest_stretch_path.back().b;
  for (std::size_t p = 0; p < rest_stretch.size(); ++p) {
    const Vec2& b = rest_stretch[p];
    if (b != Vec2(1, 1)) report_.rest_stretch.push_back({outfit_.mesh.panel_names[p], {b.y(), b.x()}});
  }
  for (const OutfitPart& part : outfit_.parts)
    for (Index p = part.first_panel; p < part.first_panel + part.panels; ++p)
      report_.fabrics.push_back({part.name, outfit_.mesh.panel_names[static_cast<std::size_t>(p)],
                                 outfit_.fabrics[static_cast<std::size_t>(p)].name});
  report_.vertices = outfit_.mesh.particle_count;
  report_.triangles = outfit_.mesh.triangle_count();
  if (resumes()) say("reading", 0);
  observer_->begins(outfit_, rest_stretch, body_triangles_, body_x_);
  if (!resumes()) frames_shown_ = 1;
}

bool Simulation::drape() {
  const PhasePlan plan = drape_plan();
  if (!go_through(plan)) return false;
  if (at_rest(plan) && !motion_) report_.ended = "still";
  return true;
}

void Simulation::animate() {
  run_->start_motion(motion_->at);
  report_.motion_name = motion_->name;
  if (resumes()) {
    restore(*run_);
    motion_->at(static_cast<double>(place_.frame) * frame_s(), body_x_, body_x_);
  } else {
    place_.phase = RunPhase::motion;
    place_.frame = 0;
    seconds_before_motion_ = run_->seconds();
    report_.motion_first_frame = frames_shown_ - 1;
    observer_->motion_begins();
    between_frames(*run_, true);
  }
  go_through(motion_plan());
  PhaseReport& phase = report_.motion;
  phase.simulated_s = phase.frames * frame_s();
  set_seconds(phase, run_->seconds(), seconds_before_motion_);
}

int Simulation::frames_in_motion() const {
  const bool whole = !scene_.seconds_given && std::isfinite(motion_->duration_s);
  return frames_in(whole ? motion_->duration_s : scene_.seconds);
}

// Lost garments end the run, where that can be told: in still air, and if no hand drags the cloth.
void Simulation::watch_falling() {
  if (!sewn() || !body_ || scene_.gravity_m_per_s2.isZero(0) || !scene_.gravity_path.empty()) return;
  for (const SceneCloth& cloth : scene_.cloth)
    if (!cloth.drags.empty()) return;
  touches_.touched.resize(outfit_.parts.size(), 0);
  fall_watch_.emplace(scene_.gravity_m_per_s2, body_triangles_, motion_ ? motion_->at : BodyAt{},
                      motion_ ? frames_in_motion() * frame_s() : 0, frame_s());
}

bool Simulation::lost() {
  const std::optional<LostGarment> lost = fall_watch_->find(outfit_.parts, outfit_.state, body_x_);
  if (!lost) return false;
  const auto p = static_cast<std::size_t>(lost->part);
  const bool touched = touches_.touched[p] != 0;
  end(touched ? reason::fell_off : reason::never_touched,
      printable(outfit_.parts[p].name) + (touched ? " fell off the body" : " never touched the body") +
          ", and nothing below will catch it: " + lost->where);
  return true;
}

bool Simulation::goes_on() {
  if (!fall_watch_ || !run_->settled() || may_lift(*run_)) return true;
  return !lost() && !(place_.phase == RunPhase::drape && slid_down(beyond_return));
}

// The reasons and qualifications of a run whose time is over.
void Simulation::judge_end() {
  if (!run_->settled())
    failure_.push_back({std::string(reason::not_settled),
                        fmt::sprintf("it ended %.3g s after the weld; gravity and elastic are full after %.3g s",
                                     run_->time_s(), settling_s)});
  else if (fall_watch_ && may_lift(*run_))
    lost();
}

// A skirt about the feet is not worn, nor is a dress that hangs at the hips.
bool Simulation::slid_down(double share) {
  if (!body_) return false;
  const std::span person = std::span<const Triangle>(body_triangles_).first(person_triangles_);
  if (!trunk_) {
    const bool torso = !find_arms(std::span(standing_x_).first(person_vertices_), person);  // has no hips
    trunk_ = torso ? TrunkLevels{} : trunk_levels(std::span(standing_x_).first(person_vertices_), person);
  }
  const std::optional<LostGarment> lost =
      internal::slid_down(outfit_.parts, belongings_, outfit_.state.x, *trunk_, share);
  if (!lost) return false;
  const auto p = static_cast<std::size_t>(lost->part);
  const bool never_touched = fall_watch_ && touches_.touched[p] == 0;
  end(never_touched ? reason::never_touched : reason::fell_off,
      printable(outfit_.parts[p].name) + (never_touched ? " fell past the body: " : " slid down: ") + lost->where);
  return true;
}

void Simulation::close() {
  report_.drape.simulated_s = report_.drape.frames * frame_s();
  set_seconds(report_.drape, run_->seconds());
  report_.layer_gap = run_->layer_gap();
}

}  // namespace toile::internal
