// step/implicit_euler.hpp: one linearised backward Euler step with contact.                              [BW98 3, 5, 6]
//
//   A  = M + h D + h^2 K                      K, D positive semidefinite by construction (material/)
//   b  = h (f - K (h v + y) - D y_l / h)      f: elastic, damping and external forces at (x, v);  y_l: the part of y
//                                             that is the rest of a fall
//   A dv = b  under S, z                      v <- v + dv,   x <- x + h (v + dv) + y
//
//   data flow   state -> elements -> A, f          (once per state: a halved step evaluates no element again)
//                     -> near pairs                 (once per state)
//                     -> [ constraints, rows -> b -> modified PCG -> dv, e -> active set ] until consistent;
//                        relinearised about the end found so far while a thread stretches too much there
//                     -> candidate -> safe filter
#pragma once
#include "assembly/elements.hpp"
#include "assembly/force.hpp"
#include "solver/step_solver.hpp"
#include "step/body_at.hpp"
#include "step/body_attachment.hpp"
#include "step/body_constraints.hpp"
#include "step/contact_rows.hpp"
#include "step/drag.hpp"
#include "step/flypaper.hpp"
#include "step/penetration_recovery.hpp"
#include "step/step_report.hpp"
#include "step/stretch_changes.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace toile::internal {

// A particle that the user constrains.
struct Pin {
  Index particle = -1;
  int constrained_directions = 3;         // 3: fixed; 2: along p and q (moves on a line); 1: along p (moves in a plane)
  Vec3 p{1, 0, 0}, q{0, 1, 0};            // unit, orthogonal
  std::function<Vec3(double t_s)> path;   // its position; empty: it stays where it is along the constrained directions
  std::optional<BodyAttachment> on_body;  // instead: the world's body carries it
};

// Position alteration within the solve (K y in b), or as a jump after it; the latter for comparison.
enum class PositionAlteration { in_solve, after_solve };

struct StepOptions {
  PcgOptions pcg;
  ContactRowOptions rows;
  BodyContactOptions body;
  PositionAlteration position_alteration = PositionAlteration::in_solve;
  Integrator integrator = Integrator::backward_euler;
  int newton_iterations = 1;  // linear solves per step, each about the end of the last; the paper: 1
  // More solves about the end of the last one while a thread changes by more than the limit, and one if the end has too
  // much energy beyond the linearisation; the paper: none.
  int relinearisations = 6;
  // As a share of the speed of one step's free fall: slower turns are not solved again for their energy beyond
  // the linearisation, which brakes it.
  double slow_motion = 1;
  int max_passes = 8;      // of the active set, per linear solve
  bool guard_body = true;  // the safe filter also keeps cloth out of the body
  bool flypaper = true;    // pinched cloth moves with the body (step/flypaper.hpp)
};

// Limits beyond which a candidate is refused.
struct StepLimits {
  double stretch = 0.05;  // largest change of |w_u| or |w_v| away from rest; compression counts as sqrt(c) of it
  bool truncate = false;  // clip the motion where cloth would pass through cloth, instead of refusing the step
  // Let cloth into the body where the filter cannot keep it out, instead of refusing the step: pinched cloth only, or
  // all.
  enum class Pierce { nothing, pinched, all } pierce = Pierce::nothing;
};

// Everything that acts on the cloth besides its own elements.
struct StepWorld {
  BodySurface* body = nullptr;
  // The positions of the body's vertices at time t, m; empty: the body moves by its owner (BodySurface::set_motion).
  // Every step, however short, evaluates its own two ends, so that cloth follows the body's velocity over just that
  // step.
  BodyAt body_at;
  std::vector<Pin> pins;  // both may change between steps: a released particle is free from the next step on
  std::vector<Drag> drags;
  // Appends extra springs (sewing, attachments) at a state, for a step of h_s that ends at end_s.
  std::function<void(const ClothState&, double end_s, double h_s, std::vector<LinearSpring>&)> springs;
  std::vector<std::unique_ptr<Force>> forces;  // in the order in which they are added; the same from the first step on
  std::vector<Index> merged_particle;          // open seams: contact/proximity.hpp
};

class ImplicitEuler {
 public:
  // Model and world must outlive this object.
  ImplicitEuler(const ClothModel& model, const StepWorld& world, const StepOptions& options);
  ImplicitEuler(const ImplicitEuler&) = delete;  // its members point at each other
  ImplicitEuler& operator=(const ImplicitEuler&) = delete;

  // Evaluates elements and near pairs at the state (at time t_s).  `h_s` is the longest step to be tried from it,
  // `base_h_s` >= h_s the step before any halving.
  void prepare(const ClothState& state, double t_s, double h_s, double base_h_s);
  // Tries a step of h_s from the prepared state (at time t_s) and writes the candidate; the state is not touched.
  [[nodiscard]] StepReport attempt(const ClothState& state, double t_s, double h_s, const StepLimits& limits,
                                   ClothState& candidate);
  // Accepts the candidate of the last attempt, over h_s: contacts and forces are stored for the next step.
  void accept(const ClothState& candidate, double h_s);

