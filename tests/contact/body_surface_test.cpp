#include "contact/body_surface.hpp"

#include "contact/distance.hpp"
#include "contact/meshes.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace toile::internal {
namespace {

using contact_test::Mesh;
using contact_test::Random;

// Sign by winding number and distance by trying every triangle.
void expect_nearest(const Mesh& mesh, const BodySurface& body, const Vec3& p) {
  double least2 = 1e300;
  for (const auto& [a, b, c] : mesh.triangles) {
    const VertexTriangle at =
        closest_vertex_triangle(p, mesh.x[static_cast<std::size_t>(a)], mesh.x[static_cast<std::size_t>(b)],
                                mesh.x[static_cast<std::size_t>(c)]);
    least2 = std::min(least2, at.distance2);
  }
  const BodyPoint found = body.nearest(p, 10);
  ASSERT_GE(found.triangle, 0);
  ASSERT_NEAR(std::fabs(found.gap_m), std::sqrt(least2), 1e-12);
  if (least2 > 1e-18) {
    const bool inside = contact_test::winding_number(mesh, p) > 0.5;
    ASSERT_EQ(found.gap_m < 0, inside) << "at " << p.transpose() << " gap " << found.gap_m;
  }
  ASSERT_NEAR(found.normal.norm(), 1, 1e-9);
  const Vec3 c = body.position(found.triangle, found.barycentric);
  ASSERT_LT((c + found.gap_m * found.normal - p).norm(), 1e-9);
}

// Points everywhere, and close to vertices and edges, where a wrong normal shows.
void expect_nearest_everywhere(const Mesh& mesh, Random& random, int count) {
  const BodySurface body(mesh.x, mesh.triangles);
  Vec3 low = mesh.x[0], high = mesh.x[0];
  for (const Vec3& p : mesh.x) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).norm();
  for (int n = 0; n < count; ++n) {
    Vec3 p;
    for (Eigen::Index k = 0; k < 3; ++k) p[k] = random.in(low[k] - 0.2 * size, high[k] + 0.2 * size);
    ASSERT_NO_FATAL_FAILURE(expect_nearest(mesh, body, p));
    const Vec3& vertex = mesh.x[static_cast<std::size_t>(random.below(static_cast<Index>(mesh.x.size())))];
    ASSERT_NO_FATAL_FAILURE(expect_nearest(mesh, body, vertex + random.vector(0.05 * size)));
    const Edge& e =
        body.topology().edges[static_cast<std::size_t>(random.below(static_cast<Index>(body.topology().edges.size())))];
    const Vec3 on_edge =
        mesh.x[static_cast<std::size_t>(e.a)] +
        random.unit() * (mesh.x[static_cast<std::size_t>(e.b)] - mesh.x[static_cast<std::size_t>(e.a)]);
    ASSERT_NO_FATAL_FAILURE(expect_nearest(mesh, body, on_edge + random.vector(0.02 * size)));
  }
}

TEST(BodySurface, KnowsInsideFromOutsideOnARoundBody) {
  Random random(1);
  expect_nearest_everywhere(contact_test::ball(16, 10, [](const Vec3&) { return 1.0; }), random, 500);
}

TEST(BodySurface, KnowsInsideFromOutsideInTheHoleOfATorus) {
  Random random(2);
  expect_nearest_everywhere(contact_test::torus(20, 12, 1, 0.4), random, 500);
}

TEST(BodySurface, KnowsInsideFromOutsideOnACubeAndAThinPlate) {
  Random random(3);
  expect_nearest_everywhere(contact_test::box({0, 0, 0}, {1, 1, 1}), random, 1000);
  expect_nearest_everywhere(contact_test::box({0, 0, 0}, {1, 0.01, 1}), random, 1000);
}

