// sim/run_put_on.cpp: from flat panels to a garment that is on; what was worn before comes first.
#include "core/error.hpp"
#include "garment/layering.hpp"
#include "garment/placement.hpp"
#include "garment/sleeves.hpp"
#include "sim/body_figures.hpp"
#include "sim/run.hpp"
#include "sim/start_run.hpp"
#include "sim/start_state.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace toile::internal {
namespace {

constexpr double sewing_film_fps = 30;
constexpr double inner_rest_mm_per_s = 10;  // of a garment that others go over,
constexpr double inner_rest_s = 0.5;        // for so long
constexpr double most_waiting_s = 1;
constexpr std::array<double, 4> arm_lifts{0, 0.25, 0.5, 1};  // 1: level

}  // namespace

void Run::bad_start(const std::string& name, const std::string& what) {
  if (scene_.strict_start) throw Error(ExitCode::bad_start, printable(name) + ": bad start: " + what);
  report_.warnings.push_back("bad start: " + what);
}

// Cloth that passes through itself or the body is taken apart before the first frame, as far as it can be (sim/start_state.hpp).
// `sewn_now`: what sewing left, not what the user gave; --strict-start is about the latter.
bool Run::free_start(bool sewn_now) {
  const Timed timed(startup(&StartupReport::crossings));
  const StartCrossings found = start_crossings(outfit_, body_triangles_, body_x_);
  if (found.all() == 0) return true;
  std::string what = std::to_string(found.cloth_cloth) + " edges of the cloth pass through it";
  if (body_) what += ", " + std::to_string(found.cloth_body) + " between cloth and body";
  if (scene_.strict_start && !sewn_now)
    throw Error(ExitCode::bad_start, printable(outfit_.parts.front().name) + ": bad start: " + what);
  say("untangling", 0);
  const UntangledStart untangled = untangle_start(
      outfit_, body_triangles_, body_x_, held_now(sewn_now), [&] { return stopped(); }, sewn_now ? sewn_in_vain : 0);
  if (!untangled.moved_far.empty()) qualify(reason::moved_by_untangling, untangled.moved_far);
  const int weightless = sewn_now ? come_apart() : 0;
  // How far it came is by chance: it begins again when the run goes on.
  if (stopped() && !cut_off("while untangling")) return false;
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
  return true;
}

// What untangling must leave where it is: what was worn before, or what pins hold from the first moment.
std::vector<Index> Run::held_now(bool sewn_now) const {
  if (!sewn_now) return held_from_the_start(events_of(outfit_, cloth_));
  std::vector<Index> worn(static_cast<std::size_t>(settling_.held_particles));
  std::iota(worn.begin(), worn.end(), 0);
  return worn;
}

// What trials from rest leave of a weld may come apart as the garment moves, with threads that want to be as long as they were cut, before
// it has weight.  Nothing of it is written.  Returns the number of frames.
int Run::come_apart() {
  Settling waiting = settling_;
  waiting.waits = waiting.weightless = true;
  std::optional<OutfitRun> run;
  const int most = frames_in(most_waiting_s);
  int frames = 0;
  while (frames < most && start_crossings(outfit_, {}, {}).all() > 0) {
    if (!run) run.emplace(scene_, outfit_, body(), step_, waiting, stop());
    const FrameReport frame = run->frame();
    if (frame.interrupted || !frame.ok) break;  // as the drape will say
    ++frames;
  }
  if (frames > 0) outfit_.state.v.assign(outfit_.state.v.size(), Vec3::Zero());
  return frames;
}

