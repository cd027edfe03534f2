// contact/distance.hpp: closest points of a vertex and a triangle, and of two edges.     [Ericson 2004, ch. 5]
//
// Symbols: lengths in m.  Barycentric coordinates belong to the corners in the order in which they were given.
//
// Degenerate input is legal: a triangle without area is its three edges, an edge without length is a point.  No
// division by zero, and no NaN for finite input.
//
// Easily got wrong: for nearly parallel edges the interior solution is a ratio of two vanishing numbers.  Below
// `parallel_sine2` the ends of the edges decide instead, and `interior` is false.
#pragma once
#include "core/types.hpp"

namespace toile::internal {

enum class Feature : std::uint8_t { face, edge, vertex };

struct VertexTriangle {
  double distance2 = 0;             // m^2
  Vec3 barycentric = Vec3::Zero();  // of the closest point; sums to 1, none negative
  Feature feature = Feature::face;  // of the triangle that contains the closest point
  int index = 0;                    // edge k (corners k, k+1) or vertex k when feature is not face
};
VertexTriangle closest_vertex_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

struct EdgeEdge {
  double distance2 = 0;   // m^2
  double s = 0, t = 0;    // closest points p0 + s (p1-p0) and q0 + t (q1-q0)
  bool interior = false;  // both strictly inside their edges, and the edges not parallel
};
EdgeEdge closest_edge_edge(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1);

// Edges whose angle has a squared sine below this count as parallel (0.0057 degrees, 1 micrometre over 1 cm).
inline constexpr double parallel_sine2 = 1e-8;

// The fast part of closest_edge_edge: where that has `interior`, fills `result` and returns true; elsewhere leaves
// `result` alone and returns false.
inline bool interior_edge_edge(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, EdgeEdge& result) {
  const Vec3 p = p1 - p0, q = q1 - q0, r = p0 - q0;
  const double pp = p.dot(p), qq = q.dot(q), pq = p.dot(q), pr = p.dot(r), qr = q.dot(r);
  // Normal equations of |r + s p - t q|^2; the determinant is |p|^2 |q|^2 sin^2.
  const double determinant = pp * qq - pq * pq;
  if (!(determinant > parallel_sine2 * pp * qq)) return false;
  const double s = pq * qr - pr * qq, t = pp * qr - pq * pr;
  if (!(s > 0 && s < determinant && t > 0 && t < determinant)) return false;
  result.s = s / determinant;
  result.t = t / determinant;
  result.distance2 = (r + result.s * p - result.t * q).squaredNorm();
  result.interior = true;
  return true;
}

}  // namespace toile::internal
