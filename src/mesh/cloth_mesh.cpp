#include "mesh/cloth_mesh.hpp"

namespace toile::internal {

MaterialFrame material_frame(const std::array<Vec2, 3>& uv) {
  const Vec2 edge1 = uv[1] - uv[0];                                // (du1, dv1)
  const Vec2 edge2 = uv[2] - uv[0];                                // (du2, dv2)
  const double d = edge1.x() * edge2.y() - edge2.x() * edge1.y();  // twice the signed area

  MaterialFrame frame;
  frame.area_m2 = 0.5 * d;
  // (w_u w_v) = (x1 - x0, x2 - x0) [du1 du2; dv1 dv2]^-1, read off column by column.                   [BW98 eq. 9]
  frame.alpha[1] = edge2.y() / d;
  frame.alpha[2] = -edge1.y() / d;
  frame.beta[1] = -edge2.x() / d;
  frame.beta[2] = edge1.x() / d;
  // Corner 0 follows from the others: a translation has no part in w_u, whatever d was rounded to.
  frame.alpha[0] = -(frame.alpha[1] + frame.alpha[2]);
  frame.beta[0] = -(frame.beta[1] + frame.beta[2]);
  return frame;
}

}  // namespace toile::internal