// With the arms lifted no farther than leaves the fewest seams behind the thin body.  A wide bodice is drawn flat across the arms: they
// have to be out of the way of its sides.
Placement Run::place_around_arms(GarmentMesh& garment) {
  const GarmentMesh drawn = garment;
  Placement best;
  for (const double lift : arm_lifts) {
    dressing_body_->set_pose({{lift, lift}, {1, 1}});
    GarmentMesh placed = drawn;
    const std::array<DressingBody::ArmAxis, 2> axes = dressing_body_->arm_axes();
    const std::array<ArmLine, 2> arms{ArmLine{axes[0].root, axes[0].direction},
                                      ArmLine{axes[1].root, axes[1].direction}};
    hang_sleeves(placed, arms, dressing_body_->height_m());
    separate_layers(placed, 0.5 * (arms[0].root + arms[1].root));
    dressing_body_->lifted(body_x_);
    stand();
    Placement placement = place_garment(placed, *body_, person_vertices_);
    const std::array<double, 2> sleeves_m =
        hang_sleeves(placed, arms, dressing_body_->height_m());  // the shift was the whole garment's
    const std::array<bool, 2> covered = covers_shoulders(placed, arms);
    const DressingBody::Pose pose = dressing_body_->pose_within(lift, covered, sleeves_m);
    dressing_body_->set_pose(pose);
    dressing_body_->at(0, body_x_);
    stand();
    find_blocked(placed, *body_, placement);

    if (lift != arm_lifts.front() && placement.blocked >= best.blocked) continue;
    best = placement;
    pose_ = pose;
    on_shoulders_ = covered[0] || covered[1];
    garment = std::move(placed);
    if (best.blocked == 0) break;
  }
  make_thin();
  return best;
}

// `tell`: what is wrong with the place.
void Run::place(GarmentMesh& garment, bool tell) {
  if (!body_) return;
  const Timed timed(startup(&StartupReport::placement));
  say("placing", 0);
  const Placement placement =
      dressing_body_ ? place_around_arms(garment) : place_garment(garment, *body_, person_vertices_);
  if (!tell) return;
  report_.shift_m = placement.shift_m;
  if (placement.raised_m != 0)
    report_.warnings.push_back(
        fmt::sprintf("%s is in the frame of the templates of 2021, with y = 0 near the pelvis: raised by %.1f cm, %g "
                     "of the body's height",
                     printable(garment.name), 100 * placement.raised_m, legacy_origin));
  if (placement.panel_crossings > 0)
    bad_start(garment.name,
              std::to_string(placement.panel_crossings) + " edges of the placed panels pass through the body");
  for (const Index seam : placement.blocked_seams)
    report_.warnings.push_back("the straight way between the two sides of seam " +
                               garment.seams[static_cast<std::size_t>(seam)].name + " leads through the body");
}

std::vector<LabelHeight> Run::heights_of(std::size_t cloth, std::vector<std::string>& warnings) {
  return label_heights_of(scene_.cloth[cloth], cloth_[cloth].garment, cloth == 0 && on_shoulders_, figures(), warnings);
}

const BodyFigures& Run::figures() {
  if (!figures_)
    figures_ = body_figures(std::span(standing_x_).first(person_vertices_),
                            std::span(body_triangles_).first(person_triangles_), measurements_);
  return *figures_;
}

// What the pattern says of the body that it was cut for, where this is another one.
void Run::tell_misfits(std::size_t cloth) {
  if (!cloth_[cloth].pattern || person_vertices_ == 0) return;
  const std::string which = cloth_.size() > 1 ? printable(cloth_[cloth].garment.name) + ": " : "";
  for (const Misfit& misfit : misfits(*cloth_[cloth].pattern, figures()))
    report_.warnings.push_back(which + std::string(misfit.code) + ": the pattern is cut for " + misfit.expected +
                               "; this body has " + misfit.got);
}

