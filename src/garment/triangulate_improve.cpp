// garment/triangulate_improve.cpp: smoothing, and local changes tried on the worst triangles; see
// triangulate_improve.hpp.
//
// The quality of a triangle with longest edges a >= b >= c is (2 area / (a b))^2 = sin^2 of its smallest angle,
// lowered by (limit / a)^4 when a exceeds the size limit.  No roots and no angles: only the order matters.
#include "garment/triangulate_improve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {

namespace {

constexpr double good_angle_sin2 = 0.33;  // sin^2(35 degrees): triangles at least this good are left alone
constexpr double longest_ratio = 1.35;  // of the target edge: longer ones lower the quality, so that 1.5 is not passed
constexpr double least_gain = 1e-4;     // in quality; below it a change is not worth keeping
constexpr int rounds = 12;  // ordinary panels need two or three; a very fine side beside a coarse one uses them all

struct Plane {  // a point or vector in grid steps, with fractions
  double x = 0, y = 0;
};

// A needle's circumcentre can be anywhere.  Clamped to the predicates' range it is still outside, and refused as such.
GridPoint snapped(const Plane& p) {
  constexpr double most = (1 << 25) - 1;
  const auto snap = [most](double value) {
    return static_cast<std::int32_t>(std::lround(std::clamp(value, -most, most)));
  };
  return {snap(p.x), snap(p.y)};
}

// Relative to a.
Plane circumcentre_from(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const double bx = double(b.x) - a.x, by = double(b.y) - a.y, cx = double(c.x) - a.x, cy = double(c.y) - a.y;
  const double d = 2 * (bx * cy - by * cx), b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  return {(cy * b2 - by * c2) / d, (bx * c2 - cx * b2) / d};
}

class Improvement {
 public:
  Improvement(Delaunay& mesh, double edge) : mesh_(mesh), edge_(edge) {
    // An outline coarser than the target makes long edges that nothing can shorten; they must not hide other faults.
    double longest2 = edge * edge;
    const Index n = mesh.outline_count();
    for (Index i = 0; i < n; ++i)
      longest2 = std::max(longest2, double(squared_length(point(i), point(i + 1 == n ? 0 : i + 1))));
    limit2_ = longest_ratio * longest_ratio * longest2;
  }

  void run() {
    for (int round = 0; round < rounds; ++round) {
      const std::vector<Bad> bad = bad_faces();
      bool changed = false;
      for (const Bad& entry : bad) {
        const Delaunay::Face& face = mesh_.faces()[at(entry.face)];
        if (face.alive() && face.corner == entry.corner && mesh_.corners(face) == entry.corners)
          changed = better(entry.face) || changed;
      }
      if (!changed) break;
    }
  }

 private:
  struct Bad {
    double quality;
    Index face;
    Triangle corner;
    std::array<GridPoint, 3> corners;
  };

  const GridPoint& point(Index v) const { return mesh_.points()[at(v)]; }

  double quality(const GridPoint& a, const GridPoint& b, const GridPoint& c) const {
    const double twice_area = double(orient2d(a, b, c));
    if (twice_area <= 0) return 0;
    const double ab = double(squared_length(a, b)), bc = double(squared_length(b, c)),
                 ca = double(squared_length(c, a));
    const double shortest = std::min({ab, bc, ca}), longest = std::max({ab, bc, ca});
    const double sin2 = twice_area * twice_area * shortest / (ab * bc * ca);
    const double excess = limit2_ / longest;
    return excess < 1 ? sin2 * excess * excess : sin2;
  }
  double quality(Index f) const {
    const auto [a, b, c] = mesh_.corners(mesh_.faces()[at(f)]);
    return quality(a, b, c);
  }

