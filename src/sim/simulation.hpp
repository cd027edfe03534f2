// sim/simulation.hpp: a scene in memory, from flat panels to cloth that follows a body.  Reads and writes no file.
//
//   simulation.cpp           construction, ends, saving and resuming
//   simulation_phases.cpp    its phases as data, and the loop over the frames of all but sewing
//   simulation_placing.cpp   placing the panels around a body
//   simulation_put_on.cpp    sewing, growth, the first drape of a garment that is cut finer or that another one goes over
//   simulation_start.cpp     crossings before the first frame
//   simulation_live.cpp      the written frames: the drape, then the motion
//
// It can be left between any two frames and resumed: `place_` has the phase and the frame, and each phase begins at place_.frame.  Files, verdict
// and pictures are made by its observer.
#pragma once
#include "core/state_archive.hpp"
#include "core/stopwatch.hpp"
#include "dress/dressing.hpp"
#include "dress/dressing_body.hpp"
#include "dress/outfit_run.hpp"
#include "garment/placement.hpp"
#include "io/surface_mesh.hpp"
#include "sim/falling.hpp"
#include "sim/phase_report.hpp"
#include "sim/progress.hpp"
#include "sim/rest_watch.hpp"
#include "sim/setup.hpp"
#include "sim/simulation_observer.hpp"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

enum class RunPhase : std::uint8_t { sewing, growth, first_drape, drape, motion };

struct RunPlace {
  RunPhase phase = RunPhase::sewing;
  std::uint64_t cloth = 0;  // the one being put on
  std::int64_t frame = 0;   // frames of the phase that are simulated
  template <class Archive>
  void remember(Archive& archive) {
    archive(phase, cloth, frame);
  }
};

// A phase that is a loop over frames of the outfit's run.
struct PhasePlan {
  RunPhase which = RunPhase::drape;
  Phase cloth;
  std::string_view doing;            // for the progress
  std::string meanwhile;             // for a message: "while ..."
  std::int64_t frames = 0;           // at most
  std::optional<RestLimits> awaits;  // it ends early at rest,
  double rest_from_s = 0;            // but not before this time
  bool shown = false;                // its frames are written
  std::array<PhaseReport*, 2> reports{nullptr, nullptr};
};

struct SimulationOptions {
  std::function<void(const Progress&)> progress;  // may be empty
  std::function<bool()> stop;                     // asked between frames; may be empty
  double time_limit_s = 0;                        // wall time for dressing, up to the motion; 0: no limit
  double seconds_before = 0;                      // wall time since the program began, for the report
  Stopwatch watch;                                // since the run began
};

class Simulation {
 public:
  // The observer must outlive this object.
  Simulation(Scene scene, LoadedScene loaded, SimulationOptions options, SimulationObserver& observer);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // Simulates the whole scene.  Throws Error(bad_start) with `strict_start`.
  void run();

  // The same in parts.  Puts the garments on; false: it was stopped, or failed before any was on.
  bool put_on();
  // Call once, after put_on(): the first frame.  `prepare` is called before a saved state is read back: the changes of the cloth over time and
  // the body's motion have to be known by then.
  void begin(const std::function<void(OutfitRun&)>& prepare = {});
  bool has_begun() const { return begun_; }
  // Limits the drape from now on, in simulated and in wall time (0: no limit).
  void limit_dressing(double longest_s, double time_limit_s);
  // After the drape: is it worn, as far as that can be told without measuring?
  void judge_worn();
  // After a stop, or once dressing is over: clears the stop and the time limit.
  void go_on() {
    user_stopped_ = false;
    options_.time_limit_s = 0;
  }
  // Drapes until rest, where that is awaited, or until its time is over.  False: it failed, see failure().
  bool drape();
  // The run, whose frames the caller advances from here on.
  OutfitRun& live() { return *run_; }
  bool rests() const { return rest_.at_rest(); }
  // Dressing ended early: its last frame is the only one shown.
  bool stopped_short() const { return stopped_short_; }
  BodySurface* body() { return body_ ? &*body_ : nullptr; }

