// step/bristle.hpp: dry friction of one contact, with cloth or a body: an elastic bristle that sticks, and slips at the Coulomb cone.
//
//   s     stretch of the bristle at the start of the step, in the tangent plane;  u the tangential motion in the step
//   d = s + u,   f(u) = -min(k_t |d|, mu lambda) d/|d|
//   stick   k_t |d| <= mu lambda:  f = -k_t d                           returns to its anchor at rest: no creep
//   slip    k_t |d| >  mu lambda:  f = -mu lambda (t + (t2 . d) / |d| t2)    linearised about the last d = |d| t
//           t2 across t in the tangent plane
//   after the step  s' = d, cut to mu lambda / k_t
//
// lambda and d are those of the previous pass; a new contact has no load yet, and no friction in its first pass.
//
// Easily got wrong: a secant mu lambda / |d| in all directions gives the right force only once |d| has settled.  It
// opposes acceleration by |d'| / |d|, and a sheet that should slide from rest creeps.
//
// The paper leaves friction between layers open [BW98 7.2]; bristles with memory: [Dahl 1976]
#pragma once
#include "assembly/implicit_row.hpp"

#include <vector>

namespace toile::internal {

class Bristle {
 public:
  // The contact continues with normal n and stiffness k_t > 0: its force stays, its direction follows the surface.
  void carry_on(const Vec3& n, double k_t_N_per_m);
  // Decides between stick and slip for a motion u under a load of `cone_N` = mu lambda.  Returns true if the contact
  // was turned back: friction stopped it within the step, and the force of slipping would drive it the other way.  It
  // then sticks; after the second time until the step ends (the first may be due to a contact that is dropped again).
  bool decide(const Vec3& u_m, double cone_N);
  // A contact that was constrained, under the force `friction_N` on the cloth, lets go: the bristle takes over what the cone allows.
  void take_over(const Vec3& friction_N, double cone_N);
  // Call after the step.
  void end(const Vec3& u_m, double cone_N);
  // Springs in the tangent plane of `contact`, whose direction is the normal.  `travel_m`: motion of the body's point
  // over the step.
  void append_springs(const LinearSpring& contact, const Vec3& travel_m, double damping_s,
                      std::vector<LinearSpring>& springs) const;

  bool begun() const { return stiffness_N_per_m_ > 0; }
  bool slips() const { return state_ == State::slips; }
  bool sticks() const { return state_ == State::sticks; }
  const Vec3& stretch_m() const { return stretch_m_; }

  template <class Archive>
  void remember(Archive& archive) {
    archive(state_, turned_back_, stretch_m_, stiffness_N_per_m_, along_, cone_N_, way_m_);
  }

 private:
  enum class State : std::uint8_t { free, sticks, slips };
  State state_ = State::free;
  int turned_back_ = 0;      // times, in this step
  Vec3 stretch_m_{0, 0, 0};  // s
  double stiffness_N_per_m_ = 0;
  Vec3 along_{0, 0, 0};            // t
  double cone_N_ = 0, way_m_ = 0;  // mu lambda, |d|
};

}  // namespace toile::internal
