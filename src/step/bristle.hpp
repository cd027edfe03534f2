// step/bristle.hpp: dry friction of one contact: an elastic bristle that sticks, and slips at the cone.
//
//   s     stretch of the bristle at the start of the step, along the surface;  u the way of the step, along the surface
//   d = s + u,   f(u) = -min(k_t |d|, mu lambda) d/|d|
//   stick   k_t |d| <= mu lambda:  f = -k_t d                           what is at rest returns to where it took hold: no creep
//   slip    k_t |d| >  mu lambda:  f = -mu lambda (t + (t2 . d) / |d| t2)    linearised about the last d = |d| t;  t2 across it
//   after the step  s' = d, cut to mu lambda / k_t
//
// lambda and d are those of the pass before; a contact that has no load yet has no friction in its first pass.
// Easily got wrong: a secant mu lambda / |d| in all directions has the right force only once |d| has settled, and holds back what
// speeds up, by |d'| / |d|: a sheet that should slide from rest creeps.
//                                        The paper leaves friction between layers open [BW98 7.2]; bristles with memory: [Dahl 1976]
#pragma once
#include "assembly/implicit_row.hpp"

#include <vector>

namespace toile::internal {

class Bristle {
 public:
  // A contact that goes on, now with normal n and k_t > 0: its force stays, its direction follows the surface.
  void carry_on(const Vec3& n, double k_t_N_per_m);
  // Whether it sticks or slips at a way of u under a load of `cone_N` = mu lambda.  True when it was turned back: friction stopped what
  // slipped within the step, and the force of slipping would drive it the other way.  It sticks then; after the second time until the
  // step ends (the first may be the work of a contact that is dropped again).
  bool decide(const Vec3& u_m, double cone_N);
  // After the step.
  void end(const Vec3& u_m, double cone_N);
  // Springs along the surface at `contact`, whose direction is the normal.  `travel_m`: of a body's point over the step.
  void append_springs(const LinearSpring& contact, const Vec3& travel_m, double damping_s,
                      std::vector<LinearSpring>& springs) const;

  bool begun() const { return stiffness_N_per_m_ > 0; }
  bool slips() const { return state_ == State::slips; }
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