// Fills the outfit; false when a garment could not be closed or did not come to its drape.
bool Run::put_on() {
  if (resumes() && place_.phase >= RunPhase::drape) return true;
  if (!scene_.start.empty() || !sewn()) {
    outfit_ = scene_.start.empty() ? outfit_of_shapes(cloth_) : start_from(scene_.start, cloth_, body_x_);
    settling_.to_rest = sewn() && awaits_rest();
    return free_start(false);
  }
  for (std::size_t k = place_.cloth; k < cloth_.size(); ++k) {
    const bool is_sewn = resumes() && place_.phase != RunPhase::sewing;
    const bool is_on = is_sewn && place_.phase != RunPhase::growth;
    if (k == 0 && !is_on) find_person();
    if (!is_sewn && !sew(k)) return false;
    if (k == 0 && !is_on && !stopped_short_ && !grow(k)) return false;
    stopped_short_ = stopped_short_ || (k < open_pairs_.size() && !open_pairs_[k].empty());
    if (stopped_short_) return true;
    if (k + 1 < cloth_.size() && !drape_inner(k)) return stopped_short_;
  }
  return true;
}

// The garments that were on when the run was left, but for where they were.
void Run::wear_again() {
  if (!scene_.start.empty() || !sewn()) {
    outfit_ = scene_.start.empty() ? outfit_of_shapes(cloth_) : start_from(scene_.start, cloth_, body_x_);
    outfit_.thickness_scale.assign(outfit_.state.x.size(), 1);
    settling_.to_rest = sewn() && awaits_rest();
    return;
  }
  const std::size_t worn = static_cast<std::size_t>(place_.cloth) + (place_.phase == RunPhase::sewing ? 0 : 1);
  std::vector<std::string> told_before;
  for (std::size_t j = 0; j < worn; ++j) {
    LoadedCloth& cloth = cloth_[j];
    const Index before = outfit_.mesh.particle_count;
    if (j < open_pairs_.size()) cloth_[j].garment.leave_open(open_pairs_[j]);
    LabelSprings labels = wear(outfit_, cloth.garment, cloth.fabrics, cloth.rest_stretch, heights_of(j, told_before));
    settling_ = {true, before, std::move(labels), awaits_rest()};
  }
}

// What would not close stays open: the garment is welded as far as it goes, and written as it is then.  With weight, what hangs by nothing
// would fall out of the picture.
void Run::leave_open(std::size_t k, Dressing& dressing) {
  const GarmentMesh& panels = dressing.panels();
  const std::vector<SeamGap> gaps = dressing.sewing().gaps();
  const std::vector<SeamPair> pairs = panels.pairs;
  open_pairs_[k] = dressing.leave_open();
  cloth_[k].garment.leave_open(open_pairs_[k]);
  const std::vector<Index> particle_of = dressing.particle_of();
  for (const SeamGap& gap : gaps) {
    OpenSeam open{panels.seams[static_cast<std::size_t>(gap.seam)].name, gap.gap_m, gap.where, {}};
    for (const Index pair : open_pairs_[k]) {
      const SeamPair& ends = pairs[static_cast<std::size_t>(pair)];
      if (ends.seam == gap.seam)
        open.vertices.push_back(
            {particle_of[static_cast<std::size_t>(ends.a)], particle_of[static_cast<std::size_t>(ends.b)]});
    }
    if (!open.vertices.empty()) report_.open_seams.push_back(std::move(open));
  }
}

