// step/step_formula.hpp: how the end of a step follows from its velocity: backward Euler, or BDF2 with varying steps.
//
//   x' = x + drift + H v' + y            M (v' - v - kick) = H f(x', v')
//
//   backward Euler   H = h,                   drift = kick = 0                                             [BW98 3]
//   BDF2             H = h (1 + w)/(1 + 2w),  drift = beta (x - x_prev),  kick = beta (v - v_prev),
//                    beta = w^2/(1 + 2w),     w = h/h_prev <= 2.4                                 [Choi & Ko 2002, for w = 1]
//
// Everything that is linear in the new velocity, contacts, rows and constraints, uses H where backward Euler has h, and h only
// where it divides what a body moves.  The matrix is the same with H for h.
//
// Easily got wrong: x_prev must not know of a position alteration.  What y moved is no motion, and would be extrapolated.
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

// What BDF2 remembers of the last accepted step.
class MotionHistory {
 public:
  // The last step, or the one at hand, is no smooth motion (contacts came or went, the safe filter moved something): backward Euler.
  void forget() { h_s_ = 0; }
  // `moved` is x' - x - y.
  void remember(const ClothState& start, const ClothState& end, std::span<const Vec3> moved, double h_s);
  // Forgets when the state is not the one that the last step ended with: somebody has set it anew.
  void check(const ClothState& state);

  // Of a step of h_s: drift and kick live here until the next call.  Backward Euler without a history, or beyond w = 2.4.
  StepFormula formula(double h_s);
  std::span<const Vec3> kick() const { return kick_; }  // empty: zero

  // Between two steps (core/state_archive.hpp).
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
