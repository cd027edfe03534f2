// step/body_constraints.hpp: cloth particles on a body: held, sliding or free, decided by constraint forces.   (L1) [BW98 5.4, 6]
//
//   touching   a particle that touched in the last step, or whose gap, predicted with the last change of velocity and the body's
//              motion, is below the offset r; the passes release and add the rest.  (Predicting with v + h g instead, as if nothing
//              held the cloth up, starts a step at rest with hundreds of contacts too many: h^2 g is 11 mm at 30 Hz.)
//   slides     S = I - n n^T,  z = n.(v_body - v) n,  plus friction as an implicit drag along the surface,
//              coefficient mu lambda_n / max(|v_t|, v_0): Coulomb's force above v_0 = 1 mm/s, and below it the part |v_t| / v_0 of
//              it, so that friction stops a particle and never turns it round
//   sticks     S = 0,          z = v_body - v                    while |lambda_t| <= mu_s lambda_n
//              entered from a slide that ended slower than v_0: friction then needed less than its cone.  What broke loose slides on
//              for 0.1 s before, at up to v_0, hence 0.1 mm: cloth that creeps down a slope would stick and break loose in every step,
//              one particle after the other, a solve for each few
//   n          the contact's normal in the middle of the step.  With that of its start a round body that turns by theta under cloth that
//              stays would draw the cloth in by R theta^2/2, with that of its end push it out by as much; midway neither.
//   y          position alteration: min(r - gap, 0.2 r min(1, h / 1 ms)) n, zero while 0 <= r - gap < 0.02 r; negative lets a predicted contact land exactly
//              on the offset.  It moves the particle and tells its neighbours through K y, and is never part of v.  Negative, it is the
//              rest of the particle's own way, at y / h, and damping sees it: D y / h.  Else a particle that lands 10 mm below would be
//              braked by neighbours that fall beside it, as if it had stood still, and threads between them stretched by as much as 20 %.
//   release    lambda_n < 0: the body would have to pull.  Within the same step (the paper: in the next), once per particle and step.
//   crease     the face that a particle touched before, and still lies over, while another one is the nearest now: it may touch both, and has
//              one degree of freedom left, S = I - p p^T - q q^T.  Held by the nearest alone it would slide on it beneath the offset of the
//              other, be pushed out of there, and slide again, for ever.  Between faces that look at each other it is moved to the middle.
//
// lambda = e / h is read from the residual e = A dv - b of the solve: in a crease, of both faces.
#pragma once
#include "assembly/cloth_model.hpp"
#include "assembly/implicit_row.hpp"
#include "constraint/particle_constraints.hpp"
#include "contact/proximity.hpp"
#include "step/collider_contact.hpp"
#include "step/step_formula.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace toile::internal {

enum class Touch : std::uint8_t { none, slides, sticks };

class BodyConstraints {
 public:
  BodyConstraints(const ClothModel& model, const BodySurface* body, const BodyContactOptions& options);

  // L0: nearest body point of every particle that comes to the body within h_s with its velocity and free fall.  Cloth that is
  // under tension and is let go moves farther than that: `update` looks again for those.
  void detect(const ClothState& state, double h_s);

  // The active set with which a step begins; `dv` is the guess of the coming change of velocity.  The body's travel is read
  // here: it may have been told of a shorter step since detect.
  void begin(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step);
  // Adds S, z and y of the touching particles, and appends the drag of those that slide.  Particles that `constraints` already holds
  // are left to what holds them.  `landing`, m: of y the part that is the rest of a way to the body.  y and it are zero before.
  void apply(const ClothState& state, const StepFormula& step, ParticleConstraints& constraints, std::span<Vec3> y,
             std::span<Vec3> landing, std::vector<LinearSpring>& springs);
  // After a solve: releases, adds (also what detect thought too far), and lets slip.  `first_passes`: releases are allowed.
  struct Change {
    int released = 0, added = 0, deep = 0;  // deep: added that would end below half the offset
    int slipped = 0, touching = 0;          // from stick to slip; in touch now
  };
  Change update(const ClothState& state, std::span<const Vec3> dv, std::span<const Vec3> e, const StepFormula& step,
                bool first_passes);
  // Whether particles touch that did not at the end of the last accepted step, or the other way round.
  bool changed() const;
  // After an accepted step of h_s: remembers forces and modes for the next.
  void accept(double h_s);