// Leaves the outfit welded, with the garment on.
bool Run::sew(std::size_t k) {
  const bool resumed = resumes();
  if (!resumed) place_ = {RunPhase::sewing, k, 0};
  LoadedCloth& cloth = cloth_[k];
  GarmentMesh& garment = cloth.garment;
  place(garment, !resumed);
  if (!resumed) tell_misfits(k);
  SewingOptions sewing_options;
  sewing_options.step_max_s = scene_.step_max_s.value_or(1 / sewing_options.fps);
  sewing_options.paper_scaling = scene_.paper_scaling;
  sewing_options.damping_jacobian = scene_.damping_jacobian;
  std::vector<std::string> told_before;
  sewing_options.label_heights = heights_of(k, resumed ? told_before : report_.warnings);
  sewing_options.labels_hold_panels = k == 0 && dressing_body_ && !on_shoulders_;
  sewing_options.stop = stop();
  Dressing dressing(outfit_, garment, cloth.fabrics, cloth.rest_stretch, body(), step_, sewing_options);
  Sewing& sewing = dressing.sewing();
  if (sewing_options.labels_hold_panels && !dressing.labels().empty()) {
    pose_.falls_s = DressingBody::falling_s;
    dressing_body_->set_pose(pose_);
  }
  const bool filmed = k == 0;  // the panels of the others come with what is worn: another mesh
  if (resumed) {
    restore(dressing);
  } else {
    if (dressing.tangled()) bad_start(garment.name, "placed panels pass through each other");
    checkpoints_->wait();
    if (filmed) {
      const std::span thin = std::span<const Triangle>(body_triangles_).first(dressing_body_ ? person_triangles_ : 0);
      writer_->begin_sewing(garment.mesh, garment.name, garment.x, thin, std::span(body_x_).first(person_vertices_));
    }
    end_startup();
    keep(dressing);
  }
  const FrameReport frame = sew_frames(dressing, filmed);
  PhaseReport& phase = report_.sewing;
  phase.simulated_s += sewing.time_s();
  add_seconds(phase, sewing.seconds());
  const std::string which = cloth_.size() > 1 ? printable(garment.name) + ": " : "";
  // What blocks it may still come apart: that it is blocked is not known before.
  const bool ended =
      sewing.status() != SewingStatus::sewing && !(sewing.status() == SewingStatus::blocked && stopped());
  if (!ended) {
    if (!cut_off(which + "while sewing, after " + std::to_string(place_.frame) + " frames")) {
      outfit_.state = sewing.state();  // for the hash
      return false;
    }
  } else if (sewing.status() == SewingStatus::blocked) {
    end(reason::seam_blocked, which + dressing.explain() + (frame.ok ? "" : "; then " + frame.diagnosis));
  } else if (sewing.status() == SewingStatus::failed) {
    collapse(which + "while sewing (" + dressing.explain() + ")", frame, sewing.model().mesh, sewing.state().x);
  }
  open_pairs_.resize(k + 1);
  if (sewing.status() != SewingStatus::closed) leave_open(k, dressing);
  settling_ = {true, outfit_.mesh.particle_count, dressing.labels(), awaits_rest()};
  outfit_ = dressing.worn();
  return stopped_short_ || free_start(true);
}

// A phase ends before its end.  False: the user wants it so, and the run can be resumed.  True: the time that it was given is over, and what
// there is is written.
bool Run::cut_off(const std::string& when) {
  stopped_short_ = !user_stopped_;
  if (stopped_short_)
    end(reason::time_limit, fmt::sprintf("%.3g s were over ", options_.time_limit_s) + when);
  else
    end(reason::interrupted, when);
  return stopped_short_;
}

// Around whom the first garment is sewn, if it is a person.
void Run::find_person() {
  const Timed timed(startup(&StartupReport::placement));
  Arms arms =
      find_arms(std::span(standing_x_).first(person_vertices_), std::span(body_triangles_).first(person_triangles_));
  figures();
  add_arms(*figures_, arms);
  if (measurements_ && !resumes()) {
    const std::string odd = odd_pose(*measurements_, *figures_);
    if (!odd.empty()) report_.warnings.push_back(odd);
  }
  if (!arms) return;
  dressing_body_.emplace(standing_x_, body_triangles_, person_vertices_, person_triangles_, std::move(*arms));
  make_thin();
}

void Run::make_thin() {
  dressing_body_->set_pose(pose_);
  dressing_body_->at(0, body_x_);
  stand();
}

// The body stands where body_x_ says: twice, as what it has been is a motion too.
void Run::stand() {
  for (int k = 0; k < 2; ++k) body_->set_motion(body_x_, body_x_);
}

