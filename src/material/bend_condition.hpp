// material/bend_condition.hpp: resistance to bending, as a condition.                                  [BW98 4.3]
//
//   C = theta - theta_0,   rad        theta of the hinge x0 x1 x2 x3 drawn in mesh/topology.hpp; see bend.hpp
//
// k is a moment, N m: kappa of bend.hpp, which carries the weight L^2/(A_1 + A_2) that the paper leaves out.
#pragma once
#include "material/bend.hpp"
#include "material/condition.hpp"

namespace toile::internal {

struct BendCondition {
  static constexpr std::string_view name = "bend";
  static constexpr std::size_t particles = 4;
  static constexpr std::size_t components = 1;

  struct Rest {
    double theta_0 = 0;
  };

  static ConditionValue<4, 1> evaluate(const Rest& rest, const std::array<Vec3, 4>& x) {
    return {.C = {hinge_angle(x) - rest.theta_0}, .dC = {hinge_angle_gradient(x)}, .d2C = {hinge_angle_hessian(x)}};
  }
};
static_assert(Condition<BendCondition>);

}  // namespace toile::internal
