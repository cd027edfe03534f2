// body/remesh.cpp: isotropic remeshing of a half surface onto the zero set of its field.        [Botsch & Kobbelt 2004]
//
// Dead triangles keep their place (corner 0 is -1) until the end, so that an index stays valid through a sweep.
// A border vertex lies on x = 0: it slides along the border only, and no collapse moves it off the plane.
#include "body/polygonise.hpp"
#include "core/parallel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace toile::internal {

namespace {

class Remesher {
 public:
  Remesher(HalfSurface& surface, const ScalarField& field, const ScalarField& edge_m)
      : field_(field), edge_m_(edge_m), x_(std::move(surface.positions)), t_(std::move(surface.triangles)) {
    ring_.resize(x_.size());
    border_.resize(x_.size());
    for (std::size_t i = 0; i < x_.size(); ++i) border_[i] = x_[i].x() == 0;
    for (Index i = 0; i < static_cast<Index>(t_.size()); ++i)
      for (Index v : t_[at(i)]) ring_[at(v)].push_back(i);
  }

  void sweep() {
    split_long();
    collapse_short();
    flip([this](Index a, Index b, Index c, Index d) { return valence_gain(a, b, c, d) > 0; });
    relax();
  }

  // The last sweeps keep the vertices and improve angles only.
  void polish() {
    flip([this](Index a, Index b, Index c, Index d) { return opposite_cosines(a, b, c, d) < -1e-3; });
    relax();
  }

  HalfSurface take() {
    std::vector<Index> map(x_.size(), -1);
    HalfSurface out;
    for (std::size_t i = 0; i < x_.size(); ++i)
      if (!ring_[i].empty()) {
        map[i] = static_cast<Index>(out.positions.size());
        out.positions.push_back(x_[i]);
      }
    for (const Triangle& t : t_)
      if (t[0] >= 0) out.triangles.push_back({map[at(t[0])], map[at(t[1])], map[at(t[2])]});
    return out;
  }

 private:
  using EdgeKey = std::pair<Index, Index>;

  std::vector<EdgeKey> edges() const {
    std::vector<EdgeKey> list;
    list.reserve(3 * t_.size());
    for (const Triangle& t : t_)
      if (t[0] >= 0)
        for (std::size_t k = 0; k < 3; ++k) list.emplace_back(std::minmax(t[k], t[(k + 1) % 3]));
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

  static bool has(const Triangle& t, Index v) { return t[0] == v || t[1] == v || t[2] == v; }
  static Index third(const Triangle& t, Index a, Index b) {
    for (Index v : t)
      if (v != a && v != b) return v;
    return -1;
  }
  static bool walks(const Triangle& t, Index a, Index b) {
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] == a && t[(k + 1) % 3] == b) return true;
    return false;
  }

  // The triangles of an edge; -1 for a missing second.
  std::array<Index, 2> triangles_of(Index a, Index b) const {
    std::array<Index, 2> found{-1, -1};
    std::size_t n = 0;
    for (Index i : ring_[at(a)])
      if (has(t_[at(i)], b) && n < 2) found[n++] = i;
    return found;
  }

