#include "contact/ccd.hpp"

#include "contact/distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

using Points = std::array<Vec3, 4>;

constexpr double advance_share = 0.9;       // of the advance that the bound allows: the rest stays well above rounding
constexpr double advance_reserve = 0.05;    // of d - xi need not be proven: an advance leaves 0.1
constexpr double rounding_share = 0x1p-45;  // e / M: derived in the header
constexpr double least_direction = 1e-100;  // its square is well above underflow
constexpr int most_advances = 2000;         // a pair that has not been decided by then is an impact

// The points found to be closest: distance, difference, and w . w less the support of w (below), m^2.
struct Found {
  double distance_m;
  Vec3 w;
  double loss;
};

// support(w): the least w . (a - b) over a of the first feature and b of the second.  Both are convex: corners suffice.

struct VertexFace {
  static Found closest(const Points& x) {
    const VertexTriangle closest = closest_vertex_triangle(x[0], x[1], x[2], x[3]);
    const Vec3 ab = x[2] - x[1], ac = x[3] - x[1];
    const double b = closest.barycentric[1], c = closest.barycentric[2];
    const Vec3 w = x[0] - x[1] - b * ab - c * ac;
    const double along_ab = w.dot(ab), along_ac = w.dot(ac);
    return {std::sqrt(closest.distance2), w, std::max({0.0, along_ab, along_ac}) - b * along_ab - c * along_ac};
  }
  static double support(const Points& x, const Vec3& w) {
    return w.dot(x[0] - x[1]) - std::max({0.0, w.dot(x[2] - x[1]), w.dot(x[3] - x[1])});
  }
  static constexpr std::array<std::array<std::size_t, 3>, 3> ends_and_edges{{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
  static Vec3 normal(const Points& x) { return (x[2] - x[1]).cross(x[3] - x[1]); }
};

struct TwoEdges {
  static Found closest(const Points& x) {
    EdgeEdge closest;
    const Vec3 p = x[1] - x[0], q = x[3] - x[2];
    if (interior_edge_edge(x[0], x[1], x[2], x[3], closest)) {
      const Vec3 w = x[0] - x[2] + closest.s * p - closest.t * q;
      return {std::sqrt(closest.distance2), w, std::abs(w.dot(p)) + std::abs(w.dot(q))};
    }
    closest = closest_edge_edge(x[0], x[1], x[2], x[3]);
    const double s = closest.s, t = closest.t;
    const Vec3 w = x[0] - x[2] + s * p - t * q;
    const double along_p = w.dot(p), along_q = w.dot(q);
    return {std::sqrt(closest.distance2), w,
            s * along_p - t * along_q - std::min(0.0, along_p) + std::max(0.0, along_q)};
  }
  static double support(const Points& x, const Vec3& w) {
    return w.dot(x[0] - x[2]) + std::min(0.0, w.dot(x[1] - x[0])) - std::max(0.0, w.dot(x[3] - x[2]));
  }
  static constexpr std::array<std::array<std::size_t, 3>, 4> ends_and_edges{
      {{0, 2, 3}, {1, 2, 3}, {2, 0, 1}, {3, 0, 1}}};
  static Vec3 normal(const Points& x) { return (x[1] - x[0]).cross(x[3] - x[2]); }
};

// The greatest lower bound among the directions in which two polytopes can be nearest: normals of the face or of both
// edges, of an end and an edge, of two ends.
template <class Features>
double lower_bound(const Points& x, const Vec3& w) {
  double bound = 0;
  const auto offer = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (length > least_direction)
      bound = std::max({bound, Features::support(x, direction) / length, Features::support(x, -direction) / length});
  };
  offer(w);
  offer(Features::normal(x));
  for (const auto& [p, a, b] : Features::ends_and_edges) {
    const Vec3 edge = x[b] - x[a];
    const double length2 = edge.squaredNorm();
    Vec3 across = x[p] - x[a];
    offer(across);
    offer(x[p] - x[b]);
    if (!(length2 > 0)) continue;
    for (int i = 0; i < 2; ++i) across -= across.dot(edge) / length2 * edge;  // twice: the first leaves rounding
    offer(across);
  }
  return bound;
}

// The computed distance, if all but `advance_reserve` of its excess over xi is proven; else the proven bound.  w is as found.
template <class Features>
double proven_distance(const Points& x, double separation_m, double rounding_m, Vec3& w) {
  const Found found = Features::closest(x);
  const double d = found.distance_m;
  w = found.w;
  if (found.loss <= d * (advance_reserve * (d - separation_m) - rounding_m)) return d;
  return std::min(d, lower_bound<Features>(x, found.w) - rounding_m);
}

double largest_coordinate(const Points& x) {
  return std::max(
      {x[0].cwiseAbs().maxCoeff(), x[1].cwiseAbs().maxCoeff(), x[2].cwiseAbs().maxCoeff(), x[3].cwiseAbs().maxCoeff()});
}

// Whether two times of the motion are both farther apart along w.  Then so is all between: every w . (a - b) is linear in t.
template <class Features>
bool apart_along(const Vec3& w, const Points& x, const Points& y, double apart_m, double rounding_m) {
  const double length = w.norm();
  return length > least_direction &&
         std::min(Features::support(x, w), Features::support(y, w)) > (apart_m + rounding_m) * length;
}

// `l_m` bounds the change of the distance over the whole motion.
template <class Features>
double first_impact(const Points& x, const Points& u, double l_m, double separation_m) {
  const double rounding_m = rounding_share * (largest_coordinate(x) + largest_coordinate(u));
  Vec3 w;
  double d = proven_distance<Features>(x, separation_m, rounding_m, w);
  const double room = d - separation_m;
  if (!(room > 0)) return 0;
  if ((1 - advance_reserve) * room > l_m) return no_impact;
  Points end;
  for (std::size_t k = 0; k < 4; ++k) end[k] = x[k] + u[k];
  if (room < separation_m) {  // advances would be short: do they separate, or slide along each other?
    for (const Vec3& along : {w, Features::closest(end).w})
      if (apart_along<Features>(along, x, end, separation_m, rounding_m)) return no_impact;
  }
  const double stop_m = std::min(0.1 * room, 0.2 * separation_m);
  double t = 0;
  Points moved = x;
  for (int i = 0; i < most_advances; ++i) {
    const double next = t + advance_share * (d - separation_m) / l_m;
    if (next > 1 || apart_along<Features>(w, moved, end, clear_share * separation_m, rounding_m)) return no_impact;
    for (std::size_t k = 0; k < 4; ++k) moved[k] = x[k] + next * u[k];
    d = proven_distance<Features>(moved, separation_m, rounding_m, w);
    t = next;
    if (!(d - separation_m >= stop_m)) return t;  // still farther apart than xi: a tenth of the room before is left
  }
  return t;
}

std::array<double, 4> relative_lengths(const Points& u) {
  const Vec3 mean = 0.25 * (u[0] + u[1] + u[2] + u[3]);
  return {(u[0] - mean).norm(), (u[1] - mean).norm(), (u[2] - mean).norm(), (u[3] - mean).norm()};
}

}  // namespace

double vertex_face_impact(const Points& x, const Points& u, double separation_m) {
  const std::array<double, 4> p = relative_lengths(u);
  return first_impact<VertexFace>(x, u, p[0] + std::max({p[1], p[2], p[3]}), separation_m);
}

double edge_edge_impact(const Points& x, const Points& u, double separation_m) {
  const std::array<double, 4> p = relative_lengths(u);
  return first_impact<TwoEdges>(x, u, std::max(p[0], p[1]) + std::max(p[2], p[3]), separation_m);
}

}  // namespace toile::internal
