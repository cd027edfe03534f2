// body/thin_body.hpp: thins a body towards its medial axis, and grows it back.                       docs/theory/sewing.md
//
//   conformalised mean curvature flow   (M_k + dt L_0) x_{k+1} = M_k x_k        [Kazhdan, Solomon & Ben-Chen 2012]
//
// with L_0 the cotangents of the full body and M_k the vertex areas of the present shape.  Keeping L_0 makes the flow stable: limbs
// become tubes of two centimetres round their own axes, hands and feet draw in along them, and no part is pinched off.  Vertices
// and triangles stay the same, so growing back is a motion of the same mesh.
//
// The time of the flow has the unit of an area, and scales with the square of the height.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

class ThinBody {
 public:
  // A closed mesh, or several.  Vertices in no triangle stay where they are.
  ThinBody(std::span<const Vec3> full, std::span<const Triangle> triangles);

  // share 0: as thin as it gets; 1: the full body, to the bit.  Between them every vertex goes from shape to shape of the flow.
  void at(double share, std::span<Vec3> x) const;

 private:
  std::vector<Vec3s> shapes_;   // from thin to full
  std::vector<double> shares_;  // when each is reached, in proportion to the root mean square displacement
};

}  // namespace toile::internal
