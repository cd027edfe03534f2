// step/step_formula.hpp: the end of a step from its velocity: backward Euler, or BDF2 with varying steps.
//
//   x' = x + drift + H v' + y            M (v' - v - kick) = H f(x', v')
//
//   backward Euler   H = h,                   drift = kick = 0                                             [BW98 3]
//   BDF2             H = h (1 + w)/(1 + 2w),  drift = beta (x - x_prev),  kick = beta (v - v_prev),
//                    beta = w^2/(1 + 2w),     w = h/h_prev <= 2.4                           [Choi & Ko 2002, for w = 1]
//
// Contacts, rows and constraints are linear in the new velocity and use H where backward Euler has h; h itself only
// divides the travel of a body.  The matrix is the same with H for h.
//
// Easily got wrong: x_prev must not contain a position alteration.  y is no motion, and would be extrapolated.
#pragma once
#include "assembly/cloth_model.hpp"

#include <span>

namespace toile::internal {

enum class Integrator { backward_euler, bdf2 };

struct StepFormula {
  StepFormula(double step_s) : h_s(step_s), weight_s(step_s) {}  // NOLINT(google-explicit-constructor): backward Euler
  StepFormula(double step_s, double H_s, std::span<const Vec3> drift) : h_s(step_s), weight_s(H_s), drift_m(drift) {}
  Vec3 drift(Index particle) const {
    return drift_m.empty() ? Vec3(0, 0, 0) : drift_m[static_cast<std::size_t>(particle)];
  }
  double h_s, weight_s;           // h, H
  std::span<const Vec3> drift_m;  // [particle]; empty: zero
};

// The last accepted step, for BDF2.
class MotionHistory {
 public:
  // The last step or this one is not smooth (contacts began or ended, the safe filter moved a particle): use backward
  // Euler.
  void forget() { h_s_ = 0; }
  // `moved` is x' - x - y.
  void remember(const ClothState& start, const ClothState& end, std::span<const Vec3> moved, double h_s);
  // Forgets if the state is not the end of the last step: it has been set from outside.
  void check(const ClothState& state);

  // The formula for a step of h_s; its drift and kick live until the next call.  Backward Euler without a history, or
  // beyond w = 2.4.
  StepFormula formula(double h_s);
  std::span<const Vec3> kick() const { return kick_; }  // empty: zero

  // State between two steps (core/state_archive.hpp).
  template <class Archive>
  void remember(Archive& archive) {
    archive(h_s_, moved_, dv_, end_);
  }

 private:
  double h_s_ = 0;  // of the last step; 0: none
  Vec3s moved_, dv_, drift_, kick_;
  ClothState end_;
};

}  // namespace toile::internal