TEST(BodySurface, KnowsInsideFromOutsideAmongSpikesAndPits) {
  Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    Random bumps(static_cast<std::uint64_t>(100 + trial));
    const Mesh star =
        contact_test::ball(9, 7, [&](const Vec3&) { return bumps.unit() < 0.3 ? 1.5 : bumps.in(0.2, 0.5); });
    ASSERT_NO_FATAL_FAILURE(expect_nearest_everywhere(star, random, 100));
  }
}

// One broad face and a fan of slivers meet at the tip: counting or weighing faces by area leans to one side there.
TEST(BodySurface, WeighsFacesAtASharpTipByTheirAngles) {
  Random random(5);
  Mesh tip;
  constexpr int fan = 30;
  tip.x = {{0, 1, 0}, {0, 0, 0}};  // the tip and the middle of the base
  for (int i = 0; i < fan + 2; ++i) {
    const double u = i < 2 ? 2.6 * i : 2.6 + (2 * contact_test::pi - 2.6) * (i - 1) / (fan + 1);
    tip.x.push_back(Vec3(0.3 * std::cos(u), 0, -0.3 * std::sin(u)));
  }
  for (Index i = 0; i < fan + 2; ++i) {
    const Index a = 2 + i, b = 2 + (i + 1) % (fan + 2);
    tip.triangles.push_back({0, a, b});
    tip.triangles.push_back({1, b, a});
  }
  const BodySurface body(tip.x, tip.triangles);
  for (int n = 0; n < 20000; ++n) ASSERT_NO_FATAL_FAILURE(expect_nearest(tip, body, tip.x[0] + random.vector(0.1)));
}

TEST(BodySurface, AnswersOnTheSurfaceItself) {
  const Mesh mesh = contact_test::ball(12, 8, [](const Vec3&) { return 1.0; });
  const BodySurface body(mesh.x, mesh.triangles);
  for (std::size_t i = 0; i < mesh.x.size(); ++i) {
    const BodyPoint at = body.nearest(mesh.x[i], 0.1);
    ASSERT_GE(at.triangle, 0);
    EXPECT_EQ(at.gap_m, 0);
    EXPECT_GT(at.normal.dot(mesh.x[i]), 0.9);
  }
}

TEST(BodySurface, ReportsNothingBeyondReach) {
  const Mesh mesh = contact_test::box({0, 0, 0}, {1, 1, 1});
  const BodySurface body(mesh.x, mesh.triangles);
  EXPECT_EQ(body.nearest({0.5, 1.2, 0.5}, 0.19).triangle, -1);
  EXPECT_GE(body.nearest({0.5, 1.2, 0.5}, 0.21).triangle, 0);
  EXPECT_EQ(body.nearest({0.5, 0.5, 0.5}, 0.49).triangle, -1);
}

// Of what is equally near, that with the smallest number, however the tree is cut: a thing far away cuts it in another way.
TEST(BodySurface, IsTheSameBesideAThingFarAway) {
  const auto shifted = [](Mesh mesh, const Vec3& by) {
    for (Vec3& x : mesh.x) x += by;
    return mesh;
  };
  const Mesh ball = contact_test::ball(24, 12, [](const Vec3&) { return 1.0; });
  const BodySurface body(ball.x, ball.triangles);
  Random random(5);
  for (const Vec3& by : {Vec3(50, 0, 0), Vec3(-50, 3, 2), Vec3(0, 50, 1)}) {
    Mesh both = ball;
    const Mesh far = shifted(ball, by);
    const auto first = static_cast<Index>(both.x.size());
    both.x.insert(both.x.end(), far.x.begin(), far.x.end());
    for (const auto& [a, b, c] : far.triangles) both.triangles.push_back({a + first, b + first, c + first});
    const BodySurface beside(both.x, both.triangles);
    const auto expect_same = [&](const BodyPoint& a, const BodyPoint& b) {
      EXPECT_EQ(a.triangle, b.triangle);
      EXPECT_EQ(a.barycentric, b.barycentric);
      EXPECT_EQ(a.normal, b.normal);
      EXPECT_EQ(a.gap_m, b.gap_m);
    };
    for (int k = 0; k < 300; ++k) {
      Vec3 p = random.vector(2);
      if (k % 3 == 0) p[k / 3 % 3] = 0;  // between two sides
      if (k % 3 == 1)
        p = random.in(-2, 2) * ball.x[static_cast<std::size_t>(random.below(266))];  // nearest to a vertex
      if (k == 2) p = Vec3::Zero();
      expect_same(body.nearest(p, 3), beside.nearest(p, 3));
      expect_same(body.nearest_facing(p, Vec3(0, 1, 0), 3), beside.nearest_facing(p, Vec3(0, 1, 0), 3));
      expect_same(body.nearest_opposite(p, Vec3(0, 0, 1), 3), beside.nearest_opposite(p, Vec3(0, 0, 1), 3));
      EXPECT_EQ(body.winding_number(p), beside.winding_number(p));
    }
  }
}