  std::vector<Bad> bad_faces() const {
    std::vector<Bad> bad;
    for (std::size_t f = 0; f < mesh_.faces().size(); ++f) {
      const Delaunay::Face& face = mesh_.faces()[f];
      if (!face.alive()) continue;
      const double q = quality(static_cast<Index>(f));
      if (q < good_angle_sin2) bad.push_back({q, static_cast<Index>(f), face.corner, mesh_.corners(face)});
    }
    std::sort(bad.begin(), bad.end(), [](const Bad& a, const Bad& b) {
      return a.quality != b.quality ? a.quality < b.quality : a.face < b.face;
    });
    return bad;
  }

  // One change at a time, the gentlest first.
  bool better(Index f) {
    const Triangle corner = mesh_.faces()[at(f)].corner;
    if (attempt([&] { return true; }, corner)) return true;
    for (const Index v : corner)
      if (!mesh_.on_outline(v) && attempt([&] { return mesh_.remove(v), true; }, corner)) return true;
    for (const Plane& place : places_to_insert(f))
      if (attempt([&] { return add(place, f); }, corner)) return true;
    return false;
  }

  std::vector<Plane> places_to_insert(Index f) const {
    const auto [a, b, c] = mesh_.corners(mesh_.faces()[at(f)]);
    std::vector<Plane> places;
    const Plane centre = circumcentre_from(a, b, c);
    if (centre.x * centre.x + centre.y * centre.y < 9 * edge_ * edge_)
      places.push_back({a.x + centre.x, a.y + centre.y});
    const std::array<std::array<GridPoint, 2>, 3> sides{{{a, b}, {b, c}, {c, a}}};
    const auto longest = std::max_element(sides.begin(), sides.end(), [](const auto& s, const auto& t) {
      return squared_length(s[0], s[1]) < squared_length(t[0], t[1]);
    });
    places.push_back(
        {0.5 * ((*longest)[0].x + double((*longest)[1].x)), 0.5 * ((*longest)[0].y + double((*longest)[1].y))});
    places.push_back({(double(a.x) + b.x + c.x) / 3, (double(a.y) + b.y + c.y) / 3});
    return places;
  }

  bool add(const Plane& place, Index start) {
    const GridPoint p = snapped(place);
    const Index f = mesh_.walk(p, start);
    return f != Delaunay::none && mesh_.insert(p, f) != Delaunay::none;
  }

  // Makes the change, relaxes the faces that it changed, and keeps the result only if it is better.
  template <class Change>
  bool attempt(const Change& change, const Triangle& corner) {
    mesh_.begin();
    if (change()) {
      relax(corner);
      if (is_better()) {
        mesh_.commit();
        return true;
      }
    }
    mesh_.roll_back();
    return false;
  }

  // Moves the inner vertices of the faces changed so far (and of the triangle at the centre) to the best place in
  // their star.
  void relax(const Triangle& centre) {
    movable_.clear();
    for (const Index v : centre) movable_.push_back(v);
    for (const Delaunay::Changed& changed : mesh_.changed())
      for (const Index v : mesh_.faces()[at(changed.face)].corner) movable_.push_back(v);
    for (std::size_t f = at(mesh_.face_count_at_begin()); f < mesh_.faces().size(); ++f)
      for (const Index v : mesh_.faces()[f].corner) movable_.push_back(v);
    std::sort(movable_.begin(), movable_.end());
    movable_.erase(std::unique(movable_.begin(), movable_.end()), movable_.end());
    std::erase_if(movable_, [&](Index v) { return v < 0 || mesh_.on_outline(v) || !mesh_.alive(v); });
    for (int pass = 0; pass < 2; ++pass)
      for (const Index v : movable_)
        if (climb(v)) mesh_.legalize_around(v);
  }

  double worst_of_star(const GridPoint& p) const {
    double worst = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < link_.size(); ++i)
      worst = std::min(worst, quality(p, link_[i], link_[i + 1 == link_.size() ? 0 : i + 1]));
    return worst;
  }

