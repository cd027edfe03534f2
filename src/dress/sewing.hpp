// dress/sewing.hpp: from flat placed panels to one closed garment, with contact on.                docs/theory/sewing.md
//
//   seam pair   offset d between its two particles, wanted distance l(t) = |d(0)| (1 - t / T): all seams close together, the widest
//               at 0.5 m/s
//   pull        F = min( k (|d| - l)+, f_max ) along d,     f_max = 300 N per metre of seam,  k = f_max / 3 mm
//   in A        secant stiffness F / (|d| - l) along d, the geometric F / |d| across it, damping 0.02 s x the secant
//
// For stability gravity is off (with it on, folds get caught), cloth bends as stiffly as leather until the weld (or the tips of panels roll
// up and the corner of four panels never closes), and the body has no friction (or a hem caught on the hips holds the shoulders open).  The
// safe filter of the step never lets cloth pass through cloth.
//
// If a seam still gapes when l = 0, the layers of cloth around the gap are thinned; then f_max doubles, at most twice, and folds that are
// caught between the sides of a seam lose their contact; then the garment is blocked, by seam: the caller may remove the obstacles and go_on()
// (dress/dressing.hpp).  Cloth that is stretched by a fifth beside the gap is blocked at once.  The last millimetre is left to the
// weld, which waits while it would push guarded cloth through cloth.
#pragma once
#include "dress/label_springs.hpp"
#include "step/adaptive_step.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

struct SewingOptions {
  double closing_speed_m_per_s = 0.5;  // of the widest pair
  double pull_N_per_m = 300;
  double give_m = 3e-3;    // the pull reaches its limit at this gap beyond l
  double bend_N_m = 1e-3;  // bending rigidity until the weld, at least: a hundred times cotton's
  double gathered_bend_share =
      0.1;                 // of bend_N_m, in panels that are gathered: at 5:1 and 1 cm the whole of it leaves 6 mm open
  double drag_per_s = 20;  // keeps loose panels from whipping under the pull of their edges
  double damping_s = 0.02;
  double offset_m = 4e-3;  // contact distance from the body while sewing, at least
  double weld_gap_m = 1.5e-3;
  double weld_share =
      0.25;  // of the mean edge: a gap this small is welded where a seam stops closing (a fitted shoulder under tension)
  double patience_s = 0.2;       // without progress, before layers are thinned, and before each doubling of the pull
  double too_small = 0.2;        // stretch beside an open seam at which pulling harder is given up
  double taut = 0.05;            // likewise, above it the size is reported as the reason for the open seam
  double thickness_scale = 1.6;  // of the fabrics' contact distance, while sewing
  double thinnest = 0.2;         // the same, within `thin_radius_m` of a seam that will not close
  double thin_radius_m = 0.03;
  double largest_fold_m = 0.1;  // of a fold that may pass through where a seam has closed around it; 0: none
  double fps = 60;
  double step_max_s = 1.0 / 60;
  BendElement bend_element = BendElement::plate;  // assembly/cloth_model.hpp
  bool paper_scaling = false;
  DampingJacobian damping_jacobian = DampingJacobian::gauss_newton;
  Index held_particles = 0;                // these first particles stand still: the garments already worn underneath
  std::vector<LabelHeight> label_heights;  // of labelled edges; they are held once the seams are closed
  bool labels_hold_panels = false;         // from the start: else heavy panels would pull a waist down
  // Waist and neckline may sink no farther than 5 cm until every l is 0: else wide tiers would pull a bodice off the shoulders.
  bool keeps_bodice = false;
  std::function<bool()> stop;  // asked before every step
};

struct SeamGap {
  Index seam = 0;
  double gap_m = 0;  // largest of its pairs
  Vec3 where{0, 0, 0};
  double stretch = 0;  // of the cloth beside it: max |w| - 1
};

enum class SewingStatus { sewing, closed, blocked, failed };

