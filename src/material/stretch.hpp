// material/stretch.hpp: resistance to stretch along warp (u) and weft (v), as a condition.             [BW98 4.2]
//
//   w_u = sum_i alpha_i x_i,   w_v = sum_i beta_i x_i            the image of one metre of thread
//   C   = s (|w_u| - b_u, |w_v| - b_v)
//   dC_u/dx_i = s alpha_i n,   d2C_u/dx_i dx_j = s alpha_i alpha_j (I - n n^T)/|w_u|,   n = w_u/|w_u|
//
//   symbol         code           unit   meaning
//   alpha_i beta_i alpha, beta    1/m    gradient of corner i's hat function along u and v; each sums to zero
//   s              scale          m      sqrt(rest area), with k in N/m; the paper's is the area, with k in N/m^3
//   b_u b_v        b              1      rest stretch; 1 leaves the cloth as cut
//
// |w| = 0 has no derivative; evaluate() is for |w| > 0 (membrane.hpp guards it).
#pragma once
#include "material/condition.hpp"

namespace toile::internal {

struct StretchCondition {
  static constexpr std::string_view name = "stretch";
  static constexpr std::size_t particles = 3;
  static constexpr std::size_t components = 2;

  struct Rest {
    Vec3 alpha, beta;
    double scale = 0;
    Vec2 b{1, 1};
  };

  static ConditionValue<3, 2> evaluate(const Rest& rest, const std::array<Vec3, 3>& x) {
    ConditionValue<3, 2> c;
    for (std::size_t m = 0; m < 2; ++m) {
      const Vec3& weight = m == 0 ? rest.alpha : rest.beta;
      const Vec3 w = weight[0] * x[0] + weight[1] * x[1] + weight[2] * x[2];
      const double length = w.norm();
      const Vec3 n = w / length;
      const Mat3 across = (Mat3::Identity() - n * n.transpose()) / length;
      c.C[m] = rest.scale * (length - rest.b[static_cast<Eigen::Index>(m)]);
      for (std::size_t i = 0; i < 3; ++i) {
        const double weight_i = weight[static_cast<Eigen::Index>(i)];
        c.dC[m][i] = rest.scale * weight_i * n;
        for (std::size_t j = 0; j < 3; ++j)
          c.d2C[m][i][j] = rest.scale * weight_i * weight[static_cast<Eigen::Index>(j)] * across;
      }
    }
    return c;
  }
};
static_assert(Condition<StretchCondition>);

}  // namespace toile::internal