  const Scene& scene() const { return scene_; }
  // After begin(): all but the mesh, which live().model() has.
  const Outfit& outfit() const { return outfit_; }
  std::span<const Vec3> body_x() const { return body_x_; }
  std::span<const Triangle> body_triangles() const { return body_triangles_; }
  // Parts of the body's vertices: the body's own, then those of every solid.
  std::span<const JoinedColliders::Part> colliders() const { return colliders_; }
  Index particles_of_first_panels() const { return cloth_.front().garment.mesh.particle_count; }
  bool body_moves() const { return motion_.has_value(); }
  const std::optional<BodyMovement>& motion() const { return motion_; }
  // On live()'s clock; once the body has begun to move.
  double motion_from_s() const { return run_->motion_from_s(); }
  // After begin().
  std::string state();
  Report& report() { return report_; }
  const Report& report() const { return report_; }
  const std::vector<Reason>& failure() const { return failure_; }
  const std::vector<Reason>& qualifications() const { return qualifications_; }
  double seconds() const { return earlier_s_ + options_.watch.seconds(); }

  // Before begin(): resumes from a saved state.  The archive must outlive put_on() and run().
  void take_up(StateReader& archive);

 private:
  // simulation.cpp
  void say(std::string_view phase, double share, double seconds_left = -1) const {
    if (options_.progress) options_.progress({phase, share, seconds_left});
  }
  bool stopped() const {
    user_stopped_ = user_stopped_ || (options_.stop && options_.stop());
    return user_stopped_ || out_of_time();
  }
  bool out_of_time() const {
    return options_.time_limit_s > 0 && place_.phase != RunPhase::motion &&
           options_.watch.seconds() > options_.time_limit_s;
  }
  std::function<bool()> stop() const {
    return [this] { return stopped(); };
  }
  bool cut_off(const std::string& when);
  bool sewn() const { return scene_.cloth.front().is_sewn(); }
  bool awaits_rest() const { return scene_.until_still || motion_.has_value(); }
  double frame_s() const { return 1 / scene_.fps; }
  int frames_in(double seconds) const;
  void end(std::string_view how, const std::string& detail);
  void qualify(std::string_view code, const std::string& detail);
  void collapse(const std::string& when, const FrameReport& frame, const ClothMesh& mesh, std::span<const Vec3> x);
  void end_startup();
  double& startup(double StartupReport::*part);

  // Saving and restoring the state.
  template <class Archive>
  void remember(Archive& archive) {
    if constexpr (!Archive::reads) report_.seconds_total = seconds();
    archive(place_, frames_shown_, report_, failure_, qualifications_, pose_, on_shoulders_, open_pairs_,
            stopped_short_, fallen_, pinned_, seconds_before_motion_, touches_, rest_);
  }
  // Until restore() has been called.
  bool resumes() const { return taken_up_ != nullptr; }
  // Restores the rest of the state, that of its phase, once the outfit has its garments and its state.
  template <class Phase>
  void restore(Phase& phase);
  // After a frame of the phase, or before its first.
  template <class Phase>
  void between_frames(Phase& phase, bool first = false);

  // simulation_phases.cpp
  OutfitRun& outfit_run();
  Pace pace() const;
  PhasePlan growth_plan();
  PhasePlan first_drape_plan(std::size_t cloth);
  PhasePlan drape_plan();
  PhasePlan motion_plan();
  Phase drape_phase() const;
  void enter(const PhasePlan& plan, std::size_t cloth, const BodyAt& moves = {});
  bool go_through(const PhasePlan& plan);
  bool frame(const PhasePlan& plan);
  bool at_rest(const PhasePlan& plan) const;

  // simulation_start.cpp
  void bad_start(const std::string& name, const std::string& what);
  bool free_start(bool sewn_now);  // false: it was stopped
  std::vector<Index> held_now(bool sewn_now) const;
  int come_apart();

