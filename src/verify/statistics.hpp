// verify/statistics.hpp: stretch and shear of cloth, its gap to the body, and its remaining speed.
//
//   stretch = max(|w_u| / b_u, |w_v| / b_v) - 1        of a triangle; negative when both directions are shortened
//   shear   = |90 deg - angle(w_u, w_v)|
//   gap     = distance of a cloth vertex to the body's surface, negative inside
//   w_u, w_v: the pattern's axes as they lie in space [BW98 eq. 9];  p50, p99: nearest rank, a value that occurs
//
// Easily got wrong: the sign of the gap.  The side of the nearest triangle is not the side of the body (at an edge or a
// vertex the nearest triangles disagree, and arms overlap trunks), so the surface is crossed along a ray and the
// crossings are counted with their direction; degenerate hits are exact (predicates.hpp).
#pragma once
#include "mesh/cloth_mesh.hpp"
#include "verify/gauge.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// The smallest of `values` that at least `percent` % of them do not exceed (percent in 1..100); 0 when there are none.
// Reorders `values`.
double nearest_rank(std::vector<double>& values, int percent);

struct StretchStatistics {
  double p50 = 0, p99 = 0, max = 0;  // over all triangles
  double shear_p50_deg = 0, shear_p99_deg = 0, shear_max_deg = 0;
  Index worst_triangle = -1;  // of max
  // By triangle, without elastic panels, which are meant to be longer than their rest length.
  double triangle_p99 = 0, triangle_max = 0;
  Index triangle_worst = -1;
  // Likewise, over a gauge (verify/gauge.hpp): the judged values.
  double gauge_p99 = 0, gauge_max = 0;
  Index gauge_worst_triangle = -1;
  Vec3 gauge_worst_m{0, 0, 0};  // its middle
  ClothRing ring;               // the cloth along the stretched thread there
  double body_girth_m = 0;      // of the body within it; 0: no body
  Index elastic_triangles = 0;  // with b other than (1, 1)
};

// `b` is (b_u, b_v) per triangle; empty means 1.  Throws InputError when sizes differ, a b is not a positive number, or
// a triangle has no area in the pattern.
StretchStatistics measure_stretch(const ClothMesh& mesh, std::span<const Vec3> x, std::span<const Vec2> b);

struct GapStatistics {
  double min_mm = 0, p50_mm = 0;
  Index nearest_vertex = -1;  // of min: the nearest, or the deepest inside
  // The gap of the cloth that lies on the body: of the vertices outside within hover_reach_mm.
  Index hovering = 0;  // the number of these vertices
  double hover_p50_mm = 0, hover_p90_mm = 0;
};

// Twice the offset at which cloth rests on a body (2.5 mm): cloth farther away does not lie on the body.  Cloth that bridges a hollow
// nearer than this counts as well, so the p90 is an upper bound for touching cloth.
constexpr double hover_reach_mm = 5;

// Over all vertices `x`, signed.  A vertex is inside when the surface winds around it (either way: non-zero rule).
// Holes of the surface (an open neck or wrist) are closed for this question by fans around their middle.  A flat
// surface has no inside.  All zero when there is no vertex or no body triangle.  Throws InputError as
// find_body_crossings does.
GapStatistics measure_gap(std::span<const Vec3> x, std::span<const Triangle> body, std::span<const Vec3> body_x);

// The p99 over vertices of |x - x_before| fps, in mm/s.  Sizes must agree.
double speed_p99_mm_per_s(std::span<const Vec3> x_before, std::span<const Vec3> x, double fps);

}  // namespace toile::internal
