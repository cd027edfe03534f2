#include "sim/simulate.hpp"

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "garment/placement.hpp"
#include "sim/dressing.hpp"
#include "sim/falling.hpp"
#include "sim/offenders.hpp"
#include "sim/outfit_run.hpp"
#include "sim/recorder.hpp"
#include "sim/setup.hpp"
#include "sim/start_run.hpp"
#include "sim/start_state.hpp"

#include <fmt/printf.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace toile {
namespace {

constexpr double sewing_film_fps = 30;
constexpr double rest_s = 0.5;  // after a garment has settled, before it may be said to be still

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void add(PhaseReport& phase, const FrameReport& frame) {
  ++phase.frames;
  phase.steps += frame.steps;
  phase.steps_rejected += frame.rejected;
  phase.passes += frame.passes;
  phase.cg_iterations += frame.cg_iterations;
  phase.cg_max = std::max(phase.cg_max, frame.cg_max);
  phase.met += frame.met;
  phase.refused += frame.refused;
  phase.corrected += frame.corrected;
  phase.truncated += frame.truncated;
  phase.pierced += frame.pierced;
  phase.pinched = std::max(phase.pinched, frame.pinched);
  phase.touching += frame.last.touching;
  phase.contact_rows += frame.last.rows;
  if (frame.steps == 0) return;
  phase.step_min_s = phase.step_min_s == 0 ? frame.step_min_s : std::min(phase.step_min_s, frame.step_min_s);
  phase.step_max_s = std::max(phase.step_max_s, frame.step_max_s);
}

// Of what happened since `before`.
void set_seconds(PhaseReport& phase, const PhaseSeconds& seconds, const PhaseSeconds& before = {}) {
  phase.eval = seconds.eval - before.eval;
  phase.cg = seconds.cg - before.cg;
  phase.cloth_cloth = seconds.cloth_cloth - before.cloth_cloth;
  phase.filter = seconds.filter - before.filter;
  phase.cloth_solid = seconds.cloth_solid - before.cloth_solid;
  phase.body = seconds.body - before.body;
}

class Run {
 public:
  Run(const Scene& scene, const RunOptions& options) : scene_(scene), options_(options) {}

  Report operator()() {
    Hash inputs;
    add_to_hash(scene_, inputs);
    say("meshing", 0);
    report_.startup.scene = options_.seconds_before;
    load_cloth(inputs);
    load_solids(inputs);
    double edge_m = 0;
    for (const LoadedCloth& cloth : cloth_) edge_m = std::max(edge_m, cloth.edge_m);
    step_ = step_options(scene_, cloth_.front().fabrics.front(), edge_m);

    report_.name = scene_.name;
    report_.command = options_.command;
    report_.input_hash = inputs.hex();
    report_.threads = available_threads();
    report_.fps = scene_.fps;
    report_.body_vertices = static_cast<int>(body_x_.size());
    report_.body_triangles = static_cast<int>(body_triangles_.size());
    for (const LoadedCloth& cloth : cloth_) {
      report_.vertices += cloth.garment.mesh.particle_count;
      report_.triangles += cloth.garment.mesh.triangle_count();
      report_.panels += static_cast<int>(cloth.garment.mesh.panel_names.size());
      report_.seams += static_cast<int>(cloth.garment.seams.size());
    }

    writer_.emplace(options_.directory);
    if (put_on()) {
      report_.vertices = outfit_.mesh.particle_count;
      live();
    }
    return finish();
  }

 private:
  void say(std::string_view phase, double share, double seconds_left = -1) const {
    if (options_.progress) options_.progress({phase, share, seconds_left});
  }
  bool stopped() const { return options_.stop && options_.stop(); }
  BodySurface* body() { return body_ ? &*body_ : nullptr; }
  bool sewn() const { return scene_.cloth.front().is_sewn(); }
  bool awaits_rest() const { return scene_.until_still || motion_.has_value(); }