  // Pattern search in six directions for the place where the worst triangle of the star is best.
  bool climb(Index v) {
    mesh_.star(v, star_);
    link_.clear();
    for (const Index f : star_) {
      const Triangle& corner = mesh_.faces()[at(f)].corner;
      link_.push_back(point(corner[0] == v ? corner[1] : corner[1] == v ? corner[2] : corner[0]));
    }
    GridPoint best = point(v);
    double worst = worst_of_star(best);
    if (worst >= good_angle_sin2) return false;
    constexpr double half_sqrt3 = 0.86602540378443865;
    constexpr std::array<Plane, 6> directions{
        {{1, 0}, {0.5, half_sqrt3}, {-0.5, half_sqrt3}, {-1, 0}, {-0.5, -half_sqrt3}, {0.5, -half_sqrt3}}};
    for (double step = 0.2 * edge_; step > 0.01 * edge_;) {
      GridPoint candidate = best;
      double candidate_worst = worst;
      for (const Plane& direction : directions) {
        const GridPoint p = snapped({best.x + step * direction.x, best.y + step * direction.y});
        if (const double q = worst_of_star(p); q > candidate_worst) candidate = p, candidate_worst = q;
      }
      if (candidate == best) step *= 0.5;
      best = candidate;
      worst = candidate_worst;
      if (worst >= good_angle_sin2) break;
    }
    return !(best == point(v)) && mesh_.move(v, best);
  }

  // The changed triangles' qualities, worst first and cut off at "good", compared like words in a dictionary: an
  // unavoidable bad triangle (the tip of a spike) on both sides does not decide.
  bool is_better() {
    before_.clear();
    after_.clear();
    for (const Delaunay::Changed& changed : mesh_.changed()) {
      if (changed.before.alive()) {
        const auto& [a, b, c] = changed.corners_before;
        if (const double q = quality(a, b, c); q < good_angle_sin2) before_.push_back(q);
      }
      add_after(changed.face);
    }
    for (std::size_t f = at(mesh_.face_count_at_begin()); f < mesh_.faces().size(); ++f)
      add_after(static_cast<Index>(f));
    std::sort(before_.begin(), before_.end());
    std::sort(after_.begin(), after_.end());
    for (std::size_t i = 0; i < before_.size(); ++i) {
      if (i == after_.size() || after_[i] > before_[i] + least_gain) return true;
      if (after_[i] < before_[i] - least_gain) return false;
    }
    return false;
  }
  void add_after(Index f) {
    if (!mesh_.faces()[at(f)].alive()) return;
    if (const double q = quality(f); q < good_angle_sin2) after_.push_back(q);
  }

  Delaunay& mesh_;
  double edge_;
  double limit2_ = 0;
  std::vector<Index> movable_, star_;
  std::vector<GridPoint> link_;
  std::vector<double> before_, after_;
};

}  // namespace

void smooth(Delaunay& mesh, int sweeps) {
  std::vector<Index> star;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Index v = mesh.outline_count(); v < static_cast<Index>(mesh.points().size()); ++v) {
      if (!mesh.alive(v)) continue;
      mesh.star(v, star);
      const GridPoint here = mesh.points()[at(v)];
      Plane sum;
      double area = 0;
      for (const Index f : star) {
        const auto [a, b, c] = mesh.corners(mesh.faces()[at(f)]);
        const double weight = double(orient2d(a, b, c));
        const Plane centre = circumcentre_from(a, b, c);
        // From v rather than from a corner, and from the grid's integers: no loss for panels far from the centre.
        sum.x += weight * (centre.x + (double(a.x) - here.x));
        sum.y += weight * (centre.y + (double(a.y) - here.y));
        area += weight;
      }
      for (const double part : {1.0, 0.5, 0.25})
        if (mesh.move(v, snapped({here.x + part * sum.x / area, here.y + part * sum.y / area}))) break;
    }
    mesh.legalize();
  }
}

void improve(Delaunay& mesh, double edge) { Improvement(mesh, edge).run(); }

}  // namespace toile::internal
