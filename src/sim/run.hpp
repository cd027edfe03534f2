// sim/run.hpp: one run, from a scene to its report; what simulate() makes and runs.  Private to sim.
//
//   simulate.cpp       files and meshes in, at the end the verdict and the report
//   run_put_on.cpp     placing, sewing, untangling, the drape of what is worn below
//   run_live.cpp       every written frame: the drape, then the motion
//
// A run can be left between any two frames and taken up again (sim/checkpoint.hpp): `place_` says where it is, and each phase is a loop over
// frames that begins where place_.frame says.
#pragma once
#include "core/state_archive.hpp"
#include "core/stopwatch.hpp"
#include "garment/placement.hpp"
#include "io/run_folder.hpp"
#include "sim/checkpoint.hpp"
#include "sim/dressing.hpp"
#include "sim/dressing_body.hpp"
#include "sim/falling.hpp"
#include "sim/outfit_run.hpp"
#include "sim/phase_report.hpp"
#include "sim/recorder.hpp"
#include "sim/setup.hpp"
#include "sim/simulate.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

enum class RunPhase : std::uint8_t { sewing, growth, inner_drape, drape, motion };

struct RunPlace {
  RunPhase phase = RunPhase::sewing;
  std::uint64_t cloth = 0;  // while it is put on
  std::int64_t frame = 0;   // of the phase: how many have been simulated
  template <class Archive>
  void remember(Archive& archive) {
    archive(phase, cloth, frame);
  }
};

class Run {
 public:
  Run(const Scene& scene, const RunOptions& options) : scene_(scene), options_(options) {}
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  Report operator()();

 private:
  // simulate.cpp
  void load(Hash& inputs);
  void describe_run(const std::string& input_hash);
  void say(std::string_view phase, double share, double seconds_left = -1) const {
    if (options_.progress) options_.progress({phase, share, seconds_left});
  }
  bool stopped() const {
    user_stopped_ = user_stopped_ || (options_.stop && options_.stop());
    return user_stopped_ || out_of_time();
  }
  bool out_of_time() const {
    return options_.time_limit_s > 0 && place_.phase != RunPhase::motion && total_.seconds() > options_.time_limit_s;
  }
  std::function<bool()> stop() const {
    return [this] { return stopped(); };
  }
  bool cut_off(const std::string& when);
  BodySurface* body() { return body_ ? &*body_ : nullptr; }
  bool sewn() const { return scene_.cloth.front().is_sewn(); }
  bool awaits_rest() const { return scene_.until_still || motion_.has_value(); }
  double frame_s() const { return 1 / scene_.fps; }
  int frames_in(double seconds) const;
  void end(std::string_view how, const std::string& detail);
  void qualify(std::string_view code, const std::string& detail);
  void collapse(const std::string& when, const FrameReport& frame, const ClothMesh& mesh, std::span<const Vec3> x);
  void end_startup();
  double& startup(double StartupReport::*part);
  Report finish();

  // Taking up and keeping the state.
  template <class Archive>
  void remember(Archive& archive) {
    if constexpr (!Archive::reads) {
      written_ = writer_->frames();
      report_.seconds_total = earlier_s_ + total_.seconds();
    }
    archive(place_, written_, report_, failure_, qualifications_, pose_, on_shoulders_, open_pairs_, stopped_short_,
            before_inner_, slow_inner_, seconds_before_motion_, touches_);
  }
  void take_up(std::uint64_t input_hash);
  // Until restore() has been called.
  bool resumes() const { return taken_up_ != nullptr; }
  // The rest of the state, into the phase that it is about, once the outfit has its garments and its state.
  template <class Phase>
  void restore(Phase& phase);
  template <class Phase>
  void keep(Phase& phase);
  // After a frame of the phase.
  template <class Phase>
  void keep_if_due(Phase& phase) {
    if (checkpoints_->due()) keep(phase);
  }