  const Elements& elements() const { return elements_; }
  const BodyConstraints& body_constraints() const { return body_; }
  BodyConstraints& body_constraints() { return body_; }
  const Flypaper& flypaper() const { return flypaper_; }
  ContactRows& contact_rows() { return rows_; }
  const ContactRows& contact_rows() const { return rows_; }
  // e = A dv - b of the last pass, of constrained particles, N s; H times the constraint force.
  std::span<const Vec3> constraint_impulse() const { return e_; }
  const SafeFilter& filter() const { return filter_; }  // of the last attempt
  PhaseSeconds seconds() const;
  const StepOptions& options() const { return options_; }
  // For one collider, or for all without a value of their own, from the next step on.
  void set_body_friction(std::optional<Index> collider, double friction) {
    body_.set_friction(collider, friction);
    rows_.set_body_friction(collider, friction);
  }
  // Call when the time of the next step has jumped and the owner has moved the body.
  void restart_clock() {
    body_start_.clear();
    body_end_.clear();
  }
  void set_slow_motion(double share) { options_.slow_motion = share; }
  void set_tolerance(double tolerance) { options_.pcg.tolerance = tolerance; }
  const ClothModel& model() const { return *model_; }

  // State that outlives a step (core/state_archive.hpp); options, model and world are the caller's.
  template <class Archive>
  void remember(Archive& archive) {
    archive(body_, flypaper_, rows_, history_, elements_, h_last_s_, may_be_through_, pierced_, seconds_);
    archive.fixed(dv_last_);
  }

 private:
  void move_body(double t_s, double h_s);
  void hold_pins(const ClothState& state, double t_s, const StepFormula& step);
  void evaluate_forces(const ClothState& at, double end_s);
  void assemble(const ClothState& at, double t_s, const StepFormula& step);
  void relinearise(const ClothState& state, double t_s, const StepFormula& step, const ClothState& candidate);
  bool solve_with_contacts(const ClothState& state, double t_s, const StepFormula& step, int iteration,
                           const StepLimits& limits, ClothState& candidate, StepReport& report);
  std::span<const Vec3> landing_velocity(double H);
  bool makes_energy(const ClothState& candidate, double h_s);
  void shorten(const ClothState& state, const StepFormula& step, ClothState& candidate);
  void find_end(const ClothState& state, const StepFormula& step, ClothState& candidate);
  void judge(const StepLimits& limits, const ClothState& candidate, StepReport& report);
  void judge_finite(const ClothState& candidate, StepReport& report) const;
  void judge_strain(const StretchChange& largest, StepReport& report) const;
  void look_through_body(const ClothState& state);
  bool may_pierce(StepLimits::Pierce pierce) const;
  void keep_apart(const ClothState& state, double h_s, const StepLimits& limits, ClothState& candidate,
                  StepReport& report);

  const ClothModel* model_;
  const StepWorld* world_;
  StepOptions options_;
  Elements elements_;
  StretchChanges stretch_;
  std::vector<char> force_is_prepared_;  // [force of the world]
  std::vector<Force*> acting_;           // in the step at hand, evaluated
  StepSolver solver_;
  ParticleConstraints constraints_;
  BodyConstraints body_;
  Flypaper flypaper_;
  PenetrationRecovery penetration_recovery_;
  ContactRows rows_;
  SafeFilter filter_;
  std::vector<double> inverse_mass_, before_body_;  // [particle] 1/kg: 0 for constrained particles; 0 for pins alone
  std::vector<char> through_body_;                  // [particle] within the body, or next to a crossing with it
  bool may_be_through_ = true, pierced_ = false;    // pierced_: by the last attempt
  BodyImpactWorkspace body_workspace_;
  std::vector<LinearSpring> springs_;
  std::vector<ImplicitRow> implicit_rows_;
  Vec3s force_, b_, y_, y_known_, y_linearised_, linearised_, displacement_, force_linearised_, x_linearised_, moved_,
      reference_, dv_, dv_last_, dv_linearised_, way_, e_;
  Vec3s landing_, landing_v_;                 // y_l, m, and y_l / h
  Vec3s body_start_, body_end_;               // world_->body_at at the two ends of the step
  double body_start_s_ = 0, body_end_s_ = 0;  // the times of the two
  MotionHistory history_;
  bool evaluated_at_state_ = false, linearised_is_old_ = true;
  double base_h_s_ = 0, h_last_s_ = 0;
  PhaseSeconds seconds_;
};

}  // namespace toile::internal
