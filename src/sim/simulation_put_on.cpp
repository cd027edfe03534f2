// sim/simulation_put_on.cpp: from flat panels to a garment that is on, from the innermost outwards.
#include "core/error.hpp"
#include "garment/refine.hpp"
#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toile::internal {
namespace {

constexpr double sewing_film_fps = 30;

}  // namespace

// Puts on cloth that is not sewn, or that another run has draped.
void Simulation::hang_as_drawn() {
  outfit_ = start_ ? std::move(*start_) : outfit_of_shapes(cloth_);
  start_.reset();
}

bool Simulation::put_on() {
  if (resumes() && place_.phase >= RunPhase::drape) return true;
  if (start_ || !sewn()) {
    hang_as_drawn();
    return free_start(false);
  }
  for (std::size_t k = place_.cloth; k < cloth_.size(); ++k) {
    const bool is_sewn = resumes() && place_.phase != RunPhase::sewing;
    const bool is_on = is_sewn && place_.phase != RunPhase::growth;
    if (k == 0 && !is_on) find_person();
    if (!is_sewn && !sew(k)) return false;
    if (k == 0 && !is_on && !stopped_short_ && !grow(k)) return false;
    stopped_short_ = stopped_short_ || (k < open_pairs_.size() && !open_pairs_[k].empty());
    const bool is_inner = k + 1 < cloth_.size();
    if (!stopped_short_ && (is_inner || falls_coarse(k)) && !drape_first(k) && !stopped_short_) return false;
    cut_finer(k);
    if (stopped_short_) return true;
  }
  return true;
}

// Restores the garments that were on when it was left, without their positions.
void Simulation::wear_again() {
  if (start_ || !sewn()) {
    hang_as_drawn();
    outfit_.thickness_scale.assign(outfit_.state.x.size(), 1);
    return;
  }
  const std::size_t worn = static_cast<std::size_t>(place_.cloth) + (place_.phase == RunPhase::sewing ? 0 : 1);
  for (std::size_t j = 0; j < worn; ++j) {
    if (j < open_pairs_.size()) cloth_[j].garment.leave_open(open_pairs_[j]);
    if (j < place_.cloth || place_.phase >= RunPhase::drape) cloth_[j].garment = as_worn(cloth_[j]);
    wear_next(outfit_, j);
  }
}

// The outfit with the next garment on, without positions.
void Simulation::wear_next(Outfit& outfit, std::size_t k) {
  std::vector<std::string> told_before;
  const LoadedCloth& cloth = cloth_[k];
  const Index before = outfit.mesh.particle_count;
  new_garment_ = {before, wear(outfit, cloth.garment, cloth.fabrics, cloth.rest_stretch, heights_of(k, told_before))};
}

// Where it is, to the edges that are asked for.
void Simulation::cut_finer(std::size_t k) {
  LoadedCloth& cloth = cloth_[k];
  if (!is_cut_finer(cloth)) return;
  Outfit fine;
  for (std::size_t j = 0; j < k; ++j) wear_next(fine, j);
  const Outfit before = fine;
  RefinedGarment refined = refine(cloth.garment, cloth.edge_m);
  std::swap(cloth.garment, refined.garment);
  wear_next(fine, k);
  carry_over(outfit_, refined.garment, before, cloth.garment, refined.ends, fine);
  outfit_ = std::move(fine);
  run_.reset();
}