TEST(BodySurface, FollowsTheMotionOfItsPoints) {
  const Mesh mesh = contact_test::torus(12, 8, 1, 0.3);
  BodySurface body(mesh.x, mesh.triangles);
  Vec3s start = mesh.x, end = mesh.x;
  const Vec3 shift(0.5, -0.2, 0.1);
  for (std::size_t i = 0; i < start.size(); ++i) {
    start[i] += shift;
    end[i] = start[i] + Vec3(-0.3 * start[i][2], 0.1, 0.3 * start[i][0]);
  }
  body.set_motion(start, end);
  const Vec3 barycentric(0.2, 0.3, 0.5);
  const Triangle& c = mesh.triangles[17];
  Vec3 now = Vec3::Zero(), next = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    now += barycentric[static_cast<Eigen::Index>(k)] * start[static_cast<std::size_t>(c[k])];
    next += barycentric[static_cast<Eigen::Index>(k)] * end[static_cast<std::size_t>(c[k])];
  }
  EXPECT_LT((body.position(17, barycentric) - now).norm(), 1e-15);
  EXPECT_LT((body.next_position(17, barycentric) - next).norm(), 1e-15);

  Random random(6);
  const Mesh moved{start, mesh.triangles};
  for (int n = 0; n < 500; ++n) {  // normals and nearest points are those of the start
    ASSERT_NO_FATAL_FAILURE(expect_nearest(moved, body, shift + random.vector(1.5)));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {  // the tree holds both ends
    const OuterBox& box = body.tree().triangle_box(static_cast<Index>(t));
    for (const Index i : mesh.triangles[t]) {
      for (const Vec3& p : {start[static_cast<std::size_t>(i)], end[static_cast<std::size_t>(i)]}) {
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_LE(static_cast<double>(box.low[k]), p[static_cast<Eigen::Index>(k)]);
          ASSERT_GE(static_cast<double>(box.high[k]), p[static_cast<Eigen::Index>(k)]);
        }
      }
    }
  }
  start.pop_back();
  EXPECT_THROW(body.set_motion(start, end), InputError);
}