  void end(std::string_view how, std::string detail) {
    report_.ended = how;
    failure_.push_back({std::string(how), std::move(detail)});
  }

  // The verdict, if it is a pass, is one with this reservation.
  void qualify(std::string_view code, const std::string& detail) {
    for (Reason& known : qualifications_) {
      if (known.code != code) continue;
      known.detail += "; " + detail;
      return;
    }
    qualifications_.push_back({std::string(code), detail});
  }

  // The step could not be made however short: says over what, and leaves it in a file.
  void collapse(const std::string& when, const FrameReport& frame, const ClothMesh& mesh, std::span<const Vec3> x) {
    std::string words = when + ": " + frame.diagnosis;
    if (!frame.offenders.empty()) {
      const ObjMesh offenders = offenders_obj(mesh, x, frame.offenders, body_triangles_,
                                              body_ ? body_->positions() : std::span<const Vec3>{});
      words += "; offenders.obj: " + name_triangles(mesh, frame.offenders);
      const auto of_body = std::count(offenders.object.begin(), offenders.object.end(), 1);
      if (of_body > 0) words += ", and " + std::to_string(of_body) + " triangles of the body near them";
      writer_->offenders(offenders);
    }
    end(reason::step_collapsed, std::move(words));
  }

  void bad_start(const std::string& name, const std::string& what) {
    if (scene_.strict_start) throw Error(ExitCode::bad_start, printable(name) + ": bad start: " + what);
    report_.warnings.push_back("bad start: " + what);
  }

  void load_cloth(Hash& inputs) {
    const Timed timed(report_.startup.cloth);
    for (const SceneCloth& cloth : scene_.cloth)
      cloth_.push_back(toile::load_cloth(scene_, cloth, options_.read, inputs));
  }