class Sewing {
 public:
  // `body` may be null (panels sewn in the air).  The garment must outlive this object.
  Sewing(const GarmentMesh& garment, std::span<const Fabric> fabric_of_panel, BodySurface* body,
         const StepOptions& step, const SewingOptions& options);
  Sewing(const Sewing&) = delete;  // the stepper points at model and world, and the world's springs at this object
  Sewing& operator=(const Sewing&) = delete;

  // Advances by one frame of 1/fps; does nothing once it has ended.
  FrameReport frame();

  SewingStatus status() const { return status_; }
  double time_s() const { return time_s_; }
  double closed_share() const;  // 0 ... 1 of the way, for a progress bar
  const ClothState& state() const { return state_; }
  const ClothModel& model() const { return model_; }
  // Factor on the fabrics' contact distance, per particle; 0 switches the contact of layers off (cloth that crosses itself at the start).
  const std::vector<double>& thickness_scale() const { return thickness_scale_; }
  void set_thickness_scale(std::vector<double> scale);
  // Once blocked: goes on from x, at rest, with every layer at its first thickness except where `scale` is 0.
  void go_on(Vec3s x, std::vector<double> scale);
  // Seams by gap, widest first.
  std::vector<SeamGap> gaps() const;
  double widest_gap_m() const;
  // Indices into GarmentMesh::pairs of the pairs wider apart than `welded_m`, ascending.
  std::vector<Index> open_pairs(double welded_m) const;
  double mean_edge_m() const { return mean_edge_m_; }
  // Where the last attempt to weld would have pushed cloth through cloth.
  std::optional<Vec3> weld_obstacle() const { return weld_obstacle_; }
  const ImplicitEuler& integrator() const { return stepper_->integrator(); }
  PhaseSeconds seconds() const { return seconds_before_ + stepper_->integrator().seconds(); }

  // The state between frames (core/state_archive.hpp).
  template <class Archive>
  void remember(Archive& archive) {
    archive.fixed(state_.x);
    archive.fixed(state_.v);
    archive(pull_factor_, time_s_, best_gap_m_, best_time_s_, escalations_, weld_obstacle_, status_, seconds_before_,
            *stepper_);
    archive.fixed(thickness_scale_);
    if constexpr (Archive::reads) set_thickness_scale(thickness_scale_);
  }

 private:
  void start_stepper();
  void append_springs(const ClothState& state, double end_s, std::vector<LinearSpring>& springs) const;
  void pull_gathers();
  void judge_progress();
  std::vector<Impact> close_seams(Vec3s& end);
  void let_through(std::span<const Impact> caught);
  void thin_layers();

  const GarmentMesh* garment_;
  SewingOptions options_;
  ClothModel model_;
  StepWorld world_;
  StepOptions step_;
  ClothState state_;
  std::optional<AdaptiveStep> stepper_;
  PhaseSeconds seconds_before_;  // of the steppers before this one
  LabelSprings labels_, kept_;
  std::vector<double> start_distance_m_;  // [pair]
  double longest_m_ = 0, mean_edge_m_ = 0, pull_factor_ = 1, time_s_ = 0;
  double best_gap_m_ = 0, best_time_s_ = 0;
  int escalations_ = 0;
  std::vector<double> thickness_scale_;  // [particle]
  std::optional<Vec3> weld_obstacle_;
  SewingStatus status_ = SewingStatus::sewing;
};

// Position and velocity of the welded cloth: mass-weighted means over each class.
ClothState weld_state(const GarmentMesh& garment, const WeldedMesh& welded, const ClothModel& unwelded_model,
                      const ClothState& state);

// The layers that sewing thinned, on the welded cloth: scale per particle, at most 1.
std::vector<double> weld_thickness(const WeldedMesh& welded, const std::vector<double>& scale);
// Layers come back to their fabrics' thickness, a frame of the drape at a time.
void grow_thickness(std::vector<double>& scale);

}  // namespace toile::internal