// After motions of a few vertices each, all is as in a body that was made where this one is now.
TEST(BodySurface, IsTheSameWhateverOfItStoodStill) {
  const Mesh mesh = contact_test::torus(24, 16, 1, 0.3);
  const auto vertices = static_cast<Index>(mesh.x.size()), triangles = static_cast<Index>(mesh.triangles.size());
  BodySurface body(mesh.x, mesh.triangles);
  Random random(8);
  Vec3s start = mesh.x, end = mesh.x;
  for (int step = 0; step < 60; ++step) {
    start = end;
    const auto some = [&] { return static_cast<std::size_t>(random.below(vertices)); };
    const int moving = step % 4 == 3 ? 0 : step % 5;  // also none, once or twice in a row
    for (int n = 0; n < moving; ++n) end[some()] += random.vector(0.05);
    if (step % 7 == 0) start[some()] += random.vector(0.02);      // a jump between two steps, which is then taken back
    if (step % 7 == 3) end[0] = start[0] += random.vector(0.02);  // one that is no motion
    body.set_motion(start, end);
    if (step % 8 == 2) body.set_motion(start, end = start);  // it stays where it is after all
    if (step % 6 == 0) {                                     // tried again with a shorter step
      for (std::size_t i = 0; i < end.size(); ++i) end[i] = start[i] + 0.5 * (end[i] - start[i]);
      body.set_end(end);
    }
    const BodySurface fresh(start, mesh.triangles);
    for (Index i = 0; i < vertices; ++i) ASSERT_EQ(body.vertex_normal(i), fresh.vertex_normal(i)) << "step " << step;
    for (Index e = 0; e < static_cast<Index>(body.topology().edges.size()); ++e) {
      ASSERT_EQ(body.edge_normal(e), fresh.edge_normal(e)) << "step " << step;
      ASSERT_EQ(body.ridge_bend(e), fresh.ridge_bend(e)) << "step " << step;
    }
    TriangleTree whole_now = body.tree_now(), whole = body.tree();
    whole_now.refit(start, start, 0);
    if (step % 6 != 0) whole.refit(start, end, 0);
    for (Index t = 0; t < triangles; ++t) {
      ASSERT_EQ(body.face_normal(t), fresh.face_normal(t)) << "step " << step;
      ASSERT_EQ(body.owned_ridges(t), fresh.owned_ridges(t)) << "step " << step;
      ASSERT_EQ(body.tree().triangle_box(t).low, whole.triangle_box(t).low) << "step " << step;
      ASSERT_EQ(body.tree().triangle_box(t).high, whole.triangle_box(t).high) << "step " << step;
    }
    for (int n = 0; n < 20; ++n) {  // nodes above the triangles
      const Vec3 p = random.vector(1.3);
      const Box box{p - Vec3::Constant(0.1), p + Vec3::Constant(0.1)};
      std::vector<Index> met, expected;
      body.tree_now().overlapping(box, met);
      whole_now.overlapping(box, expected);
      ASSERT_EQ(met, expected) << "step " << step;
      body.tree().overlapping(box, met);
      whole.overlapping(box, expected);
      ASSERT_EQ(met, expected) << "step " << step;
    }
  }
}

TEST(BodySurface, TellsRidgesFromFlatAndHollowEdges) {
  // A cube: its twelve edges are ridges, the six diagonals flat.
  const Mesh cube = contact_test::box({0, 0, 0}, {1, 1, 1});
  const BodySurface body(cube.x, cube.triangles);
  int ridges = 0, flat = 0;
  for (Index e = 0; e < static_cast<Index>(body.topology().edges.size()); ++e) {
    const double bend = body.ridge_bend(e);
    if (bend > 0) {
      EXPECT_NEAR(bend, std::sqrt(2.0), 1e-12);
    }
    (bend > 0 ? ridges : flat) += 1;
  }
  EXPECT_EQ(ridges, 12);
  EXPECT_EQ(flat, 6);
  // Turned inside out every ridge is a hollow.
  Mesh hollow = cube;
  for (Triangle& c : hollow.triangles) std::swap(c[1], c[2]);
  const BodySurface inverted(hollow.x, hollow.triangles);
  for (Index e = 0; e < 18; ++e) EXPECT_EQ(inverted.ridge_bend(e), 0);
}

TEST(BodySurface, NormalsDoNotDependOnTheNumberOfThreads) {
  const Mesh mesh = contact_test::torus(90, 60, 1, 0.3);
  BodySurface one, many;
  with_threads(1, [&] { one = BodySurface(mesh.x, mesh.triangles); });
  for (const int threads : {2, 5}) {
    with_threads(threads, [&] { many = BodySurface(mesh.x, mesh.triangles); });
    for (Index i = 0; i < static_cast<Index>(mesh.x.size()); ++i)
      ASSERT_EQ(one.vertex_normal(i), many.vertex_normal(i));
    for (Index e = 0; e < static_cast<Index>(one.topology().edges.size()); ++e) {
      ASSERT_EQ(one.edge_normal(e), many.edge_normal(e));
    }
  }
}

