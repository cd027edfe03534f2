// material/shear.hpp: resistance to shear between warp and weft, as a condition.                       [BW98 4.3]
//
//   C = s w_u . w_v                                    zero where the threads cross at a right angle
//   dC/dx_i = s (alpha_i w_v + beta_i w_u),   d2C/dx_i dx_j = s (alpha_i beta_j + beta_i alpha_j) I
//
// Symbols and units as in stretch.hpp.  For small angles w_u . w_v is the angle itself, because the stretch
// condition keeps |w_u| and |w_v| near one.
#pragma once
#include "material/condition.hpp"

namespace toile::internal {

struct ShearCondition {
  static constexpr std::string_view name = "shear";
  static constexpr std::size_t particles = 3;
  static constexpr std::size_t components = 1;

  struct Rest {
    Vec3 alpha, beta;
    double scale = 0;
  };

  static ConditionValue<3, 1> evaluate(const Rest& rest, const std::array<Vec3, 3>& x) {
    const Vec3 &a = rest.alpha, &b = rest.beta;
    const Vec3 w_u = a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
    const Vec3 w_v = b[0] * x[0] + b[1] * x[1] + b[2] * x[2];
    ConditionValue<3, 1> c;
    c.C[0] = rest.scale * w_u.dot(w_v);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(i);
      c.dC[0][row] = rest.scale * (a[i] * w_v + b[i] * w_u);
      for (Eigen::Index j = 0; j < 3; ++j)
        c.d2C[0][row][static_cast<std::size_t>(j)] = rest.scale * (a[i] * b[j] + b[i] * a[j]) * Mat3::Identity();
    }
    return c;
  }
};
static_assert(Condition<ShearCondition>);

}  // namespace toile::internal
