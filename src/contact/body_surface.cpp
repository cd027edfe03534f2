#include "contact/body_surface.hpp"

#include "contact/distance.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace toile::internal {
namespace {

constexpr std::size_t normal_grain = 1024;
constexpr double touching_m = 1e-9;  // nearer than this the direction to the body is rounding
constexpr double flat_bend = 1e-3;
constexpr double farthest_m = 1e6;
constexpr double facing_cosine = 0.5;
constexpr double cancelled_normal = 1e-6;  // a sum of unit normals shorter than this has no direction (a knife's edge)

// Triangles that share an edge or a vertex are equally far from a point nearest to that, and so are both sides of a body from its middle:
// the one with the smaller index is taken, independent of the tree's order.
class Nearest {
 public:
  explicit Nearest(double reach_m) : best2_(reach_m * reach_m) {}

  // Whether triangle t, at this squared distance, is the nearest up to now.
  bool takes(Index t, double distance2) {
    if (!(distance2 < best2_ || (distance2 == best2_ && t < triangle_))) return false;
    best2_ = distance2;
    triangle_ = t;
    return true;
  }
  // Slightly enlarged, for boxes and heights: triangles equally near up to the rounding of coordinates of some metres are still visited.
  double bound2() const { return best2_ * (1 + 1e-8) + 1e-22; }

 private:
  double best2_;
  Index triangle_ = -1;  // nothing at the reach itself is taken
};

// arccos to 2e-8 rad, from + - * / sqrt only: the C library's differs between processors, and a weight needs no more.
// [Abramowitz & Stegun 4.4.46]
double arc_cosine(double x) {
  const double y = std::min(std::fabs(x), 1.0);
  double polynomial = -0.0012624911;
  for (const double c :
       {0.0066700901, -0.0170881256, 0.0308918810, -0.0501743046, 0.0889789874, -0.2145988016, 1.5707963050}) {
    polynomial = polynomial * y + c;
  }
  const double angle = std::sqrt(1 - y) * polynomial;
  return x >= 0 ? angle : 3.14159265358979324 - angle;
}

}  // namespace

BodySurface::BodySurface(std::vector<Vec3> positions, std::vector<Triangle> triangles,
                         std::vector<Index> vertex_collider)
    : start_(std::move(positions)),
      end_(start_),
      moved_(start_.size(), 1),
      still_(start_.size(), 1),
      triangles_(std::move(triangles)),
      vertex_collider_(std::move(vertex_collider)),
      topology_(build_topology(static_cast<Index>(start_.size()), triangles_)),
      tree_(start_, triangles_),
      tree_now_(tree_),
      owned_(assign_features(start_.size(), triangles_, topology_)),
      corners_(particle_corners(start_.size(), triangles_)) {
  update_normals();
}

void BodySurface::set_end(std::span<const Vec3> end) {
  if (end.size() != start_.size())
    throw InputError("", "body motion", std::to_string(start_.size()) + " vertices", std::to_string(end.size()));
  end_.assign(end.begin(), end.end());
}

void BodySurface::set_motion(std::span<const Vec3> start, std::span<const Vec3> end) {
  if (start.size() != start_.size())
    throw InputError("", "body motion", std::to_string(start_.size()) + " vertices", std::to_string(start.size()));
  set_end(end);
  bool any = false;
  for (std::size_t i = 0; i < start_.size(); ++i) {
    const bool still = end[i] == start[i], moved = !still || still_[i] == 0 || start[i] != start_[i];
    still_[i] = static_cast<std::uint8_t>(still);
    moved_[i] = static_cast<std::uint8_t>(moved);
    any |= moved;
  }
  if (!any) return;
  start_.assign(start.begin(), start.end());
  tree_.refit(start_, end_, 0, moved_);
  tree_now_.refit(start_, start_, 0, moved_);
  update_normals();
}

double BodySurface::travel_near(const Vec3& p, double reach_m) const {
  OuterBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = p[static_cast<Eigen::Index>(k)];
    box.low[k] = OuterBox::below(c - reach_m);
    box.high[k] = OuterBox::above(c + reach_m);
  }
  double travel2 = 0;
  tree_.visit_overlapping(box, [&](Index t) {
    for (const Index i : triangle(t)) travel2 = std::max(travel2, vertex_travel(i).squaredNorm());
  });
  return std::sqrt(travel2);
}

Vec3 BodySurface::normal_midway(Index triangle, const Vec3& normal) const {
  const auto& [a, b, c] = triangles_[static_cast<std::size_t>(triangle)];
  const auto x = [&](Index i) -> const Vec3& { return end_[static_cast<std::size_t>(i)]; };
  const Vec3 turn = unit_or_zero((x(b) - x(a)).cross(x(c) - x(a))) - face_normal(triangle);
  if (turn.squaredNorm() < 1e-20) return normal;
  return unit_or_zero(normal + 0.5 * turn);
}

