// step/swallowed.hpp: cloth deep within the body, and its way out.                                                    (L4)
//
//   F = c (v_out n + v_body - v) . n  along n     c = 500 m / s,  v_out = depth / 0.25 s, 0.1 to 0.5 m/s,  n at the nearest point
//
// Body constraints (step/body_constraints.hpp) hold what comes to the surface within a step.  What is farther in than that came there
// by a start, or out of a pinch: nothing acts on it, and it would fall through the body.  It goes the shortest way out; of a limb that
// cloth is threaded on, no side is the right one, and the cloth stays around it.
#pragma once
#include "assembly/cloth_model.hpp"
#include "assembly/implicit_row.hpp"
#include "step/body_constraints.hpp"

#include <span>
#include <vector>

namespace toile::internal {

class Swallowed {
 public:
  // Both are kept; `body` may be null.
  Swallowed(const ClothModel& model, const BodySurface* body) : model_(&model), body_(body) {}

  // Who is too deep within the body for `constraints`, which have looked at the same x.
  void detect(std::span<const Vec3> x, const BodyConstraints& constraints);
  void clear();
  // Is anything, be there a way out for it now or not?
  bool any() const { return any_; }
  // For a step in which the body moves as it was last told to.
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