  // simulation_placing.cpp
  void find_person();
  const BodyFigures& figures();
  void make_thin();
  void stand();
  Placement place_around_arms(std::size_t cloth);
  void place(std::size_t cloth, bool tell);
  std::vector<LabelHeight> heights_of(std::size_t cloth, std::vector<std::string>& warnings);
  void tell_misfits(std::size_t cloth);

  // simulation_put_on.cpp
  void hang_as_drawn();
  void wear_again();
  void wear_next(Outfit& outfit, std::size_t k);
  void cut_finer(std::size_t k);
  bool sew(std::size_t cloth);
  FrameReport sew_frames(Dressing& dressing, bool filmed);
  void leave_open(std::size_t cloth, Dressing& dressing);
  bool grow(std::size_t cloth);
  bool falls_coarse(std::size_t cloth);
  bool drape_first(std::size_t cloth);

  // simulation_live.cpp
  Events events();
  void show_first();
  void animate();
  void close();
  int frames_in_motion() const;
  void watch_falling();
  bool lost();
  bool goes_on();
  void judge_end();
  bool slid_down(double share);

  Scene scene_;
  SimulationOptions options_;
  SimulationObserver* observer_;
  double earlier_s_ = 0;  // wall time before it was resumed
  Report report_;
  double after_startup_ = 0;
  std::vector<Reason> failure_, qualifications_;
  std::vector<LoadedCloth> cloth_;  // until begin()
  std::optional<Outfit> start_;     // likewise
  Outfit outfit_;
  std::optional<NewGarment> new_garment_;  // of the last weld
  Vec3s body_x_;                           // at the last frame
  Vec3s standing_x_;                       // the body when it is dressed
  std::vector<Triangle> body_triangles_;
  std::vector<JoinedColliders::Part> colliders_;
  std::optional<BodySurface> body_;
  std::size_t person_vertices_ = 0, person_triangles_ = 0;  // the first of body_x_ and body_triangles_; solids follow
  std::optional<BodyMeasurements> measurements_;
  std::optional<BodyFigures> figures_;         // of standing_x_; figures() makes them
  std::optional<DressingBody> dressing_body_;  // until the first garment is on
  std::optional<BodyMovement> motion_;
  StepOptions step_;
  TouchMemory touches_;
  std::optional<FallWatch> fall_watch_;
  std::optional<TrunkLevels> trunk_;  // of standing_x_; made on first use

  DressingBody::Pose pose_;    // of dressing_body_, while the first garment is sewn
  bool on_shoulders_ = false;  // it hangs from the shoulders, not from its waist
  std::vector<std::vector<Index>>
      open_pairs_;                     // [garment that is on] pairs its weld left open: indices of GarmentMesh::pairs
  std::vector<Belonging> belongings_;  // [garment]
  bool stopped_short_ = false;
  bool fallen_ = false;  // the last garment has, before it was cut finer
  // [garment] its pinned particles, once all garments are on.
  std::vector<std::vector<PinnedParticle>> pinned_;

  mutable bool user_stopped_ = false;  // options_.stop has returned true

  RunPlace place_;
  int frames_shown_ = 0;
  PhaseSeconds seconds_before_motion_;
  RestWatch rest_;
  StateReader* taken_up_ = nullptr;  // until its phase has restored it
  std::optional<OutfitRun> run_;     // from the weld of each garment on
  bool begun_ = false;
};

template <class Phase>
void Simulation::restore(Phase& phase) {
  phase.remember(*taken_up_);
  taken_up_->end();
  taken_up_ = nullptr;
}

template <class Phase>
void Simulation::between_frames(Phase& phase, bool first) {
  observer_->between_frames(first, [&] {
    StateWriter archive;
    remember(archive);
    archive(outfit_);
    phase.remember(archive);
    return archive.take();
  });
}

}  // namespace toile::internal