void BodySurface::update_normals() {
  const auto x = [&](Index i) -> const Vec3& { return start_[static_cast<std::size_t>(i)]; };
  face_normals_.resize(triangles_.size());
  corner_angles_.resize(3 * triangles_.size());
  face_moved_.resize(triangles_.size());
  parallel_for(triangles_.size(), normal_grain, [&](std::size_t t) {
    const auto& [a, b, c] = triangles_[t];
    const auto moved = [&](Index i) { return moved_[static_cast<std::size_t>(i)] != 0; };
    face_moved_[t] = static_cast<std::uint8_t>(moved(a) || moved(b) || moved(c));
    if (face_moved_[t] == 0) return;
    const Vec3 side[3] = {x(b) - x(a), x(c) - x(b), x(a) - x(c)};
    face_normals_[t] = unit_or_zero(side[0].cross(side[1]));
    const double length[3] = {side[0].norm(), side[1].norm(), side[2].norm()};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t before = (k + 2) % 3;
      const double product = length[k] * length[before];
      corner_angles_[3 * t + k] = product > 0 ? arc_cosine(-side[k].dot(side[before]) / product) : 0.0;
    }
  });

  edge_normals_.resize(topology_.edges.size());
  ridge_bend_.resize(topology_.edges.size());
  edge_moved_.resize(topology_.edges.size());
  const auto face_moved = [&](Index t) { return face_moved_[static_cast<std::size_t>(t)] != 0; };
  parallel_for(topology_.edges.size(), normal_grain, [&](std::size_t e) {
    const Edge& edge = topology_.edges[e];
    edge_moved_[e] = static_cast<std::uint8_t>(face_moved(edge.triangle[0]) ||
                                               (edge.triangle[1] >= 0 && face_moved(edge.triangle[1])));
    if (edge_moved_[e] == 0) return;
    const Vec3& n = face_normal(edge.triangle[0]);
    ridge_bend_[e] = 0;
    edge_normals_[e] = n;
    if (edge.triangle[1] < 0) return;
    const Vec3& m = face_normal(edge.triangle[1]);
    const auto opposite = [&](std::size_t side) {
      Index sum = 0;
      for (const Index i : triangle(edge.triangle[side])) sum += i;
      return Vec3(x(sum - edge.a - edge.b) - x(edge.a));
    };
    const Vec3 to_second = opposite(1);
    const double bend = (n - m).norm();
    if (bend > flat_bend && n.dot(to_second) < 0) ridge_bend_[e] = bend;
    const Vec3 sum = n + m;
    // Two sides of a sheet folded onto itself: out is away from both.
    edge_normals_[e] = unit_or_zero(sum.norm() > cancelled_normal ? sum : Vec3(-opposite(0) - to_second));
  });

  vertex_normals_.resize(start_.size());
  parallel_for(start_.size(), normal_grain, [&](std::size_t i) {
    const auto corners = corners_.row(static_cast<Index>(i));
    if (std::none_of(corners.begin(), corners.end(), [&](Index at) { return face_moved(at / 3); })) return;
    Vec3 sum = Vec3::Zero(), away = Vec3::Zero();
    for (const Index at : corners) {
      const Index t = at / 3;
      sum += corner_angles_[static_cast<std::size_t>(at)] * face_normal(t);
      for (const Index j : triangle(t)) away -= x(j) - start_[i];
    }
    vertex_normals_[i] = unit_or_zero(sum.norm() > cancelled_normal ? sum : away);
  });

  owned_ridges_.resize(triangles_.size());
  parallel_for(triangles_.size(), normal_grain, [&](std::size_t t) {
    const auto& edges = topology_.triangle_edges[t];
    const auto edge_moved = [&](Index e) { return edge_moved_[static_cast<std::size_t>(e)] != 0; };
    if (std::none_of(edges.begin(), edges.end(), edge_moved)) return;
    unsigned bits = owned_[t];
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(ridge_bend(edges[k]) > 0)) bits &= ~(8u << k);
    }
    owned_ridges_[t] = static_cast<std::uint8_t>(bits);
  });
}