  // run_put_on.cpp
  void place(GarmentMesh& garment, bool tell);
  Placement place_around_arms(GarmentMesh& garment);
  void bad_start(const std::string& name, const std::string& what);
  bool free_start(bool sewn_now);  // false: it was stopped
  std::vector<Index> held_now(bool sewn_now) const;
  int come_apart();
  bool put_on();
  void wear_again();
  std::vector<LabelHeight> heights_of(std::size_t cloth, std::vector<std::string>& warnings);
  const BodyFigures& figures();
  void tell_misfits(std::size_t cloth);
  bool sew(std::size_t cloth);
  void leave_open(std::size_t cloth, Dressing& dressing);
  FrameReport sew_frames(Dressing& dressing, bool filmed);
  void find_person();
  void make_thin();
  void stand();
  bool grow(std::size_t cloth);
  bool drape_inner(std::size_t cloth);

  // run_live.cpp
  void live();
  void begin_recording(OutfitRun& run);
  void drape(OutfitRun& run);
  void animate(OutfitRun& run);
  bool frame(OutfitRun& run, PhaseReport& phase, std::string_view what, std::int64_t k, PhaseReport* also = nullptr);
  void close(OutfitRun& run);
  int frames_in_motion() const;
  void watch_falling();
  bool in_wind() const;
  bool lost();
  bool goes_on(const OutfitRun& run);
  void judge_end(const OutfitRun& run);
  void find_slid_down();

  const Scene& scene_;
  const RunOptions& options_;
  Stopwatch total_;
  double earlier_s_ = 0;  // of a run that is taken up: what it had taken before
  Report report_;
  double after_startup_ = 0;
  std::vector<Reason> failure_, qualifications_;
  std::vector<LoadedCloth> cloth_;
  Outfit outfit_;
  Settling settling_;
  Vec3s body_x_;      // at the last frame
  Vec3s standing_x_;  // how the body stands when it is dressed
  std::vector<Triangle> body_triangles_;
  std::optional<BodySurface> body_;
  std::size_t person_vertices_ = 0, person_triangles_ = 0;  // of body_x_ and body_triangles_; solids come behind
  std::optional<BodyMeasurements> measurements_;
  std::optional<BodyFigures> figures_;         // as it stands; figures() makes them
  std::optional<DressingBody> dressing_body_;  // until the first garment is on
  std::optional<BodyMovement> motion_;
  StepOptions step_;
  std::unique_ptr<RunFolder> folder_;
  std::optional<RunWriter> writer_;
  std::optional<Recorder> recorder_;
  std::optional<Checkpoints> checkpoints_;
  TouchMemory touches_;
  std::optional<FallWatch> fall_watch_;

  DressingBody::Pose pose_;    // of dressing_body_, while the first garment is sewn
  bool on_shoulders_ = false;  // it hangs from there, not from its waist
  std::vector<std::vector<Index>>
      open_pairs_;                     // [garment that is on] what its weld left open: places in GarmentMesh::pairs
  std::vector<Belonging> belongings_;  // [garment]
  bool stopped_short_ = false;         // put on as far as it went: that one frame is written, and nothing moves

  mutable bool user_stopped_ = false;  // options_.stop has said so

  RunPlace place_;
  Vec3s before_inner_;  // x of the frame before, while a garment that others go over is draped
  int slow_inner_ = 0;  // its slow frames in a row
  PhaseSeconds seconds_before_motion_;
  std::string state_;                      // that was read,
  std::unique_ptr<StateReader> taken_up_;  // until the phase that it is about has taken it
  WrittenFrames written_;                  // when the state was kept
};

template <class Phase>
void Run::restore(Phase& phase) {
  phase.remember(*taken_up_);
  taken_up_->end();
  taken_up_.reset();
  state_ = {};
}

template <class Phase>
void Run::keep(Phase& phase) {
  StateWriter archive;
  remember(archive);
  archive(outfit_);
  phase.remember(archive);
  checkpoints_->save(archive.take());
}

}  // namespace toile::internal
