// tests/contact/exact_ccd.hpp: do two moving features touch?  The truth that continuous collision detection is held to.
//
//   x_i(t) = a_i + t (b_i - a_i),  0 <= t <= 1,  a and b doubles;   touch: distance 0 at some t
//
// Every quantity below is a polynomial in t with whole coefficients, since doubles are whole numbers on one scale.
//
//   vertex p, face abc     coplanar  det = (a-p) . (b-p) x (c-p)                              a cubic
//                          inside    (b-p) x (c-p) . n >= 0 and so on around,  n = (b-a) x (c-a)
//   edges ab, cd           coplanar  det = (c-a) . m,   m = (b-a) x (d-c)
//                          inside    0 <= (c-a) x (d-c) . m <= m.m,   0 <= (c-a) x (b-a) . m <= m.m
//   n or m = 0             a triangle without area is its edges; parallel edges touch where an end lies on the other
//   p on ab                (a-p) x (b-p) = 0  and  (a-p) . (b-p) <= 0;  right for a = b too
//
// det not zero: they touch at 0, at 1, or at a root of det in between; signs at the root by Tarski's theorem.
// det zero throughout: the first touch is at 0, or a vertex is on an edge then (an interior one would have begun
// before), and that has its times among the roots of the quadratics of "p on ab".
//
// Slow: tenths of a millisecond on a lattice, several for arbitrary doubles.  touch_oracle.hpp puts intervals in front.
#pragma once
#include "support/interval.hpp"
#include "support/polynomial.hpp"

#include <vector>

namespace toile::internal::exact {

enum class Features { vertex_face, edge_edge };

struct Motion {
  explicit Motion(Features between) : features(between) {
    start.fill(Vec3::Zero());
    end = start;
  }
  Features features;
  std::array<Vec3, 4> start, end;  // the vertex and the face, or the edges 0 1 and 2 3
};

template <class Coefficient>
struct TouchConditions {
  Polynomial<Coefficient> coplanar;             // zero at a touch
  std::vector<Polynomial<Coefficient>> inside;  // none is negative at a touch; enough where `normal` is not zero
  Vector<Coefficient> normal;                   // n or m
};

template <class Coefficient>
TouchConditions<Coefficient> touch_conditions(Features features, const std::array<Vector<Coefficient>, 4>& x) {
  TouchConditions<Coefficient> result;
  if (features == Features::vertex_face) {
    const Vector<Coefficient> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const Vector<Coefficient> bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
    for (std::size_t k = 0; k < 3; ++k) result.normal[k] = ab[k] + bc[k] + ca[k];
    result.coplanar = dot(a, bc);
    result.inside = {dot(bc, result.normal), dot(ca, result.normal), dot(ab, result.normal)};
  } else {
    const Vector<Coefficient> first = x[1] - x[0], second = x[3] - x[2], between = x[2] - x[0];
    result.normal = cross(first, second);
    const Polynomial<Coefficient> whole = dot(result.normal, result.normal);
    const Polynomial<Coefficient> s = dot(cross(between, second), result.normal);
    const Polynomial<Coefficient> t = dot(cross(between, first), result.normal);
    result.coplanar = dot(between, result.normal);
    result.inside = {s, whole - s, t, whole - t};
  }
  return result;
}

// The exact way alone.
class ExactTouch {
 public:
  explicit ExactTouch(const Motion& motion) : features_(motion.features) {
    std::vector<Vec3> points(motion.start.begin(), motion.start.end());
    points.insert(points.end(), motion.end.begin(), motion.end.end());
    const std::vector<Point> whole = whole_points(points);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 3; ++k) x_[i][k] = WholePolynomial({whole[i][k], whole[i + 4][k] - whole[i][k]});
    conditions_ = touch_conditions(features_, x_);
  }

  bool touches() const {
    for (const std::int64_t t : {0, 1})
      if (touches_at([&](const WholePolynomial& g) { return sign_at(g, {Whole(t), 0}); })) return true;
    if (is_zero(conditions_.coplanar)) {
      for (const auto& [p, a, b] : ends_and_edges())
        if (meets_edge(p, a, b)) return true;
      return false;
    }
    return at_a_root(conditions_.coplanar, [&](const auto& sign) { return touches_at(sign); });
  }

 private:
  using Polynomials = Vector<Whole>;
  struct EndAndEdge {
    std::size_t p, a, b;
  };
  struct OnEdge {
    Polynomials aside;        // zero where p is on the line
    WholePolynomial between;  // not positive where it is between a and b then
  };

  std::vector<EndAndEdge> ends_and_edges() const {
    if (features_ == Features::vertex_face) return {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
    return {{0, 2, 3}, {1, 2, 3}, {2, 0, 1}, {3, 0, 1}};
  }
  OnEdge on_edge(std::size_t p, std::size_t a, std::size_t b) const {
    const Polynomials to_a = x_[a] - x_[p], to_b = x_[b] - x_[p];
    return {cross(to_a, to_b), dot(to_a, to_b)};
  }

  template <class Sign>
  static bool vanishes(const Polynomials& v, const Sign& sign) {
    return sign(v[0]) == 0 && sign(v[1]) == 0 && sign(v[2]) == 0;
  }
  template <class Sign>
  bool touches_at(const Sign& sign) const {
    if (sign(conditions_.coplanar) != 0) return false;
    if (!vanishes(conditions_.normal, sign))
      return std::all_of(conditions_.inside.begin(), conditions_.inside.end(),
                         [&](const WholePolynomial& g) { return sign(g) >= 0; });
    for (const auto& [p, a, b] : ends_and_edges()) {
      const OnEdge on = on_edge(p, a, b);
      if (vanishes(on.aside, sign) && sign(on.between) <= 0) return true;
    }
    return false;
  }

  // Is `holds` true at a root of f in (0, 1)?  It gets a function that tells the sign of a polynomial there.
  template <class Holds>
  static bool at_a_root(const WholePolynomial& f, Holds&& holds) {
    const UnitRoots roots(f);
    for (const RootInterval& in : roots.intervals())
      if (holds([&](const WholePolynomial& g) { return roots.signs_of(g, in); })) return true;
    return false;
  }

  // Is p on the edge at some time in (0, 1)?  At 0 and 1 it is not.
  bool meets_edge(std::size_t p, std::size_t a, std::size_t b) const {
    const OnEdge on = on_edge(p, a, b);
    const auto holds = [&](const auto& sign) { return vanishes(on.aside, sign) && sign(on.between) <= 0; };
    for (const WholePolynomial& f : on.aside)
      if (!is_zero(f)) return at_a_root(f, holds);
    // Always on the line, and outside a b at 0: it enters where `between` is zero.
    return !is_zero(on.between) && at_a_root(on.between, holds);
  }

  Features features_;
  std::array<Polynomials, 4> x_;
  TouchConditions<Whole> conditions_;
};

}  // namespace toile::internal::exact