BodyPoint BodySurface::nearest(const Vec3& p, double reach_m) const {
  const auto x = [&](Index i) -> const Vec3& { return start_[static_cast<std::size_t>(i)]; };
  BodyPoint result;
  VertexTriangle closest;
  Nearest nearest(reach_m);
  tree_now_.nearest(p, nearest.bound2(), [&](Index t, double bound2) {
    const Triangle& c = triangle(t);
    const double height = face_normal(t).dot(p - x(c[0]));
    if (height * height >= bound2) return bound2;
    const VertexTriangle candidate = closest_vertex_triangle(p, x(c[0]), x(c[1]), x(c[2]));
    if (!nearest.takes(t, candidate.distance2)) return bound2;
    closest = candidate;
    result.triangle = t;
    return nearest.bound2();
  });
  if (result.triangle < 0) return result;

  const auto t = static_cast<std::size_t>(result.triangle);
  const auto k = static_cast<std::size_t>(closest.index);
  const Vec3& out = closest.feature == Feature::face   ? face_normals_[t]
                    : closest.feature == Feature::edge ? edge_normal(topology_.triangle_edges[t][k])
                                                       : vertex_normal(triangles_[t][k]);
  result.barycentric = closest.barycentric;
  const Vec3 from_body = p - position(result.triangle, closest.barycentric);
  const double distance = std::sqrt(closest.distance2);
  const double side = from_body.dot(out) < 0 ? -1.0 : 1.0;
  result.gap_m = side * distance;
  result.normal = distance > touching_m ? Vec3(side / distance * from_body) : out;
  return result;
}

BodyPoint BodySurface::nearest_facing(const Vec3& p, const Vec3& direction, double reach_m) const {
  const auto x = [&](Index i) -> const Vec3& { return start_[static_cast<std::size_t>(i)]; };
  BodyPoint result;
  Nearest nearest(reach_m);
  tree_now_.nearest(p, nearest.bound2(), [&](Index t, double bound2) {
    const Vec3& n = face_normal(t);
    if (n.dot(direction) <= facing_cosine * direction.norm()) return bound2;
    const Triangle& c = triangle(t);
    const double height = n.dot(p - x(c[0]));
    if (height * height >= bound2) return bound2;
    const VertexTriangle candidate = closest_vertex_triangle(p, x(c[0]), x(c[1]), x(c[2]));
    if (!nearest.takes(t, candidate.distance2)) return bound2;
    result = {t, candidate.barycentric, n, height};
    return nearest.bound2();
  });
  return result;
}

// Of points q within the reach R, those with (q - p) . n > |q - p|/2 lie in the ball around p + R n with radius R.
BodyPoint BodySurface::nearest_opposite(const Vec3& p, const Vec3& normal, double reach_m) const {
  const auto x = [&](Index i) -> const Vec3& { return start_[static_cast<std::size_t>(i)]; };
  BodyPoint result;
  Nearest nearest(reach_m);
  tree_now_.nearest(p + reach_m * normal, nearest.bound2(), [&](Index t, double bound2) {
    const Vec3& n = face_normal(t);
    if (n.dot(normal) >= -facing_cosine) return bound2;
    const Triangle& c = triangle(t);
    const VertexTriangle candidate = closest_vertex_triangle(p, x(c[0]), x(c[1]), x(c[2]));
    if (candidate.distance2 > nearest.bound2()) return bound2;
    const Vec3 way = position(t, candidate.barycentric) - p;
    if (way.dot(normal) <= facing_cosine * way.norm()) return bound2;
    if (!nearest.takes(t, candidate.distance2)) return bound2;
    result = {t, candidate.barycentric, n, n.dot(p - x(c[0]))};
    return bound2;
  });
  return result;
}

// Signed crossings of the ray from p along z.  The side on which it passes an edge is computed in one way for both
// triangles of the edge, so that it never slips between them.
int BodySurface::winding_number(const Vec3& p) const {
  Box ray{p, p};
  ray.high.z() = farthest_m;
  std::vector<Index> met;
  tree_now_.overlapping(ray, met);
  const auto x = [&](Index i) -> const Vec3& { return start_[static_cast<std::size_t>(i)]; };
  const auto is_left = [&](Index a, Index b) {  // of the edge from a to b, seen from above
    const Vec3 from = x(std::min(a, b)) - p, to = x(std::max(a, b)) - p;
    return (from.x() * to.y() - from.y() * to.x() > 0) == (a < b);
  };
  int winding = 0;
  for (const Index t : met) {
    const Triangle& c = triangle(t);
    const bool left = is_left(c[0], c[1]);
    if (is_left(c[1], c[2]) != left || is_left(c[2], c[0]) != left) continue;
    const Vec3 normal = (x(c[1]) - x(c[0])).cross(x(c[2]) - x(c[0]));
    if (((x(c[0]) - p).dot(normal) > 0) == (normal.z() > 0)) winding += left ? 1 : -1;
  }
  return winding;
}

}  // namespace toile::internal
