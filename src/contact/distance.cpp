#include "contact/distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace toile::internal {
namespace {

// Squared sine below which a triangle is treated as its three edges: they then hold its every point to 1e-6 of its
// size.
constexpr double flat_corner_sine2 = 1e-12;

// Parameter in [0, 1] of the point of a -> b nearest to p; 0 for an edge without length.
double closest_parameter(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 e = b - a;
  const double length2 = e.squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(e) / length2, 0.0, 1.0) : 0.0;
}

void set_edge(VertexTriangle& result, int k, double t, double distance2) {
  const int next = (k + 1) % 3;
  result.distance2 = distance2;
  result.barycentric.setZero();
  result.barycentric[k] = 1 - t;
  result.barycentric[next] += t;
  if (t > 0 && t < 1) {
    result.feature = Feature::edge;
    result.index = k;
  } else {
    result.feature = Feature::vertex;
    result.index = t > 0 ? next : k;
  }
}

// The nearest of the three edges; exact for a triangle without area.
VertexTriangle closest_on_edges(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3* const corner[3] = {&a, &b, &c};
  VertexTriangle result;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &from = *corner[k], &to = *corner[(k + 1) % 3];
    const double t = closest_parameter(p, from, to);
    const double distance2 = (from + t * (to - from) - p).squaredNorm();
    if (k == 0 || distance2 < result.distance2) set_edge(result, k, t, distance2);
  }
  return result;
}

void set_vertex(VertexTriangle& result, int k, double distance2) {
  result.distance2 = distance2;
  result.barycentric.setZero();
  result.barycentric[k] = 1;
  result.feature = Feature::vertex;
  result.index = k;
}

}  // namespace

// Voronoi regions in the order vertex, edge, face (Ericson 5.1.5); va, vb, vc are |normal|^2 times the barycentrics.
VertexTriangle closest_vertex_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm();
  if (!(ab.cross(ac).squaredNorm() > flat_corner_sine2 * ab2 * ac2)) return closest_on_edges(p, a, b, c);

  VertexTriangle result;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return set_vertex(result, 0, ap.squaredNorm()), result;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return set_vertex(result, 1, bp.squaredNorm()), result;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return set_vertex(result, 2, cp.squaredNorm()), result;

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = d1 / (d1 - d3);
    return set_edge(result, 0, t, (ap - t * ab).squaredNorm()), result;
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d6 / (d6 - d2);  // from c towards a
    return set_edge(result, 2, t, (cp + t * ac).squaredNorm()), result;
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return set_edge(result, 1, t, (bp - t * (c - b)).squaredNorm()), result;
  }
  // Rounding in a needle can leave every region; its edges are then as good as its face.
  if (!(va > 0 && vb > 0 && vc > 0)) return closest_on_edges(p, a, b, c);
  const double sum = va + vb + vc, v = vb / sum, w = vc / sum;
  result.barycentric = Vec3(std::max(0.0, 1 - v - w), v, w);
  result.distance2 = (ap - v * ab - w * ac).squaredNorm();
  return result;
}

EdgeEdge closest_edge_edge(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  EdgeEdge result;
  if (interior_edge_edge(p0, p1, q0, q1, result)) return result;

  // Outside the interior the least of a convex function over the square [0,1]^2 lies on its rim: an end and an edge.
  bool first = true;
  const auto offer = [&](double s, double t) {
    const double distance2 = (p0 + s * (p1 - p0) - q0 - t * (q1 - q0)).squaredNorm();
    if (!first && !(distance2 < result.distance2)) return;
    first = false;
    result.distance2 = distance2;
    result.s = s;
    result.t = t;
  };
  offer(0, closest_parameter(p0, q0, q1));
  offer(1, closest_parameter(p1, q0, q1));
  offer(closest_parameter(q0, p0, p1), 0);
  offer(closest_parameter(q1, p0, p1), 1);

  // Nearly parallel edges may still cross between their ends.  The ill-conditioned s costs little there, as the
  // distance hardly depends on it, and the answer is only taken where it is nearer.
  const Vec3 p = p1 - p0, q = q1 - q0, r = p0 - q0;
  const double pp = p.dot(p), qq = q.dot(q), pq = p.dot(q);
  const double determinant = pp * qq - pq * pq;
  if (determinant > 0 && determinant <= parallel_sine2 * pp * qq) {
    const double s = std::clamp((pq * q.dot(r) - p.dot(r) * qq) / determinant, 0.0, 1.0);
    offer(s, closest_parameter(p0 + s * p, q0, q1));
  }
  return result;
}

}  // namespace toile::internal
