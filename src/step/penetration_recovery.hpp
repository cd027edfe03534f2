// step/penetration_recovery.hpp: a force that draws cloth out of the body.                                          (L4)
//
//   F = c (v_out n + v_body - v) . n  along n     n at the nearest point,  c = 500 m / s  (m: the particle's mass)
//   v_out = depth / 0.25 s, 0.1 to 0.5 m/s
//
// Body constraints (step/body_constraints.hpp) act on particles that reach the surface within a step.  Particles deeper
// in, from the start of a run or out of a pinch, would have no contact and fall through the body.  They are drawn out
// the shortest way.  Cloth around a limb, such as a sleeve, has no right side to leave by, and stays around it.
#pragma once
#include "assembly/cloth_model.hpp"
#include "assembly/implicit_row.hpp"
#include "step/body_constraints.hpp"

#include <span>
#include <vector>

namespace toile::internal {

class PenetrationRecovery {
 public:
  // Keeps references to both; `body` may be null.
  PenetrationRecovery(const ClothModel& model, const BodySurface* body) : model_(&model), body_(body) {}

  // Finds the particles that are BodyConstraints::too_deep; `constraints` must have detected at the same x.
  void detect(std::span<const Vec3> x, const BodyConstraints& constraints);
  void clear();
  // Whether any particle is inside the body, with or without a way out.
  bool any() const { return any_; }
  // For a step with the body's motion as last set.
  void append_springs(std::vector<LinearSpring>& springs) const;

 private:
  struct Deep {
    Index particle;
    BodyPoint point;
  };
  const ClothModel* model_;
  const BodySurface* body_;
  std::vector<Deep> deep_;          // ascending particles
  std::vector<BodyPoint> nearest_;  // [particle]
  std::vector<char> has_way_out_;   // [particle]
  bool any_ = false;
};

}  // namespace toile::internal