Mesh read_body(const std::string& path) {
  Mesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vec3 p;
      words >> p[0] >> p[1] >> p[2];
      mesh.x.push_back(p);
    } else if (word == "f") {
      Triangle c;
      for (Index& i : c) {
        words >> word;
        i = std::stoi(word) - 1;
      }
      mesh.triangles.push_back(c);
    }
  }
  return mesh;
}

TEST(BodySurface, CountsThePartsThatAPointIsWithin) {
  // Two boxes that overlap, a room (a box that faces inwards) around nothing, and a torus through the first: points on a grid, so that
  // rays meet edges and vertices too.
  Mesh mesh = contact_test::box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  const auto add = [&](const Mesh& other, const Vec3& by, bool turned) {
    const auto first = static_cast<Index>(mesh.x.size());
    for (const Vec3& p : other.x) mesh.x.push_back(p + by);
    for (Triangle t : other.triangles) {
      if (turned) std::swap(t[0], t[1]);
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  };
  add(contact_test::box(Vec3(0, 0, 0), Vec3(1, 1, 1)), Vec3(0.5, 0.25, 0.125), false);
  add(contact_test::box(Vec3(0, 0, 0), Vec3(1, 1, 1)), Vec3(3, 0, 0), true);
  add(contact_test::torus(24, 12, 0.6, 0.2), Vec3(0.4, 0.4, 0.5), false);
  const BodySurface body(mesh.x, mesh.triangles);
  std::array<int, 5> seen{};
  for (double x = -0.9375; x < 4.2; x += 0.125) {
    for (double y = -0.9375; y < 1.5; y += 0.125) {
      for (double z = -0.4375; z < 1.5; z += 0.125) {
        const Vec3 p(x, y, z);
        const int expected = static_cast<int>(std::lround(contact_test::winding_number(mesh, p)));
        ASSERT_EQ(body.winding_number(p), expected) << p.transpose();
        ++seen.at(static_cast<std::size_t>(expected + 1));
      }
    }
  }
  for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_GT(seen[k], 10) << static_cast<int>(k) - 1;
  EXPECT_EQ(body.winding_number(Vec3(0.0625, 0.0625, 0.25)), 1) << "the ray meets an edge between two triangles";
}

TEST(BodySurface, KnowsInsideFromOutsideOnARealBody) {
  const Mesh mesh = read_body(test::shared_path("bodies/garmentcode/mean_all.obj"));
  if (mesh.triangles.empty()) GTEST_SKIP() << "no bodies/garmentcode/mean_all.obj in " << test::shared_path("");
  const BodySurface body(mesh.x, mesh.triangles);
  // The body runs into itself in a few places (fingers, lips): inside twice is inside, but then the nearest face may
  // be one of the buried ones.  So the winding number decides only where it is 0 or 1.
  Random random(7);
  int inside = 0, checked = 0;
  for (int n = 0; n < 400; ++n) {
    const auto v = static_cast<std::size_t>(random.below(static_cast<Index>(mesh.x.size())));
    const Vec3 p = mesh.x[v] + random.vector(0.01);
    const double winding = contact_test::winding_number(mesh, p);
    if (winding > 1.5 || winding < -0.5) continue;
    const BodyPoint at = body.nearest(p, 0.05);
    ASSERT_GE(at.triangle, 0);
    if (std::fabs(at.gap_m) < 1e-9) continue;
    EXPECT_EQ(at.gap_m<0, winding> 0.5) << "vertex " << v << " at " << p.transpose() << " gap " << at.gap_m;
    ++checked;
    inside += winding > 0.5;
  }
  EXPECT_GT(checked, 350);
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace toile::internal
