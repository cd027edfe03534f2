// step/flypaper.hpp: cloth between two parts of the body that come nearer to each other than two offsets.   (L1) [BWK03 5]
//
//   The offset cannot be kept from both.  What is pinched is held (S = 0) and goes where the two surfaces go on the average:
//     x' = x + (u_1 + u_2)/2,   u  travel of the body's nearest point on either side
//   Layers keep their places to each other so, and need no contact; nothing pulls them to the middle, where they would coincide.
//   Neither layers nor the body act on it, and the safe filter lets it be: the two may pass through each other around it.
//
//   begins  outside of both, between faces that look at each other (n_1 . n_2 < -1/2) and close on each other, less than 2 r apart now or
//           at the end of the step.  The back of a finger is no second surface: from its front, the particle is within it.
//   goes on with the nearest faces that look the way that the last ones looked, found anew in every step: the particle may be within both
//   ends    2.2 r apart; or outside of both, while they part and are r apart; or when one of them is not found any more
//
// Around it faces are not guarded: where two parts only come near each other and do not overlap, it lets edges pass (docs/theory/step.md).
// A crease that does not close pinches nothing, however narrow it is.
#pragma once
#include "assembly/cloth_model.hpp"
#include "constraint/particle_constraints.hpp"
#include "contact/body_surface.hpp"
#include "step/step_formula.hpp"

#include <array>
#include <span>
#include <vector>

namespace toile {

class Flypaper {
 public:
  // `body` may be null: then nothing is ever pinched.
  Flypaper(const BodySurface* body, std::size_t particles, double offset_m);

  // Who is pinched in the coming step.  `nearest` [particle]: the body's nearest point, or triangle -1 where it is far.
  void detect(const ClothState& state, std::span<const BodyPoint> nearest);
  // Holds them, but for those that `constraints` hold already.  The body may have been told of a shorter step since.
  void apply(const ClothState& state, const StepFormula& step, ParticleConstraints& constraints) const;

  bool any() const { return !pinches_.empty(); }
  std::size_t count() const { return pinches_.size(); }
  std::span<const char> pinched() const { return pinched_; }  // [particle]

 private:
  struct Pinch {
    Index particle;
    std::array<BodyPoint, 2> side;
  };
  bool goes_on(Pinch& pinch, const Vec3& x) const;
  bool begins(Pinch& pinch, const Vec3& x) const;
  double closing(const Pinch& pinch) const;

  const BodySurface* body_;
  double offset_m_, farthest_travel_m_ = 0;
  std::vector<Pinch> pinches_, candidates_;  // ascending particles
  std::vector<char> pinched_, was_, begun_;  // [particle], likewise before the last detect, [candidate]
};

}  // namespace toile
