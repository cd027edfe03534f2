// step/body_constraints.hpp: contact of particles with a body, by constraints and an active set.     (L1) [BW98 5.4, 6]
//
//   predicted  a particle starts the step in contact if it touched in the last step, or if its gap, predicted with the
//              last change of velocity and the body's motion, is below the rest offset r; the passes release and add
//              the rest.  (Predicting with v + h g would ignore the support and start a step at rest with hundreds of
//              contacts too many: h^2 g is 11 mm at 30 Hz.)
//   slides     S = I - n n^T,  z = n.(v_body - v) n,  with dry friction along the surface by a bristle (step/bristle.hpp),
//              k_t = 1e4 m / h^2
//   sticks     S = 0,          z = v_body - v                    while |lambda_t| <= mu_s lambda_n
//              entered when the bristle holds.  A particle that breaks loose hands lambda_t to its bristle, and so goes on
//              bearing what the cone allows: cloth whose particles are all near their cones does not creep.
//   mu_s       1.02 mu, for a particle that did not slide in the last step, faster than 1 mm/s
//   n          the contact's normal in the middle of the step.  With the normal of its start a round body that turns by
//              theta under resting cloth would draw the cloth in by R theta^2/2, with that of its end push it out as
//              much.
//   y          position alteration: min(r - gap, 0.2 r min(1, h / 1 ms)) n, zero while 0 <= r - gap < 0.02 r; a
//              negative y lets a predicted contact land exactly on the offset.  y moves the particle and reaches its
//              neighbours through K y; it is never part of v.  A negative y is the rest of the particle's own fall, at
//              y / h, and damping sees it: D y / h.  Otherwise neighbours that fall beside a particle landing 10 mm
//              below would brake it as if it stood still, and stretch the threads between by as much as 20 %.
//   release    lambda_n < 0: the body would have to pull.  Within the step (the paper: in the next), once per particle.
//   crease     a particle may touch two faces: the nearest, and the one it touched before and still lies over.  It
//              keeps one degree of freedom, S = I - p p^T - q q^T.  With the nearest face alone it would slide below
//              the offset of the other, be pushed out, and slide back, for ever.  Between faces that look at each other
//              it goes to the middle.
//
// lambda = e / h follows from the residual e = A dv - b of the solve; in a crease, for both faces.
#pragma once
#include "assembly/cloth_model.hpp"
#include "assembly/implicit_row.hpp"
#include "constraint/particle_constraints.hpp"
#include "contact/proximity.hpp"
#include "step/bristle.hpp"
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

  // L0: the nearest body point of every particle that its velocity and free fall bring to the body within h_s.  Cloth
  // that is released under tension moves farther; `update` searches again for such particles.
  void detect(const ClothState& state, double h_s);

  // The first active set of a step; `dv` is the guess of the change of velocity.  Reads the body's travel, since the
  // step may be shorter than in detect.
  void begin(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step);
  // Adds S, z and y of the particles in contact, and appends the bristles of sliding ones.  Particles that `constraints`
  // already constrains are skipped.  `landing`, m: the part of y that is the rest of a fall.  y and landing are zero
  // before.
  void apply(const ClothState& state, const StepFormula& step, ParticleConstraints& constraints, std::span<Vec3> y,
             std::span<Vec3> landing, std::vector<LinearSpring>& springs);
  // After a solve: releases particles, adds them (also those beyond the reach of detect), and lets them slip.
  // `first_passes`: releases are allowed.
  struct Change {
    int released = 0, added = 0, deep = 0;  // deep: added, and would end below half the offset
    int slipped = 0, touching = 0;          // from stick to slip, or turned back by friction; in contact now
  };
  Change update(const ClothState& state, std::span<const Vec3> dv, std::span<const Vec3> e, const StepFormula& step,
                bool first_passes);
  // Whether the set of particles in contact differs from that at the end of the last accepted step.
  bool changed() const;
  // After an accepted step of h_s: stores forces and contact states for the next.
  void accept(double h_s);

  // Whether the particle was within the body in the last detect.
  bool inside(Index particle) const {
    const BodyPoint& point = points_[static_cast<std::size_t>(particle)];
    return point.triangle >= 0 && point.gap_m < 0;
  }
  // Too far inside to be brought out by y; step/penetration_recovery.hpp draws such a particle out.
  bool too_deep(const BodyPoint& point) const;
  std::span<const BodyPoint> points() const { return points_; }  // [particle] of the last detect; empty without a body
  bool any_near() const { return !near_.empty(); }
  int touching() const;
  Touch touch(Index particle) const { return touch_[static_cast<std::size_t>(particle)]; }
  double normal_force_N(Index particle) const { return lambda_n_[static_cast<std::size_t>(particle)]; }
  // Factor on the colliders' friction from the next step on; 0 lets cloth slip into place.
  void set_friction_share(double share) { friction_share_ = share; }
  void set_friction(std::optional<Index> collider, double friction) { options_.set_friction(collider, friction); }
  double offset_m(const BodyPoint& point) const { return options_.offset_of(body_->collider(point.triangle)); }

  // State between two steps (core/state_archive.hpp); set_friction and set_friction_share are the caller's.
  template <class Archive>
  void remember(Archive& archive) {
    archive(memory_);
    archive.fixed(touch_);
    archive.fixed(lambda_n_);
  }

 private:
  struct Contact {
    BodyPoint point;
    Vec3 body_travel;  // of the body's material point over the step, m
    Vec3 normal;       // in the middle of the step
    bool released = false;
    double lambda_n = 0;  // N
    void follow(const BodySurface& body);
  };
  struct Beside {  // the other face of a crease
    Contact contact;
    bool slit;  // the faces look at each other: the particle is in the middle, constrained along one normal
    bool touched, touches = false;  // in the last step; in this one, where the near face then touches too
  };
  struct Near {  // a particle within reach of the body
    Index particle;
    Contact contact;
    Touch touch = Touch::none;
    bool slipped = false, pinned = false;
    bool slid = true;            // in the last step; false: friction bears the static cone
    std::ptrdiff_t beside = -1;  // index into beside_; -1: no crease
    Vec3 way_m{0, 0, 0};         // along the body, relative to it, in the step by the last pass
    Bristle bristle{};
  };
  struct Memory {  // of a particle that touched in the last accepted step
    Index particle;
    int faces;
    std::array<Vec3, 2> normal;
    double lambda_beside_N;
    bool slid;
    Bristle bristle{};
    template <class Archive>
    void remember(Archive& archive) {
      archive(particle, faces, normal, lambda_beside_N, slid, bristle);
    }
  };
  // The distance at the start of the step within which the body can meet a particle at x that moves by way_m.
  double reach(const Vec3& x, double way_m) const;
  void find_creases(const ClothState& state);
  // The gap at the end of the step, with the velocity v.
  double predicted_gap_m(const Contact& contact, Index particle, const Vec3& v, const StepFormula& step) const;
  bool touches(Near& near, const Vec3& v, const StepFormula& step, Change& change);
  bool releases(Near& near, const Vec3& force_N, bool may_leave);
  Beside* beside(const Near& near) {
    return near.beside < 0 ? nullptr : &beside_[static_cast<std::size_t>(near.beside)];
  }
  Beside* touching_beside(const Near& near) {
    Beside* other = beside(near);
    return other && other->touches ? other : nullptr;
  }
  // The second constraining face, or null.
  const Contact* other_face(const Near& near) {
    const Beside* other = touching_beside(near);
    return other && !other->slit ? &other->contact : nullptr;
  }
  void find_far_moving(const ClothState& state, std::span<const Vec3> dv, const StepFormula& step);
  const Memory* memory_of(Index particle) const;
  Vec3 along_body(Near& near, const Vec3& u);
  Vec3 way_along_body(Near& near, const Vec3& v, const StepFormula& step);
  void touch_down(Near& near, const Vec3& v, const StepFormula& step);
  double offset_m(const Contact& contact) const { return offset_m(contact.point); }
  double friction(const Contact& contact, Index particle) const;
  double cone_N(const Near& near);
  double alteration(const Contact& contact, double to_m) const;
  Vec3 alteration(const Near& near);

  const ClothModel* model_;
  const BodySurface* body_;
  BodyContactOptions options_;
  double largest_offset_m_, friction_share_ = 1;
  std::vector<BodyPoint> points_;  // [particle] nearest point of the body; triangle -1: beyond reach_m_
  std::vector<double> reach_m_;    // [particle] radius of the search
  double altered_share_ = 1;       // factor on the largest alteration, in the step of apply
  bool body_moves_ = false;        // in the step given to detect
  std::vector<Near> near_;         // ascending particles, then those found by `update`
  std::vector<Beside> beside_;
  std::vector<Memory> memory_;    // ascending particles
  std::vector<Touch> touch_;      // [particle] at the end of the last accepted step
  std::vector<double> lambda_n_;  // [particle] N, likewise
};

}  // namespace toile::internal
