// garment/sewing.hpp: from flat placed panels to one closed garment, with contact on.                docs/theory/sewing.md
//
//   seam pair   offset d between its two particles, wanted distance l(t), which shrinks from the start distance to 0 at 0.5 m/s
//   pull        F = min( k (|d| - l)+, f_max ) along d,     f_max = 300 N per metre of seam,  k = f_max / 3 mm
//   in A        secant stiffness F / (|d| - l) along d, the geometric F / |d| across it, damping 0.02 s x the secant
//
// Gravity is off while sewing (with it on, folds get caught).  If a seam still gapes when l = 0, the layers of cloth around the gap are
// thinned: where four panels meet, their thickness alone holds a corner open by a centimetre.  The last part of an edge is left to the weld;
// squeezing layers thinner than that pushes them through each other.  Then the body's friction goes to 0; then f_max doubles, at
// most twice; then the garment is reported as blocked, by seam.
#pragma once
#include "garment/garment_mesh.hpp"
#include "step/adaptive_step.hpp"

#include <optional>
#include <string>
#include <vector>

namespace toile {

struct SewingOptions {
  double closing_speed_m_per_s = 0.5;
  double pull_N_per_m = 300;
  double give_m = 3e-3;    // at this gap beyond l the pull is at its limit
  double drag_per_s = 20;  // keeps loose panels from whipping and folding under the pull of their edges
  double damping_s = 0.02;
  double friction = 0.3;   // of the body, at most
  double offset_m = 4e-3;  // contact distance from the body while sewing, at least
  double weld_gap_m = 1.5e-3;
  double thick_corner_share = 0.2;  // of the mean edge: once layers had to be thinned, the weld closes this gap
  double patience_s = 0.4;          // without progress, before friction goes, and before each doubling of the pull
  double thickness_scale = 1.6;     // of the fabrics' contact distance, while sewing
  double thinnest = 0.2;            // the same, within `thin_radius_m` of a seam that will not close
  double thin_radius_m = 0.03;
  double fps = 60;
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

  // Advances by one frame of 1/fps; does nothing once it has ended.
  FrameReport frame();

  SewingStatus status() const { return status_; }
  double time_s() const { return time_s_; }
  double closed_share() const;  // 0 ... 1 of the way, for a progress bar
  const ClothState& state() const { return state_; }
  const ClothModel& model() const { return model_; }
  const std::vector<double>& thickness_scale() const { return thickness_scale_; }
  // Seams by gap, widest first.
  std::vector<SeamGap> gaps() const;
  double widest_gap_m() const;
  const ImplicitEuler& integrator() const { return stepper_->integrator(); }
  PhaseSeconds seconds() const { return stepper_->integrator().seconds(); }

 private:
  void append_springs(const ClothState& state, double h_s, std::vector<LinearSpring>& springs) const;
  void judge_progress();
  void thin_layers();

  const GarmentMesh* garment_;
  SewingOptions options_;
  ClothModel model_;
  StepWorld world_;
  ClothState state_;
  std::optional<AdaptiveStep> stepper_;
  std::vector<double> start_distance_m_;  // [pair]
  double longest_m_ = 0, mean_edge_m_ = 0, pull_factor_ = 1, time_s_ = 0;
  double best_gap_m_ = 0, best_time_s_ = 0;
  int escalations_ = 0;
  std::vector<double> thickness_scale_;  // [particle]
  SewingStatus status_ = SewingStatus::sewing;
};

// Position and velocity of the welded cloth: mass-weighted means over each class.
ClothState weld_state(const GarmentMesh& garment, const WeldedMesh& welded, const ClothModel& unwelded_model,
                      const ClothState& state);

// The layers that sewing thinned, on the welded cloth: scale per particle, at most 1.
std::vector<double> weld_thickness(const WeldedMesh& welded, const std::vector<double>& scale);
// A fold that is caught in a closed corner is held there for good by the contact of its own layers: within `radius_m` of the given points
// contact is switched off (0), so that bending opens the fold.
void switch_off_near(std::span<const Vec3> points, double radius_m, const Vec3s& x, std::vector<double>& scale);
// Layers come back to their fabrics' thickness, a frame of the drape at a time.
void grow_thickness(std::vector<double>& scale);

}  // namespace toile
