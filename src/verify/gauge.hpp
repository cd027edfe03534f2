// verify/gauge.hpp: stretch over a gauge length, as a laboratory measures it.                            docs/reason-codes.md
//
//   gauge stretch   of a triangle: the mean of max(0, stretch) over the cloth of its panel within gauge_m / 2 of its middle, with weight
//                   area x (1 - (d / r)^2)^2.  Compression counts as 0, or a fold would hide the stretch beside it
//
// A triangle in the corner of an armhole may be two millimetres long, and its stretch grows as the mesh gets finer: the stress at the tip of a
// cut is singular.  25 mm is the width of the strip, and of the grips, in the tensile tests for woven cloth (ISO 13934, ASTM D5034, D5035).
//
//   ring            the cloth along the plane of its most stretched thread and its normal: how long it is as worn and as cut
#pragma once
#include "mesh/cloth_mesh.hpp"

#include <span>
#include <vector>

namespace toile::internal {

constexpr double gauge_m = 0.025;

// [triangle] gauge stretch, from the stretch of each; triangles with `left_out` != 0 get 0 and do not contribute.
std::vector<double> gauge_stretch(const ClothMesh& mesh, std::span<const double> stretch,
                                  std::span<const char> left_out);

struct ClothRing {
  double worn_m = 0, cut_m = 0;  // 0: no ring
  bool closed = false;           // it returns to its start; otherwise it ends at a hem
  Vec3 middle_m{0, 0, 0};        // of its length, as worn
  Vec3 normal{0, 0, 0};          // of its plane
};
// Through the middle of a triangle, along the plane with this normal.  Follows the cloth over its seams.
ClothRing cloth_ring(const ClothMesh& mesh, std::span<const Vec3> x, Index triangle, const Vec3& normal);

// The girth, by a tape, of all parts of the body within a closed ring, in the ring's plane, m: of both legs in a skirt.  0: no body.
double girth_within_m(const ClothRing& ring, std::span<const Vec3> body_x, std::span<const Triangle> body);

}  // namespace toile::internal
