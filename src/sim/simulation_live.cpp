// sim/simulation_live.cpp: from the first written frame to the last: the drape, then the motion.
#include "body/arms.hpp"
#include "sim/forces.hpp"
#include "sim/simulation.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double rest_s = 0.5;  // after a garment has settled, before it may be said to be still
// Of the height of the hips, or of a bodice's of the waist: what is wholly below has come past the widest place, and nothing that stands
// still lifts it up again.  The run ends, instead of waiting for folds about the feet to rest.
constexpr double beyond_return = 0.75;

}  // namespace

void Simulation::begin(const std::function<void(OutfitRun&)>& prepare) {
  const bool resumed = resumes();
  run_.emplace(scene_, outfit_, body(), step_, settling_, stop());
  run_->set_events(events());
  if (prepare) prepare(*run_);
  rest_.begin(outfit_.state.x, scene_.fps);
  show_first();
  watch_falling();
  // What hangs now is the run's: a second and a third copy of a fine mesh are large.
  for (const LoadedCloth& cloth : cloth_) belongings_.push_back(belonging_of(cloth.garment));
  cloth_.clear();
  outfit_.mesh = {};
  report_.ended = "time";
  end_startup();
  if (resumed) {
    // In motion, run() restores once the body moves; who prepares has seen to that.
    if (prepare || place_.phase == RunPhase::drape) restore(*run_);
    return;
  }
  place_ = {RunPhase::drape, scene_.cloth.size() - 1, 0};
  between_frames(*run_, true);
}

// The pins of a garment hold what is at their places once everything is on.
Events Simulation::events() {
  Events events = events_of(outfit_, cloth_);
  if (!sewn()) return events;
  Index first = 0;
  for (std::size_t k = 0; k < cloth_.size(); ++k) {
    const Index particles = outfit_.parts[k].particles;
    if (!resumes())
      pinned_.push_back(pinned_particles(
          scene_.cloth[k],
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
  if (resumes()) say("reading", 0);
  observer_->begins(outfit_, rest_stretch, body_triangles_, body_x_);
  if (!resumes()) frames_shown_ = 1;
}

bool Simulation::drape() {
  const bool moving = motion_.has_value();
  const int frames =
      moving ? (scene_.drape_seconds > 0 ? frames_in(scene_.drape_seconds) : 1) : frames_in(scene_.seconds);
  const std::int64_t first = place_.frame;
  const Stopwatch watch;
  const auto at_rest = [&] {
    return place_.frame > 0 && awaits_rest() && run_->settled() &&
           run_->time_s() - frame_s() > (settling_.sewn ? OutfitRun::settling_s : -rest_s) + rest_s && rest_.at_rest();
  };
  if (place_.frame > 0 && !goes_on()) return false;
  bool rests = at_rest();
  while (!rests && place_.frame + 1 < frames) {
    if (!frame(report_.drape, "draping", place_.frame + 1)) return false;
    rests = at_rest();
    const auto done = static_cast<double>(place_.frame - first);
    say("draping", static_cast<double>(place_.frame) / frames,
        watch.seconds() * static_cast<double>(frames - 1 - place_.frame) / done);
  }
  if (rests && !moving) report_.ended = "still";
  return true;
}

void Simulation::animate() {
  run_->start_motion(motion_->at);
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
  PhaseReport& phase = report_.motion;
  report_.motion_name = motion_->name;
  const int frames = frames_in_motion();
  const std::int64_t first = place_.frame;
  const Stopwatch watch;
  bool good = place_.frame == 0 || goes_on();
  while (good && place_.frame < frames) {
    motion_->at(static_cast<double>(place_.frame + 1) * frame_s(), body_x_, body_x_);
    const double drape_seconds = report_.drape.seconds;
    good = frame(report_.drape, "moving", place_.frame + 1, &phase);
    phase.seconds += report_.drape.seconds - drape_seconds;
    if (!good) break;
    say("moving", static_cast<double>(place_.frame) / frames,
        watch.seconds() * static_cast<double>(frames - place_.frame) / static_cast<double>(place_.frame - first));
  }
  phase.simulated_s = phase.frames * frame_s();
  set_seconds(phase, run_->seconds(), seconds_before_motion_);
}

// One frame, simulated and shown; false when it is the last for a bad reason.
bool Simulation::frame(PhaseReport& phase, std::string_view what, std::int64_t k, PhaseReport* also) {
  FrameReport frame;
  {
    const Timed timed(phase.seconds);
    frame = run_->frame();
  }
  if (frame.interrupted) {
    cut_off("while " + std::string(what) + ", after frame " + std::to_string(k - 1));
    return false;
  }
  add_frame(phase, frame);
  if (also != nullptr) add_frame(*also, frame);
  if (!frame.ok) {
    collapse("in frame " + std::to_string(k), frame, run_->model().mesh, outfit_.state.x);
    return false;
  }
  observer_->frame(outfit_.state.x, body_x_);
  rest_.frame(outfit_.state.x);
  ++frames_shown_;
  ++place_.frame;
  if (fall_watch_) note_touches(outfit_.parts, *run_, touches_);
  between_frames(*run_);
  return goes_on();
}

int Simulation::frames_in_motion() const {
  const bool whole = !scene_.seconds_given && std::isfinite(motion_->duration_s);
  return frames_in(whole ? motion_->duration_s : scene_.seconds);
}

// Garments that fall to nowhere end the run, where that can be told: in still air, and if no hand holds the cloth.
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
  if (!fall_watch_ || !run_->settled() || may_lift(scene_)) return true;
  return !lost() && !(place_.phase == RunPhase::drape && slid_down(beyond_return));
}

// Of a run whose time is over.
void Simulation::judge_end() {
  if (!run_->settled())
    failure_.push_back({std::string(reason::not_settled),
                        fmt::sprintf("it ended %.3g s after the weld; gravity and elastic are full after %.3g s",
                                     run_->time_s(), OutfitRun::settling_s)});
  else if (fall_watch_ && may_lift(scene_))
    lost();
}

// A skirt that lies about the feet is not worn, nor is a dress that hangs at the hips.
bool Simulation::slid_down(double share) {
  if (!body_) return false;
  const std::span person = std::span<const Triangle>(body_triangles_).first(person_triangles_);
  if (!trunk_) {
    const bool torso = !find_arms(std::span(standing_x_).first(person_vertices_), person);  // has no hips to be found
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