  std::vector<Index> neighbours(Index v) const {
    std::vector<Index> list;
    for (Index i : ring_[at(v)])
      for (Index w : t_[at(i)])
        if (w != v) list.push_back(w);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

  void unlink(Index vertex, Index triangle) {
    auto& ring = ring_[at(vertex)];
    ring.erase(std::find(ring.begin(), ring.end(), triangle));
  }
  void replace(Index triangle, Index from, Index to) {
    for (Index& v : t_[at(triangle)])
      if (v == from) v = to;
    unlink(from, triangle);
    ring_[at(to)].push_back(triangle);
  }
  void kill(Index triangle) {
    for (Index v : t_[at(triangle)]) unlink(v, triangle);
    t_[at(triangle)] = {-1, -1, -1};
  }

  static Vec3 normal(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

  Vec3 gradient(const Vec3& p) const {
    constexpr double h = 2e-4;
    Vec3 g;
    for (int d = 0; d < 3; ++d) {
      Vec3 up = p, down = p;
      up[d] += h;
      down[d] -= h;
      g[d] = (field_(up) - field_(down)) / (2 * h);
    }
    return g;
  }

  // Newton along the gradient, with steps that cannot leave the neighbourhood.
  Vec3 project(Vec3 p, bool border, int steps) const {
    for (int i = 0; i < steps; ++i) {
      Vec3 g = gradient(p);
      if (border) g.x() = 0;
      Vec3 step = field_(p) / std::max(g.dot(g), 0.05) * g;
      const double length = std::sqrt(step.dot(step));
      if (length > 5e-3) step *= 5e-3 / length;
      p -= step;
      if (border) p.x() = 0;
    }
    return p;
  }

  double length2(Index a, Index b) const { return (x_[at(a)] - x_[at(b)]).squaredNorm(); }

  void split_long() {
    for (const auto& [a, b] : edges()) {
      const Vec3 middle = 0.5 * (x_[at(a)] + x_[at(b)]);
      const double limit = 4.0 / 3.0 * edge_m_(middle);
      if (length2(a, b) <= limit * limit) continue;
      const auto pair = triangles_of(a, b);
      const bool border = pair[1] < 0;
      const Index m = static_cast<Index>(x_.size());
      x_.push_back(project(middle, border, 1));
      border_.push_back(border);
      ring_.emplace_back();
      for (Index i : pair) {
        if (i < 0) continue;
        Triangle half = t_[at(i)];
        for (Index& v : half)
          if (v == a) v = m;
        replace(i, b, m);  // keeps (a, m, c); the new one is (m, b, c)
        const Index added = static_cast<Index>(t_.size());
        t_.push_back(half);
        for (Index v : half) ring_[at(v)].push_back(added);
      }
    }
  }

  // Whether moving `moved` to `to` turns or squashes one of its triangles that do not also contain `other`.
  bool spoils(Index moved, Index other, const Vec3& to) const {
    for (Index i : ring_[at(moved)]) {
      const Triangle& t = t_[at(i)];
      if (has(t, other)) continue;
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = t[k] == moved ? to : x_[at(t[k])];
      const Vec3 before = normal(x_[at(t[0])], x_[at(t[1])], x_[at(t[2])]), after = normal(p[0], p[1], p[2]);
      const double cosine = before.dot(after), b2 = before.dot(before), a2 = after.dot(after);
      if (cosine <= 0 || cosine * cosine < 0.5 * b2 * a2) return true;
      const double longest =
          std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
      if (a2 < 0.03 * longest * longest) return true;  // height below 0.17 of the longest side
    }
    return false;
  }

  void collapse_short() {
    std::vector<std::tuple<double, Index, Index>> order;
    for (const auto& [a, b] : edges()) {
      const double limit = 0.8 * edge_m_(0.5 * (x_[at(a)] + x_[at(b)]));
      const double d2 = length2(a, b);
      if (d2 < limit * limit) order.emplace_back(d2, a, b);
    }
    std::sort(order.begin(), order.end());
    for (const auto& entry : order) {
      Index a = std::get<1>(entry), b = std::get<2>(entry);
      const auto pair = triangles_of(a, b);
      if (pair[0] < 0) continue;  // gone meanwhile
      const bool border_edge = pair[1] < 0;
      if (border_[at(a)] && border_[at(b)] && !border_edge) continue;  // would pinch the border
      const double limit = 0.8 * edge_m_(0.5 * (x_[at(a)] + x_[at(b)]));
      if (length2(a, b) >= limit * limit) continue;

      const std::vector<Index> na = neighbours(a), nb = neighbours(b);
      std::vector<Index> common;
      std::set_intersection(na.begin(), na.end(), nb.begin(), nb.end(), std::back_inserter(common));
      if (common.size() != (border_edge ? 1U : 2U)) continue;  // the link condition: the surface stays a surface
      // Opposite vertices lose a triangle; one left with two would join two triangles of the same corners.
      const auto exhausted = [&](Index v) { return ring_[at(v)].size() <= (border_[at(v)] ? 1U : 3U); };
      if (std::any_of(common.begin(), common.end(), exhausted)) continue;

      if (border_[at(b)] && !border_[at(a)]) std::swap(a, b);  // b goes, a stays; a border vertex stays where it is
      const bool fixed = border_[at(a)] && !border_edge;
      // The neighbours of b become those of a: two border vertices may be joined along the border only.
      const auto pinches = [&](Index v) {
        return v != a && border_[at(v)] && !std::binary_search(common.begin(), common.end(), v);
      };
      const std::vector<Index>& gained = b == std::get<2>(entry) ? nb : na;
      if (fixed && std::any_of(gained.begin(), gained.end(), pinches)) continue;
      const Vec3 to = fixed ? x_[at(a)] : project(0.5 * (x_[at(a)] + x_[at(b)]), border_edge, 1);
      if (spoils(a, b, to) || spoils(b, a, to)) continue;
      bool too_long = false;
      for (const auto* ring : {&na, &nb})
        for (Index v : *ring) {
          const double most = 4.0 / 3.0 * edge_m_(0.5 * (to + x_[at(v)]));
          too_long = too_long || (to - x_[at(v)]).squaredNorm() > most * most;
        }
      if (too_long) continue;
      x_[at(a)] = to;
      for (Index i : pair)
        if (i >= 0) kill(i);
      const std::vector<Index> moved = ring_[at(b)];
      for (Index i : moved) replace(i, b, a);
    }
  }

  int valence_error(Index v, int change) const {
    const int triangles = static_cast<int>(ring_[at(v)].size()), edges = triangles + (border_[at(v)] ? 1 : 0);
    const int error = edges + change - (border_[at(v)] ? 4 : 6);
    return error * error;
  }
  // How much flipping edge ab to cd lowers the sum of squared valence errors.
  int valence_gain(Index a, Index b, Index c, Index d) const {
    return valence_error(a, 0) + valence_error(b, 0) + valence_error(c, 0) + valence_error(d, 0) -
           valence_error(a, -1) - valence_error(b, -1) - valence_error(c, 1) - valence_error(d, 1);
  }

  double cosine_at(Index corner, Index p, Index q) const {
    const Vec3 u = x_[at(p)] - x_[at(corner)], v = x_[at(q)] - x_[at(corner)];
    return u.dot(v) / std::sqrt(u.dot(u) * v.dot(v));
  }
  // Negative when the angles at c and d, opposite to the edge ab, sum to more than 180 degrees: not Delaunay.
  double opposite_cosines(Index a, Index b, Index c, Index d) const { return cosine_at(c, a, b) + cosine_at(d, a, b); }

  template <class Wanted>
  void flip(Wanted&& wanted) {
    for (const auto& [a0, b0] : edges()) {
      Index a = a0, b = b0;
      const auto pair = triangles_of(a, b);
      if (pair[0] < 0 || pair[1] < 0) continue;
      Index left = pair[0], right = pair[1];
      if (!walks(t_[at(left)], a, b)) std::swap(left, right);
      const Index c = third(t_[at(left)], a, b), d = third(t_[at(right)], a, b);
      if (ring_[at(a)].size() <= 3 || ring_[at(b)].size() <= 3) continue;
      if (border_[at(c)] && border_[at(d)]) continue;  // an edge inside may not join two border vertices
      if (!wanted(a, b, c, d) || triangles_of(c, d)[0] >= 0) continue;
      // (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c).
      const Vec3 n0 = normal(x_[at(a)], x_[at(b)], x_[at(c)]), n1 = normal(x_[at(b)], x_[at(a)], x_[at(d)]);
      const Vec3 m0 = normal(x_[at(a)], x_[at(d)], x_[at(c)]), m1 = normal(x_[at(d)], x_[at(b)], x_[at(c)]);
      const Vec3 n = n0 + n1;
      const double n2 = n.dot(n);
      const auto good = [&](const Vec3& m) { return n.dot(m) > 0 && n.dot(m) * n.dot(m) > 0.6 * n2 * m.dot(m); };
      if (!good(m0) || !good(m1)) continue;
      const double diagonal = length2(c, d);
      if (std::min(m0.dot(m0), m1.dot(m1)) < 0.02 * diagonal * diagonal) continue;
      t_[at(left)] = {a, d, c};
      t_[at(right)] = {d, b, c};
      unlink(b, left);
      unlink(a, right);
      ring_[at(d)].push_back(left);
      ring_[at(c)].push_back(right);
    }
  }

  // One step of tangential smoothing for all vertices at once, then back onto the surface.
  void relax() {
    std::vector<Vec3> moved = x_;
    parallel_for(x_.size(), 256, [&](std::size_t i) {
      if (ring_[i].empty()) return;
      const Vec3& p = x_[i];
      const bool border = border_[i];
      Vec3 sum = Vec3::Zero();
      double weights = 0;
      for (Index k : ring_[i]) {
        const Triangle& t = t_[at(k)];
        const Vec3 centroid = (x_[at(t[0])] + x_[at(t[1])] + x_[at(t[2])]) / 3.0;
        const Vec3 n = normal(x_[at(t[0])], x_[at(t[1])], x_[at(t[2])]);
        const double size = edge_m_(centroid), weight = std::sqrt(n.dot(n)) / (size * size);
        sum += weight * centroid;
        weights += weight;
      }
      Vec3 to = sum / weights;
      Vec3 g = gradient(p);
      if (border) {  // the image half pulls equally hard the other way
        to.x() = 0;
        g.x() = 0;
      }
      to -= g.dot(to - p) / g.dot(g) * g;
      moved[i] = project(0.2 * p + 0.8 * to, border, 2);
    });
    x_ = std::move(moved);
  }

  const ScalarField& field_;
  const ScalarField& edge_m_;
  std::vector<Vec3> x_;
  std::vector<Triangle> t_;
  std::vector<std::vector<Index>> ring_;  // triangles of each vertex
  std::vector<char> border_;
};

}  // namespace

void remesh(HalfSurface& surface, const ScalarField& field, const ScalarField& edge_m, int sweeps) {
  Remesher remesher(surface, field, edge_m);
  for (int i = 0; i < sweeps; ++i) remesher.sweep();
  for (int i = 0; i < 6; ++i) remesher.polish();
  surface = remesher.take();
}

}  // namespace toile::internal