  // Of the last detect: the particle is within the body.
  bool inside(Index particle) const {
    const BodyPoint& point = points_[static_cast<std::size_t>(particle)];
    return point.triangle >= 0 && point.gap_m < 0;
  }
  // Farther within the body than a particle can be lifted out of it: others must see to it (step/swallowed.hpp).
  bool too_deep(const BodyPoint& point) const;
  std::span<const BodyPoint> points() const { return points_; }  // [particle] of the last detect; empty without a body
  bool any_near() const { return !near_.empty(); }
  int touching() const;
  Touch touch(Index particle) const { return touch_[static_cast<std::size_t>(particle)]; }
  double normal_force_N(Index particle) const { return lambda_n_[static_cast<std::size_t>(particle)]; }
  // Of the colliders' friction, from the next step on: 0 lets cloth slip into its place.
  void set_friction_share(double share) { friction_share_ = share; }
  void set_friction(std::optional<Index> collider, double friction) { options_.set_friction(collider, friction); }
  double offset_m(const BodyPoint& point) const { return options_.offset_of(body_->collider(point.triangle)); }

  // Between two steps (core/state_archive.hpp); what set_friction and set_friction_share say is the caller's.
  template <class Archive>
  void remember(Archive& archive) {
    archive(memory_);
    archive.fixed(touch_);
    archive.fixed(lambda_n_);
    archive.fixed(loose_s_);
  }

 private:
  struct Contact {
    BodyPoint point;
    Vec3 body_travel;  // of its material point over the step, m
    Vec3 normal;       // in the middle of the step
    bool released = false;
    double lambda_n = 0;  // N
    void follow(const BodySurface& body);
  };
  struct Beside {  // the other face of a crease
    Contact contact;
    bool slit;  // faces that look at each other: the particle is in the middle, and held along one normal
    bool touched, touches = false;  // in the last step; in this one, then the near one does as well
  };
  struct Near {  // a particle within reach of the body
    Index particle;
    Contact contact;
    Touch touch = Touch::none;
    bool slipped = false, pinned = false;
    double slip_m_per_s = 0;     // |v_t| relative to the body
    std::ptrdiff_t beside = -1;  // of beside_; -1: no crease
  };
  struct Memory {  // of a particle that touched in the last accepted step
    Index particle;
    int faces;
    std::array<Vec3, 2> normal;
    double lambda_beside_N;
    template <class Archive>
    void remember(Archive& archive) {
      archive(particle, faces, normal, lambda_beside_N);
    }
  };
  // How far off a body may be at the start of a step, and meet what goes this far from x.
  double reach(const Vec3& x, double way_m) const;
  void find_creases(const ClothState& state);
  // At the end of the step, with the velocity v.
  double predicted_gap_m(const Contact& contact, Index particle, const Vec3& v, const StepFormula& step) const;
  bool touches(Near& near, const Vec3& v, const StepFormula& step, Change& change);
  bool is_let_go(Near& near, const Vec3& force_N, bool may_leave);
  Beside* beside(const Near& near) {
    return near.beside < 0 ? nullptr : &beside_[static_cast<std::size_t>(near.beside)];
  }
  Beside* touching_beside(const Near& near) {
    Beside* other = beside(near);
    return other && other->touches ? other : nullptr;
  }
  // The second face that holds it.
  const Contact* other_face(const Near& near) {
    const Beside* other = touching_beside(near);
    return other && !other->slit ? &other->contact : nullptr;
  }
  void find_what_came_far(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step);
  void touch_down(Near& near, const Vec3& v, double h_s) const;
  double offset_m(const Contact& contact) const { return offset_m(contact.point); }
  double friction(const Contact& contact, Index particle) const;
  double cone_N(const Near& near);
  double alteration(const Contact& contact, double to_m) const;
  Vec3 alteration(const Near& near);

  const ClothModel* model_;
  const BodySurface* body_;
  BodyContactOptions options_;
  double largest_offset_m_, friction_share_ = 1;
  std::vector<BodyPoint> points_;  // [particle] nearest point of the body; triangle -1: farther than reach_m_
  std::vector<double> reach_m_;    // [particle] how far was looked
  double altered_share_ = 1;       // of the largest alteration, in the step of apply
  bool body_moves_ = false;        // in the step that detect was told of
  std::vector<Near> near_;         // ascending particles, then those that `update` found
  std::vector<Beside> beside_;
  std::vector<Memory> memory_;    // ascending particles
  std::vector<Touch> touch_;      // [particle] at the end of the last accepted step
  std::vector<double> lambda_n_;  // [particle] N, likewise
  std::vector<double> loose_s_;   // [particle] for how long it slides on, however slowly
};

}  // namespace toile::internal
