// step/flypaper.hpp: cloth pinched between parts of the body nearer to each other than two offsets.      (L1) [BWK03 5]
//
// The offset cannot be kept from both.  A pinched particle is constrained (S = 0) and moves with the two surfaces:
//   with room      r/2 or more between them, and outside of both: it keeps its relative place,
//                    x' = x + (1-s) u_1 + s u_2,   s = g_1/(g_1 + g_2)      g  gap,  u  travel of the nearest point
//                  so it meets neither, layers keep their order, and part again.  The safe filter guards all.
//   without room   x' = x + (u_1 + u_2)/2
//                  so that the distances between layers are kept: with s they would coincide where the surfaces meet.
//                  A pair of pinched particles, one or more without room, is exempt from contact (contact/pinched.hpp);
//                  free particles are kept out of the pinch.
//
//   begins     outside of both, between faces that look at each other (n_1 . n_2 < -1/2, the particle within 60 degrees
//              over each) and approach each other, less than 2 r apart now or at the end of the step (r: the mean of
//              their offsets).  The back of a finger is no second surface: seen from its front, the particle is within
//              it.
//   continues  with the nearest faces that look the way the last ones did, searched in every step: the particle may be
//              within both
//   ends       2.2 r apart; or outside of both, r apart and receding; or when a face is not found any more; or when the
//              faces look the same way: a crease that has opened
//
// A crease that does not close pinches nothing, however narrow it is.
#pragma once
#include "assembly/cloth_model.hpp"
#include "constraint/particle_constraints.hpp"
#include "contact/body_surface.hpp"
#include "contact/pinched.hpp"
#include "step/collider_contact.hpp"
#include "step/step_formula.hpp"

#include <array>
#include <span>
#include <vector>

namespace toile::internal {

class Flypaper {
 public:
  // `body` may be null: nothing is pinched then.
  Flypaper(const BodySurface* body, std::size_t particles, BodyContactOptions contact);

  // Finds the pinched particles of the coming step.  `nearest` [particle]: the body's nearest point, or triangle -1
  // where it is far.
  void detect(const ClothState& state, std::span<const BodyPoint> nearest);
  // Constrains them, except those already in `constraints`.  The body's step may be shorter than in detect.
  void apply(const ClothState& state, const StepFormula& step, ParticleConstraints& constraints) const;

  bool any() const { return !pinches_.empty(); }
  std::size_t count() const { return pinches_.size(); }
  std::span<const Pinched> pinched() const { return pinched_; }  // [particle]
  // Number of steps with a particle without room; if it has grown, cloth may have passed through cloth.
  long steps_without_room() const { return steps_without_room_; }
  bool any_without_room() const { return any_without_room_; }

  // State between two steps (core/state_archive.hpp).
  template <class Archive>
  void remember(Archive& archive) {
    archive(pinches_);
    archive.fixed(pinched_);
    archive(any_without_room_, steps_without_room_);
  }

 private:
  struct Pinch {
    Index particle;
    std::array<BodyPoint, 2> side;
    bool room = true;
    double apart() const { return side[0].gap_m + side[1].gap_m; }
    bool outside() const { return side[0].gap_m > 0 && side[1].gap_m > 0; }
    template <class Archive>
    void remember(Archive& archive) {
      archive(particle, side, room);
    }
  };
  bool goes_on(Pinch& pinch, const Vec3& x) const;
  bool begins(Pinch& pinch, const Vec3& x) const;
  double closing(const Pinch& pinch) const;
  double offset_m(const BodyPoint& side) const { return contact_.offset_of(body_->collider(side.triangle)); }
  double offset_m(const Pinch& pinch) const { return 0.5 * (offset_m(pinch.side[0]) + offset_m(pinch.side[1])); }
  bool has_room(const Pinch& pinch) const;

  const BodySurface* body_;
  BodyContactOptions contact_;
  std::vector<Pinch> pinches_, candidates_;  // ascending particles
  std::vector<Pinched> pinched_, was_;       // [particle]; before the last detect
  std::vector<char> begun_;                  // [candidate]
  bool any_without_room_ = false;
  long steps_without_room_ = 0;
};

}  // namespace toile::internal