// Afterwards the outfit is welded, with the garment on.
bool Simulation::sew(std::size_t k) {
  const bool resumed = resumes();
  if (!resumed) place_ = {RunPhase::sewing, k, 0};
  run_.reset();  // the outfit's mesh changes
  LoadedCloth& cloth = cloth_[k];
  GarmentMesh& garment = cloth.garment;
  place(k, !resumed);
  if (!resumed) tell_misfits(k);
  SewingOptions sewing_options;
  sewing_options.step_max_s = scene_.step_max_s.value_or(1 / sewing_options.fps);
  sewing_options.bend_element = scene_.bend_element;
  sewing_options.paper_scaling = scene_.paper_scaling;
  sewing_options.damping_jacobian = scene_.damping_jacobian;
  std::vector<std::string> told_before;
  sewing_options.label_heights = heights_of(k, resumed ? told_before : report_.warnings);
  sewing_options.labels_hold_panels = k == 0 && dressing_body_ && !on_shoulders_;
  sewing_options.keeps_bodice = k == 0 && on_shoulders_;
  sewing_options.stop = stop();
  Dressing dressing(outfit_, garment, cloth.fabrics, cloth.rest_stretch, body(), step_, sewing_options);
  Sewing& sewing = dressing.sewing();
  if (sewing_options.labels_hold_panels && !dressing.labels().empty()) {
    pose_.falls_s = DressingBody::falling_s;
    dressing_body_->set_pose(pose_);
  }
  const bool filmed = k == 0;  // later panels are sewn beside worn garments: another mesh
  if (resumed) {
    restore(dressing);
  } else {
    if (dressing.tangled()) bad_start(garment.name, "placed panels pass through each other");
    if (filmed) {
      const std::span thin = std::span<const Triangle>(body_triangles_).first(dressing_body_ ? person_triangles_ : 0);
      observer_->sewing_begins(garment.mesh, garment.name, garment.x, thin, std::span(body_x_).first(person_vertices_));
    }
    end_startup();
    between_frames(dressing, true);
  }
  const FrameReport frame = sew_frames(dressing, filmed);
  PhaseReport& phase = report_.sewing;
  phase.simulated_s += sewing.time_s();
  add_seconds(phase, sewing.seconds());
  const std::string which = cloth_.size() > 1 ? printable(garment.name) + ": " : "";
  // When stopped it is not known to be blocked: the obstacle may still clear.
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
  new_garment_ = {outfit_.mesh.particle_count, dressing.labels()};
  outfit_ = dressing.worn();
  return stopped_short_ || free_start(true);
}

// Until the seams are closed or blocked; returns the report of the last frame.
FrameReport Simulation::sew_frames(Dressing& dressing, bool filmed) {
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
      observer_->sewing_frame(sewing.state().x);
    if (sewing.status() == SewingStatus::blocked) {
      say("untangling", 0);
      const std::string why = dressing.explain();
      if (dressing.take_apart(body_triangles_, body_x_, [&] { return stopped(); }))
        report_.warnings.push_back("while sewing: " + why +
                                   "; what was in the way was taken apart, and sewing went on");
    }
    if (sewing.status() == SewingStatus::sewing) between_frames(dressing);
    const double share = sewing.closed_share();
    say("sewing", share, share > 0.05 ? watch.seconds() * (1 - share) / share : -1);
  }
  return frame;
}

// Blocked seams stay open: the garment is welded where it can be, and written as it is then.  With weight, loose panels would fall out of
// the picture.
void Simulation::leave_open(std::size_t k, Dressing& dressing) {
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

// Its frames are not written.
bool Simulation::grow(std::size_t k) {
  if (!dressing_body_) return true;
  const PhasePlan plan = growth_plan();
  enter(plan, k, [&](double t_s, std::span<Vec3> x) { dressing_body_->at(t_s, x); });
  if (!go_through(plan) && !stopped_short_) return false;
  outfit_.state.v.assign(outfit_.state.v.size(), Vec3::Zero());
  body_x_ = standing_x_;
  if (stopped_short_) body_x_.assign(body_->next_positions().begin(), body_->next_positions().end());
  stand();
  dressing_body_.reset();
  return true;
}

// The last garment falls with the edges that it was sewn with where only the end is asked for and time does not matter: the folds of finer
// cloth settle from there.
bool Simulation::falls_coarse(std::size_t k) {
  return is_cut_finer(cloth_[k]) && awaits_rest() && drape_plan().frames > 0 &&
         events_of(scene_, outfit_, cloth_).empty() &&
         std::all_of(scene_.cloth.begin(), scene_.cloth.end(),
                     [](const SceneCloth& cloth) { return cloth.pins.empty(); });
}

// Its frames are not written, either.
bool Simulation::drape_first(std::size_t k) {
  const PhasePlan plan = first_drape_plan(k);
  enter(plan, k);
  if (!go_through(plan)) return false;
  outfit_.state.v.assign(outfit_.state.v.size(), Vec3::Zero());
  fallen_ = k + 1 == cloth_.size();
  return true;
}

}  // namespace toile::internal