  void load_solids(Hash& inputs) {
    const Timed timed(report_.startup.body);
    LoadedBody loaded = load_body(scene_.body, inputs);
    person_vertices_ = loaded.solid.positions.size();
    person_triangles_ = loaded.solid.triangles.size();
    add_solids(scene_.solids, loaded, inputs);
    motion_ = std::move(loaded.movement);
    report_.warnings.insert(report_.warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
    SolidMesh& solid = loaded.solid;
    body_x_ = solid.positions;
    body_triangles_ = solid.triangles;
    if (!body_triangles_.empty()) body_.emplace(std::move(solid.positions), std::move(solid.triangles));
  }

  // Called before every first step of something; the first of them counts.
  void end_startup() {
    if (report_.startup.total == 0) report_.startup.total = options_.seconds_before + total_.seconds();
  }
  // Where the time of one of its parts goes: after the first step, nowhere.
  double& startup(double StartupReport::*part) {
    return report_.startup.total == 0 ? report_.startup.*part : after_startup_;
  }

  // Cloth that passes through itself or the body is taken apart before the first frame, as far as it can be (sim/untangle.hpp).
  // `sewn_now`: what sewing left, not what the user gave; --strict-start is about the latter.
  void free_start(bool sewn_now) {
    const Timed timed(startup(&StartupReport::crossings));
    const StartCrossings found = start_crossings(outfit_, body_triangles_, body_x_);
    if (found.all() == 0) return;
    std::string what = std::to_string(found.cloth_cloth) + " edges of the cloth pass through it";
    if (body_) what += ", " + std::to_string(found.cloth_body) + " between cloth and body";
    if (scene_.strict_start && !sewn_now)
      throw Error(ExitCode::bad_start, printable(outfit_.parts.front().name) + ": bad start: " + what);
    say("untangling", 0);
    const UntangledStart untangled =
        untangle_start(outfit_, body_triangles_, body_x_, held_now(sewn_now), [&] { return stopped(); });
    if (!untangled.moved_far.empty()) qualify(reason::moved_by_untangling, untangled.moved_far);
    const int weightless = sewn_now ? come_apart() : 0;
    const StartCrossings left = start_crossings(outfit_, body_triangles_, body_x_);
    StartReport& start = report_.start;  // of the last garment when several are sewn; trials of all of them
    start = {found.cloth_cloth,
             found.cloth_body,
             left.cloth_cloth,
             left.cloth_body,
             start.trials + untangled.trials,
             std::max(start.largest_move_mm, untangled.largest_move_mm)};
    const std::string then = left.all() == 0 ? "none is left" : std::to_string(left.all()) + " are left";
    std::string tried = std::to_string(untangled.trials) + " trials of untangling ";
    if (weightless > 0)
      tried += "and " + std::to_string(weightless) + (weightless == 1 ? " frame" : " frames") + " without weight ";
    report_.warnings.push_back((sewn_now ? "as sewn: " : "bad start: ") + what + "; after " + tried + then);
  }

  // What untangling must leave where it is: what was worn before, or what pins hold from the first moment.
  std::vector<Index> held_now(bool sewn_now) const {
    if (!sewn_now) return held_from_the_start(events_of(outfit_, cloth_));
    std::vector<Index> worn(static_cast<std::size_t>(settling_.held_particles));
    std::iota(worn.begin(), worn.end(), 0);
    return worn;
  }

  // What trials from rest leave of a weld may come apart as the garment moves, with threads that want to be as long as they were cut, before
  // it has weight.  Nothing of it is written.  Returns the number of frames.
  int come_apart() {
    Settling waiting = settling_;
    waiting.waits = true;
    std::optional<OutfitRun> run;
    const int most = frames_in(most_waiting_s);
    int frames = 0;
    while (frames < most && start_crossings(outfit_, {}, {}).all() > 0) {
      if (!run) run.emplace(scene_, outfit_, body(), step_, waiting, options_.stop);
      const FrameReport frame = run->frame();
      if (frame.interrupted || !frame.ok) break;  // as the drape will say
      ++frames;
    }
    if (frames > 0) outfit_.state.v.assign(outfit_.state.v.size(), Vec3::Zero());
    return frames;
  }

  void place(GarmentMesh& garment) {
    if (!body_) return;
    const Timed timed(startup(&StartupReport::placement));
    say("placing", 0);
    const Placement placement = place_garment(garment, *body_);
    report_.shift_m = placement.shift_m;
    if (placement.panel_crossings > 0)
      bad_start(garment.name,
                std::to_string(placement.panel_crossings) + " edges of the placed panels pass through the body");
    for (const Index seam : placement.blocked_seams)
      report_.warnings.push_back("the straight way between the two sides of seam " +
                                 garment.seams[static_cast<std::size_t>(seam)].name + " leads through the body");
  }

  // Fills the outfit; false when a garment could not be closed or did not come to its drape.
  bool put_on() {
    if (!scene_.start.empty()) {
      outfit_ = start_from(scene_.start, cloth_, body_x_);
      settling_.to_rest = sewn() && awaits_rest();
      free_start(false);
      return true;
    }
    if (!sewn()) {
      outfit_ = outfit_of_shapes(cloth_);
      free_start(false);
      return true;
    }
    for (std::size_t k = 0; k < cloth_.size(); ++k) {
      if (!sew(k)) return false;
      if (k + 1 < cloth_.size() && !drape_inner(k)) return false;
    }
    return true;
  }

  // Leaves the outfit welded, with the garment on.
  bool sew(std::size_t k) {
    LoadedCloth& cloth = cloth_[k];
    GarmentMesh& garment = cloth.garment;
    place(garment);
    SewingOptions sewing_options;
    sewing_options.step_max_s = scene_.step_max_s.value_or(1 / sewing_options.fps);
    sewing_options.paper_scaling = scene_.paper_scaling;
    sewing_options.damping_jacobian = scene_.damping_jacobian;
    sewing_options.label_heights =
        label_heights_of(scene_.cloth[k], garment, std::span(body_x_).first(person_vertices_),
                         std::span(body_triangles_).first(person_triangles_), report_.warnings);
    sewing_options.stop = options_.stop;
    Dressing dressing(outfit_, garment, cloth.fabrics, cloth.rest_stretch, body(), step_, sewing_options);
    if (dressing.tangled()) bad_start(garment.name, "placed panels pass through each other");
    Sewing& sewing = dressing.sewing();
    const bool filmed = k == 0;  // the panels of the others come with what is worn: another mesh
    if (filmed) writer_->begin_sewing(garment.mesh, garment.name, garment.x);
    const int every = std::max(1, static_cast<int>(std::lround(sewing_options.fps / sewing_film_fps)));
    end_startup();
    Stopwatch watch;
    PhaseReport& phase = report_.sewing;
    FrameReport frame;
    int frames = 0;
    while (sewing.status() == SewingStatus::sewing && !stopped()) {
      {
        const Timed timed(phase.seconds);
        frame = sewing.frame();
      }
      if (frame.interrupted) break;
      add(phase, frame);
      ++frames;
      if (filmed && (frames % every == 0 || sewing.status() != SewingStatus::sewing))
        writer_->sewing_frame(sewing.state().x);
      const double share = sewing.closed_share();
      say("sewing", share, share > 0.05 ? watch.seconds() * (1 - share) / share : -1);
    }
    phase.simulated_s += sewing.time_s();
    const PhaseSeconds seconds = sewing.seconds();
    phase.eval += seconds.eval;
    phase.cg += seconds.cg;
    phase.cloth_cloth += seconds.cloth_cloth;
    phase.filter += seconds.filter;
    phase.cloth_solid += seconds.cloth_solid;
    const std::string which = cloth_.size() > 1 ? printable(garment.name) + ": " : "";
    switch (sewing.status()) {
      case SewingStatus::closed:
        break;
      case SewingStatus::sewing:
        end(reason::interrupted, which + "while sewing, after " + std::to_string(frames) + " frames");
        break;
      case SewingStatus::blocked:
        end(reason::seam_blocked, which + dressing.explain() + (frame.ok ? "" : "; then " + frame.diagnosis));
        break;
      case SewingStatus::failed:
        collapse(which + "while sewing (" + dressing.explain() + ")", frame, sewing.model().mesh, sewing.state().x);
        break;
    }
    if (sewing.status() != SewingStatus::closed) {
      outfit_.state = sewing.state();  // for the hash
      return false;
    }
    settling_ = {true, outfit_.mesh.particle_count, dressing.labels(), awaits_rest()};
    outfit_ = dressing.worn();
    free_start(true);
    return true;
  }

  // A garment that another one goes over comes to rest first; nothing of it is written.
  bool drape_inner(std::size_t k) {
    OutfitRun run(scene_, outfit_, body(), step_, settling_, options_.stop);
    const int frames = frames_in(scene_.drape_seconds);
    Vec3s before = outfit_.state.x;
    int slow = 0;
    for (int f = 1; f < frames && slow < rest_s * scene_.fps; ++f) {
      const FrameReport frame = run.frame();
      if (frame.interrupted || !frame.ok) {
        const std::string when = "while " + printable(cloth_[k].garment.name) + " was draped";
        if (frame.ok)
          end(reason::interrupted, when);
        else
          collapse(when, frame, outfit_.mesh, outfit_.state.x);
        return false;
      }
      slow =
          run.settled() && speed_p99_mm_per_s(before, outfit_.state.x, scene_.fps) < inner_rest_mm_per_s ? slow + 1 : 0;
      before = outfit_.state.x;
      say("draping", static_cast<double>(f) / frames);
    }
    outfit_.state.v.assign(outfit_.state.v.size(), Vec3::Zero());
    return true;
  }

  int frames_in(double seconds) const { return std::max(1, static_cast<int>(std::lround(seconds * scene_.fps))); }

  // From the first written frame to the last: drape, then motion.
  void live() {
    OutfitRun run(scene_, outfit_, body(), step_, settling_, options_.stop);
    Events events = events_of(outfit_, cloth_);
    std::vector<Vec2> rest_stretch = outfit_.rest_stretch;  // at the end
    for (const TimedRestStretch& timed : events.rest_stretch)
      rest_stretch[static_cast<std::size_t>(timed.panel)] = timed.keys.back().b;
    for (std::size_t p = 0; p < rest_stretch.size(); ++p) {
      const Vec2& b = rest_stretch[p];
      if (b != Vec2(1, 1)) report_.rest_stretch.push_back({outfit_.mesh.panel_names[p], {b.y(), b.x()}});
    }
    run.set_events(std::move(events));
    recorder_.emplace(*writer_, outfit_, rest_stretch, scene_.fps, body_triangles_, body_x_);
    watch_falling();
    // What hangs now is the run's: a second and a third copy of a fine mesh are large.
    cloth_.clear();
    outfit_.mesh = {};
    PhaseReport& phase = report_.drape;
    report_.ended = "time";
    end_startup();
    const bool moving = motion_.has_value();
    const int drape_frames =
        moving ? (scene_.drape_seconds > 0 ? frames_in(scene_.drape_seconds) : 1) : frames_in(scene_.seconds);
    Stopwatch watch;
    for (int k = 1; k < drape_frames; ++k) {
      if (!frame(run, phase, "draping", k)) return close(run);
      say("draping", static_cast<double>(k) / drape_frames, watch.seconds() * (drape_frames - 1 - k) / k);
      if (awaits_rest() && run.settled() && run.time_s() - frame_s() > settle_s() + rest_s && recorder_->at_rest()) {
        if (!moving) report_.ended = "still";
        break;
      }
    }
    if (moving) animate(run);
    if (report_.ended == "time") judge_end(run);
    close(run);
  }

  // Garments that fall to nowhere end the run, where that can be told: in still air, and if no hand holds the cloth.
  void watch_falling() {
    if (!sewn() || !body_ || scene_.gravity_m_per_s2.isZero(0)) return;
    for (const SceneCloth& cloth : scene_.cloth)
      if (!cloth.drags.empty()) return;
    fall_watch_.emplace(scene_.gravity_m_per_s2, body_triangles_, motion_ ? motion_->at : BodyAt{},
                        motion_ ? frames_in_motion() * frame_s() : 0, frame_s());
  }
  bool in_wind() const { return scene_.air.density_kg_per_m3 > 0 && !scene_.air.wind_m_per_s.isZero(0); }

  bool lost() {
    const std::optional<LostGarment> lost = fall_watch_->find(outfit_.parts, outfit_.state, body_x_);
    if (!lost) return false;
    const auto p = static_cast<std::size_t>(lost->part);
    const bool touched = touches_.touched[p] != 0;
    end(touched ? reason::fell_off : reason::never_touched,
        printable(outfit_.parts[p].name) + (touched ? " fell off the body" : " never touched the body") +
            ", and nothing below will catch it: " + lost->where);
    return true;
  }

  // Of a run whose time is over.
  void judge_end(const OutfitRun& run) {
    if (!run.settled())
      failure_.push_back({std::string(reason::not_settled),
                          fmt::sprintf("it ended %.3g s after the weld; gravity and elastic are full after %.3g s",
                                       run.time_s(), OutfitRun::settling_s)});
    else if (fall_watch_ && in_wind())
      lost();
  }

  void animate(OutfitRun& run) {
    run.start_motion(motion_->at);
    PhaseReport& phase = report_.motion;
    report_.motion_name = motion_->name;
    report_.motion_first_frame = writer_->cloth_frames() - 1;
    const PhaseSeconds before = run.seconds();
    const int frames = frames_in_motion();
    Stopwatch watch;
    for (int k = 1; k <= frames; ++k) {
      motion_->at(static_cast<double>(k) * frame_s(), body_x_);
      const double drape_seconds = report_.drape.seconds;
      const bool good = frame(run, report_.drape, "moving", k, &phase);
      phase.seconds += report_.drape.seconds - drape_seconds;
      if (!good) break;
      say("moving", static_cast<double>(k) / frames, watch.seconds() * (frames - k) / k);
    }
    phase.simulated_s = phase.frames * frame_s();
    set_seconds(phase, run.seconds(), before);
  }

  int frames_in_motion() const {
    const bool whole = !scene_.seconds_given && std::isfinite(motion_->duration_s);
    return frames_in(whole ? motion_->duration_s : scene_.seconds);
  }
  double frame_s() const { return 1 / scene_.fps; }
  double settle_s() const { return settling_.sewn ? OutfitRun::settling_s : -rest_s; }

  // One frame, simulated and written; false when it is the last for a bad reason.
  bool frame(OutfitRun& run, PhaseReport& phase, std::string_view what, int k, PhaseReport* also = nullptr) {
    FrameReport frame;
    {
      const Timed timed(phase.seconds);
      frame = run.frame();
    }
    if (frame.interrupted) {
      end(reason::interrupted, "while " + std::string(what) + ", after frame " + std::to_string(k - 1));
      return false;
    }
    add(phase, frame);
    if (also != nullptr) add(*also, frame);
    if (!frame.ok) {
      collapse("in frame " + std::to_string(k), frame, run.model().mesh, outfit_.state.x);
      return false;
    }
    recorder_->frame(outfit_.state.x, body_x_);
    if (!fall_watch_) return true;
    note_touches(outfit_.parts, run, touches_);
    return !run.settled() || in_wind() || !lost();
  }

  void close(OutfitRun& run) {
    report_.drape.simulated_s = report_.drape.frames * frame_s();
    set_seconds(report_.drape, run.seconds());
    report_.layer_gap = run.layer_gap();
  }

  Report finish() {
    Hash state;
    state.add(std::span<const Vec3>(outfit_.state.x));
    state.add(std::span<const Vec3>(outfit_.state.v));
    report_.state_hash = state.hex();
    report_.frames = writer_->cloth_frames();
    Limits limits;
    const bool fell = report_.ended == reason::never_touched || report_.ended == reason::fell_off;
    limits.must_be_still = scene_.until_still && !motion_ && !fell;  // of what falls rest is not asked
    report_.verdict.limits = limits;
    if (recorder_) {
      report_.audit = recorder_->report();
      report_.audit.must_be_still = limits.must_be_still;
      report_.verdict = judge(report_.audit, limits);
    }
    auto& reasons = report_.verdict.reasons;
    reasons.insert(reasons.begin(), failure_.begin(), failure_.end());
    report_.verdict.pass = reasons.empty();
    report_.verdict.qualifications = qualifications_;
    report_.seconds_total = total_.seconds();
    report_.peak_memory_mb = peak_memory_mb();
    writer_->finish(to_json(report_));
    return report_;
  }

  static constexpr double inner_rest_mm_per_s = 10, most_waiting_s = 1;

  const Scene& scene_;
  const RunOptions& options_;
  Stopwatch total_;
  Report report_;
  double after_startup_ = 0;
  std::vector<Reason> failure_, qualifications_;
  std::vector<LoadedCloth> cloth_;
  Outfit outfit_;
  Settling settling_;
  Vec3s body_x_;  // at the last frame
  std::vector<Triangle> body_triangles_;
  std::optional<BodySurface> body_;
  std::size_t person_vertices_ = 0, person_triangles_ = 0;  // of body_x_ and body_triangles_; solids come behind
  std::optional<BodyMovement> motion_;
  StepOptions step_;
  std::optional<RunWriter> writer_;
  std::optional<Recorder> recorder_;
  TouchMemory touches_;
  std::optional<FallWatch> fall_watch_;
};

}  // namespace

Report simulate(const Scene& scene, const RunOptions& options) { return Run(scene, options)(); }

ExitCode exit_code(const Report& report) {
  if (report.ended == reason::interrupted) return ExitCode::interrupted;
  return report.verdict.pass ? ExitCode::ok : ExitCode::simulation_failed;
}

}  // namespace toile
