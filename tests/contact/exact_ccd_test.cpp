// The oracle of continuous collision detection: cases whose truth is plain, and what must not change it.
#include "contact/exact_ccd.hpp"

#include "contact/ccd_queries.hpp"
#include "contact/touch_oracle.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

using namespace ccd_test;
using exact::Dyadic;
using exact::ExactTouch;
using exact::IntervalTouch;
using exact::UnitRoots;
using exact::Whole;
using exact::WholePolynomial;

WholePolynomial polynomial(std::initializer_list<std::int64_t> coefficients) {
  std::vector<Whole> c;
  for (const std::int64_t value : coefficients) c.emplace_back(value);
  return WholePolynomial(std::move(c));
}

TEST(ExactPolynomial, FindsEveryRootInTheOpenUnitIntervalOnce) {
  const auto roots = [](const WholePolynomial& f) { return UnitRoots(f).intervals().size(); };
  EXPECT_EQ(roots(polynomial({5})), 0);
  EXPECT_EQ(roots(polynomial({-1, 3})), 1);
  EXPECT_EQ(roots(polynomial({1, -4, 4})), 1);                        // (2t - 1)^2
  EXPECT_EQ(roots(polynomial({-3, 22, -48, 32})), 3);                 // 1/4, 1/2, 3/4: the first cuts are roots
  EXPECT_EQ(roots(polynomial({0, 1, -3, 2})), 1);                     // t (t - 1) (2t - 1): the ends do not count
  EXPECT_EQ(roots(polynomial({0, 0, 1})), 0);                         // t^2
  EXPECT_EQ(roots(polynomial({1, 0, 1})), 0);                         // none is real
  EXPECT_EQ(roots(polynomial({999'999, -3'999'998, 3'999'999})), 2);  // 1/2 apart from 1/2 by 1/4,000,000
}

TEST(ExactPolynomial, KnowsTheSignOfAnotherAtARoot) {
  const UnitRoots root(polynomial({-1, 0, 2}));  // sqrt(1/2)
  ASSERT_EQ(root.intervals().size(), 1);
  const auto sign = [&](const WholePolynomial& g) { return root.signs_of(g, root.intervals()[0]); };
  EXPECT_EQ(sign(polynomial({-707'106'781, 1'000'000'000})), 1);
  EXPECT_EQ(sign(polynomial({-707'106'782, 1'000'000'000})), -1);
  EXPECT_EQ(sign(polynomial({1, -3, -2, 6})), 0);  // (2t^2 - 1)(3t - 1)
  EXPECT_EQ(sign(polynomial({})), 0);
  const UnitRoots twice(polynomial({1, -4, 4}));
  EXPECT_EQ(twice.signs_of(polynomial({-1, 3}), twice.intervals()[0]), 1);
  EXPECT_EQ(twice.signs_of(polynomial({-1, 2}), twice.intervals()[0]), 0);
}

bool touch(Features features, std::array<Vec3, 4> start, std::array<Vec3, 4> end) {
  Motion motion(features);
  motion.start = start;
  motion.end = end;
  return ExactTouch(motion).touches();
}

const std::array<Vec3, 4> face{Vec3::Zero(), Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
bool vertex_at_face(const Vec3& from, const Vec3& to) {
  std::array<Vec3, 4> start = face, end = face;
  start[0] = from;
  end[0] = to;
  return touch(Features::vertex_face, start, end);
}

TEST(ExactTouch, IsRightAboutAVertexAndAFace) {
  EXPECT_TRUE(vertex_at_face({1, 1, 1}, {1, 1, -1}));
  EXPECT_FALSE(vertex_at_face({1, 1, 2}, {1, 1, 1}));
  EXPECT_TRUE(vertex_at_face({1, 1, 1}, {1, 1, 0}));   // only at t = 1
  EXPECT_TRUE(vertex_at_face({1, 1, 0}, {1, 1, 1}));   // only at t = 0
  EXPECT_TRUE(vertex_at_face({2, 2, 1}, {2, 2, -1}));  // through an edge
  EXPECT_FALSE(vertex_at_face({2, 2 + 0x1p-51, 1}, {2, 2 + 0x1p-51, -1}));
  EXPECT_TRUE(vertex_at_face({4, 0, 1}, {4, 0, -1}));  // through a corner
  EXPECT_FALSE(vertex_at_face({1, 1, 0x1p-60}, {2, 1, 0x1p-60}));
  EXPECT_TRUE(vertex_at_face({-1, 1, 0}, {9, 1, 0}));     // within the plane, across
  EXPECT_TRUE(vertex_at_face({-1, 5, 0}, {1, 3, 0}));     // ends on the edge
  EXPECT_TRUE(vertex_at_face({3, 5, 0}, {5, -5, 0}));     // within the plane, through the corner (4, 0)
  EXPECT_FALSE(vertex_at_face({3, 5, 0}, {5.5, -5, 0}));  // past it
}

TEST(ExactTouch, IsRightAboutDegenerateFaces) {
  const auto shrunk = [](const Vec3& b, const Vec3& c, const Vec3& from, const Vec3& to) {
    return touch(Features::vertex_face, {from, Vec3::Zero(), b, c}, {to, Vec3::Zero(), b, c});
  };
  EXPECT_TRUE(shrunk({4, 0, 0}, {2, 0, 0}, {3, 0, 1}, {3, 0, -1}));  // a line
  EXPECT_FALSE(shrunk({4, 0, 0}, {2, 0, 0}, {5, 0, 1}, {5, 0, -1}));
  EXPECT_TRUE(shrunk({0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, -1}));  // a point
  EXPECT_FALSE(shrunk({0, 0, 0}, {0, 0, 0}, {1, 0, 1}, {1, 0, -1}));
  EXPECT_TRUE(shrunk({4, 0, 0}, {2, 0, 0}, {9, 0, 0}, {3, 0, 0}));  // along the line
  EXPECT_FALSE(shrunk({4, 0, 0}, {2, 0, 0}, {9, 0, 0}, {5, 0, 0}));
  // Turned over within its plane: its area is 0 at t = 1/2, when the vertex is on the line beyond it.
  EXPECT_FALSE(touch(Features::vertex_face, {Vec3(5, 0, 1), Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)},
                     {Vec3(5, 0, -1), Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, -4, 0)}));
  EXPECT_TRUE(touch(Features::vertex_face, {Vec3(3, 0, 1), Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)},
                    {Vec3(3, 0, -1), Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, -4, 0)}));
}

TEST(ExactTouch, IsRightAboutTwoEdges) {
  const auto past = [](const Vec3& c, const Vec3& d, const Vec3& move) {  // an edge from -1 to 1 on the x axis
    return touch(Features::edge_edge, {Vec3(-1, 0, 0), Vec3(1, 0, 0), c, d},
                 {Vec3(-1, 0, 0), Vec3(1, 0, 0), c + move, d + move});
  };
  EXPECT_TRUE(past({0, -1, 1}, {0, 1, 1}, {0, 0, -2}));
  EXPECT_FALSE(past({0, -1, 2}, {0, 1, 2}, {0, 0, -1}));
  EXPECT_TRUE(past({1, -1, 1}, {1, 1, 1}, {0, 0, -2}));  // at an end
  EXPECT_FALSE(past({1 + 0x1p-52, -1, 1}, {1 + 0x1p-52, 1, 1}, {0, 0, -2}));
  EXPECT_TRUE(past({0, 0, 1}, {3, 0, 1}, {0, 0, -2}));   // parallel, side by side
  EXPECT_FALSE(past({2, 0, 1}, {3, 0, 1}, {0, 0, -2}));  // parallel, one behind the other
  EXPECT_FALSE(past({-1, 1, 0}, {1, 1, 0}, {5, 0, 0}));  // parallel, sliding
  EXPECT_TRUE(past({2, 0, 0}, {3, 0, 0}, {-9, 0, 0}));   // on one line, through each other
  EXPECT_FALSE(past({2, 0, 0}, {3, 0, 0}, {9, 0, 0}));
  EXPECT_TRUE(past({0.5, 0, 1}, {0.5, 0, 1}, {0, 0, -2}));  // a point
  EXPECT_FALSE(past({0.5, 1, 1}, {0.5, 1, 1}, {0, 0, -2}));
  EXPECT_TRUE(past({0, 0, 1}, {0, 0, 1}, {0, 0, -1}));  // a point, at t = 1
}

TEST(ExactTouch, IsRightAboutMotionsThatOnlyGraze) {
  // An edge along x; where the other, which turns as it passes, has z = 0 it is at y = beside - (2t - 1)^2.
  const auto graze = [](double beside) {
    return touch(Features::edge_edge, {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, beside + 1, -2), Vec3(0, beside - 1, 0)},
                 {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, beside - 1, 0), Vec3(0, beside + 1, 2)});
  };
  EXPECT_TRUE(graze(0));
  EXPECT_TRUE(graze(0x1p-40));
  EXPECT_FALSE(graze(-0x1p-40));
  // A vertex on a parabola over a tilting plane: p_z - plane = h - (2t - 1)^2.
  const auto parabola = [](double h) {
    return touch(Features::vertex_face, {Vec3(0, -1, h), Vec3(-9, -9, 9), Vec3(9, -9, 9), Vec3(0, 9, -9)},
                 {Vec3(0, 1, h), Vec3(-9, -9, -9), Vec3(9, -9, -9), Vec3(0, 9, 9)});
  };
  EXPECT_TRUE(parabola(0));
  EXPECT_TRUE(parabola(0x1p-40));
  EXPECT_FALSE(parabola(-0x1p-40));
  EXPECT_TRUE(parabola(1));  // at the two ends
  EXPECT_FALSE(parabola(1.5));
}

// Neither the intervals nor the direction of time, nor a turn of the axes, nor which feature comes first may matter.
TEST(ExactTouch, DoesNotDependOnTheWayItIsAsked) {
  int decided = 0;
  for (const Features features : {Features::vertex_face, Features::edge_edge}) {
    for (std::size_t kind = 0; kind < kind_count; ++kind) {
      Random random(77 + kind);
      for (int i = 0; i < 150; ++i) {
        const Motion motion = motion_of(random, features, static_cast<Kind>(kind));
        const bool truth = ExactTouch(motion).touches();
        if (const auto quick = IntervalTouch::touches(motion)) {
          ++decided;
          ASSERT_EQ(*quick, truth) << kind_name[kind] << ' ' << i;
        }
        Motion other = motion;
        std::swap(other.start, other.end);
        for (std::array<Vec3, 4>* const points : {&other.start, &other.end}) {
          for (Vec3& p : *points) p = Vec3(p.y(), p.z(), p.x());
          if (features == Features::edge_edge) {
            std::swap((*points)[0], (*points)[3]);
            std::swap((*points)[1], (*points)[2]);
          } else {
            std::swap((*points)[1], (*points)[3]);
          }
        }
        ASSERT_EQ(ExactTouch(other).touches(), truth) << kind_name[kind] << ' ' << i;
      }
    }
  }
  EXPECT_GT(decided, 2000);
}

}  // namespace
}  // namespace toile::internal