// The body becomes what it is, within the garment.  Nothing of it is written.
bool Run::grow(std::size_t k) {
  if (!dressing_body_) return true;
  Settling waiting = settling_;
  waiting.waits = true;
  waiting.weightless = pose_.falls_s == 0;
  waiting.to_rest = false;
  OutfitRun run(scene_, outfit_, body(), step_, waiting, stop());
  run.start_motion([&](double t_s, std::span<Vec3> x) { dressing_body_->at(t_s, x); });
  if (resumes()) {
    restore(run);
  } else {
    place_ = {RunPhase::growth, k, 0};
    keep(run);
  }
  const int frames = frames_in(dressing_body_->growth_s());
  while (place_.frame < frames) {
    const FrameReport frame = run.frame();
    if (frame.interrupted && !cut_off("while the body grew into the garment")) return false;
    if (!frame.interrupted && !frame.ok) {
      collapse("while the body grew into the garment", frame, outfit_.mesh, outfit_.state.x);
      stopped_short_ = true;
    }
    if (stopped_short_) break;
    ++place_.frame;
    keep_if_due(run);
    say("fitting", static_cast<double>(place_.frame) / frames);
  }
  outfit_.state.v.assign(outfit_.state.v.size(), Vec3::Zero());
  body_x_ = standing_x_;
  if (stopped_short_) body_x_.assign(body_->next_positions().begin(), body_->next_positions().end());
  stand();
  dressing_body_.reset();
  return true;
}

// Until the seams are closed or will not close; returns what the last frame was.
FrameReport Run::sew_frames(Dressing& dressing, bool filmed) {
  Sewing& sewing = dressing.sewing();
  const int every = std::max(1, static_cast<int>(std::lround(SewingOptions{}.fps / sewing_film_fps)));
  const Stopwatch watch;
  FrameReport frame;
  while (sewing.status() == SewingStatus::sewing && !stopped()) {
    {
      const Timed timed(report_.sewing.seconds);
      frame = sewing.frame();
    }
    if (frame.interrupted) break;
    add_frame(report_.sewing, frame);
    ++place_.frame;
    if (filmed && (place_.frame % every == 0 || sewing.status() != SewingStatus::sewing))
      writer_->sewing_frame(sewing.state().x);
    if (sewing.status() == SewingStatus::blocked) {
      say("untangling", 0);
      const std::string why = dressing.explain();
      if (dressing.take_apart(body_triangles_, body_x_, [&] { return stopped(); }))
        report_.warnings.push_back("while sewing: " + why +
                                   "; what was in the way was taken apart, and sewing went on");
    }
    if (sewing.status() == SewingStatus::sewing) keep_if_due(dressing);
    const double share = sewing.closed_share();
    say("sewing", share, share > 0.05 ? watch.seconds() * (1 - share) / share : -1);
  }
  return frame;
}

// A garment that another one goes over comes to rest first; nothing of it is written.
bool Run::drape_inner(std::size_t k) {
  OutfitRun run(scene_, outfit_, body(), step_, settling_, stop());
  if (resumes()) {
    restore(run);
  } else {
    place_ = {RunPhase::inner_drape, k, 0};
    before_inner_ = outfit_.state.x;
    slow_inner_ = 0;
    keep(run);
  }
  const int frames = frames_in(scene_.drape_seconds);
  while (place_.frame + 1 < frames && slow_inner_ < inner_rest_s * scene_.fps) {
    const FrameReport frame = run.frame();
    if (frame.interrupted || !frame.ok) {
      const std::string when = "while " + printable(cloth_[k].garment.name) + " was draped";
      if (frame.interrupted) {
        cut_off(when);
      } else {
        collapse(when, frame, outfit_.mesh, outfit_.state.x);
        stopped_short_ = true;
      }
      return false;
    }
    ++place_.frame;
    const bool slow =
        run.settled() && speed_p99_mm_per_s(before_inner_, outfit_.state.x, scene_.fps) < inner_rest_mm_per_s;
    slow_inner_ = slow ? slow_inner_ + 1 : 0;
    before_inner_ = outfit_.state.x;
    keep_if_due(run);
    say("draping", static_cast<double>(place_.frame) / frames);
  }
  outfit_.state.v.assign(outfit_.state.v.size(), Vec3::Zero());
  return true;
}

}  // namespace toile::internal
