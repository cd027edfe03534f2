// Cloth against a moving body: the pairs found are those that trying every pair finds, and what is through is known.
#include "contact/body_impacts.hpp"

#include "support/bodies.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace toile::internal {
namespace {

using test::Random;

constexpr double r_m = 2.5e-3;

using Names = std::set<std::pair<ContactKind, std::array<Index, 4>>>;

struct Scene {
  explicit Scene(double above_m)
      : sheet(test::equilateral_sheet(0.12, 0.12, 0.015)),
        body(test::sphere(Vec3(0.06, -0.05, -0.06), 0.05, 3)),
        topology(build_topology(sheet.mesh.particle_count, sheet.mesh.triangles)),
        cloth(sheet.x.size(), sheet.mesh.triangles, topology),
        exempt(sheet.x.size(), 0) {
    for (Vec3& p : sheet.x) p.y() += above_m;
    tree = TriangleTree(sheet.x, sheet.mesh.triangles);
  }
  Names found(const Vec3s& end) {
    std::vector<Impact> impacts;
    EXPECT_TRUE(find_body_impacts(cloth, tree, sheet.x, end, {&body, r_m, exempt}, workspace, impacts));
    Names names;
    for (const Impact& impact : impacts) EXPECT_TRUE(names.emplace(impact.kind, impact.particle).second) << "twice";
    return names;
  }
  Names every_pair(const Vec3s& end) const {
    Names names;
    const auto n = static_cast<Index>(sheet.x.size());
    const auto ask = [&](ContactKind kind, const std::array<Index, 4>& particle) {
      std::array<Vec3, 4> x, u;
      for (std::size_t k = 0; k < 4; ++k) {
        const Index i = particle[k];
        x[k] = i < n ? sheet.x[at(i)] : body.positions()[at(i - n)];
        u[k] = i < n ? Vec3(end[at(i)] - x[k]) : body.vertex_travel(i - n);
      }
      Impact impact{kind, particle, {}, Vec3::Zero(), 0, 0, r_m, 0};
      if (decide_impact(x, u, impact)) names.emplace(kind, particle);
    };
    for (Index v = 0; v < n; ++v)
      for (const Triangle& t : body.triangles()) ask(ContactKind::vertex_face, {v, n + t[0], n + t[1], n + t[2]});
    for (Index v = 0; v < static_cast<Index>(body.positions().size()); ++v)
      for (const Triangle& t : sheet.mesh.triangles) ask(ContactKind::vertex_face, {n + v, t[0], t[1], t[2]});
    for (const Edge& e : topology.edges)
      for (const Edge& f : body.topology().edges) ask(ContactKind::edge_edge, {e.a, e.b, n + f.a, n + f.b});
    return names;
  }

  test::Sheet sheet;
  BodySurface body;
  Topology topology;
  ClothTopology cloth;
  TriangleTree tree;
  std::vector<char> exempt;
  BodyImpactWorkspace workspace;
};

TEST(BodyImpacts, AreThoseThatTryingEveryPairFinds) {
  std::size_t all = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Scene scene(4e-3);
    Random random(seed);
    // All of it moves far, the body as the cloth, and they move a little against each other.
    const Vec3 together = random.vector(0.1);
    Vec3s end = scene.sheet.x, body_end(scene.body.positions().begin(), scene.body.positions().end());
    for (Vec3& p : end) p += together + random.vector(seed % 2 == 0 ? 4e-3 : 0.02);
    for (Vec3& p : body_end) p += together + random.vector(1e-3);
    const Vec3s body_start(scene.body.positions().begin(), scene.body.positions().end());
    scene.body.set_motion(body_start, body_end);
    const Names expected = scene.every_pair(end);
    EXPECT_EQ(scene.found(end), expected) << "seed " << seed;
    all += expected.size();
  }
  EXPECT_GT(all, 100u);
}

// Impacts at one time are met in their order, so it must not be that of the body's tree.
TEST(BodyImpacts, ComeInAnOrderThatASolidFarAwayDoesNotChange) {
  Scene scene(4e-3);
  Random random(3);
  Vec3s end = scene.sheet.x;
  for (Vec3& p : end) p += Vec3(0, -0.02, 0) + random.vector(0.01);
  const auto impacts_with = [&](const BodySurface& body) {
    std::vector<Impact> impacts;
    EXPECT_TRUE(find_body_impacts(scene.cloth, scene.tree, scene.sheet.x, end, {&body, r_m, scene.exempt},
                                  scene.workspace, impacts));
    std::vector<std::pair<ContactKind, std::array<Index, 4>>> names;
    for (const Impact& impact : impacts) names.emplace_back(impact.kind, impact.particle);
    return names;
  };
  const auto alone = impacts_with(scene.body);
  ASSERT_GT(alone.size(), 50u);
  EXPECT_TRUE(std::is_sorted(alone.begin(), alone.end()));
  for (const double away_m : {-50.0, 3.0, 40.0}) {
    Vec3s x(scene.body.positions().begin(), scene.body.positions().end());
    std::vector<Triangle> triangles(scene.body.triangles().begin(), scene.body.triangles().end());
    const BodySurface far = test::sphere(Vec3(away_m, 2, 10), 1, 2);
    const auto first = static_cast<Index>(x.size());
    for (const Triangle& t : far.triangles()) triangles.push_back({first + t[0], first + t[1], first + t[2]});
    x.insert(x.end(), far.positions().begin(), far.positions().end());
    EXPECT_EQ(impacts_with(BodySurface(x, triangles)), alone) << away_m;
  }
}

TEST(BodyImpacts, LeaveOutWhatIsExempt) {
  Scene scene(4e-3);
  Vec3s end = scene.sheet.x;
  for (Vec3& p : end) p.y() -= 0.02;
  EXPECT_FALSE(scene.found(end).empty());
  scene.exempt.assign(scene.exempt.size(), 1);
  EXPECT_TRUE(scene.found(end).empty());
}

TEST(BodyImpacts, WhatIsThroughTheBodyIsMarked) {
  Scene above(4e-3), through(-6e-3);
  std::vector<char> marked;
  EXPECT_FALSE(mark_through_body(above.cloth, above.tree, above.sheet.x, above.body, above.workspace, marked));
  EXPECT_EQ(std::count(marked.begin(), marked.end(), 1), 0);
  EXPECT_TRUE(mark_through_body(through.cloth, through.tree, through.sheet.x, through.body, through.workspace, marked));
  // The sheet's plane cuts a circle of about 24 mm out of the ball: an edge's length around it, and nobody else.
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const Vec3 d = through.sheet.x[i] - Vec3(0.06, -6e-3, -0.06);
    const double off = std::abs(d.norm() - 0.0237);
    EXPECT_TRUE(marked[i] || off > 2e-3) << i;
    EXPECT_TRUE(!marked[i] || off < 0.016) << i;
  }
}

TEST(BodyImpacts, StopWhereThereAreMoreThanAreWorthCorrecting) {
  // Every particle to a place of its own far beyond the ball: every triangle of the cloth is dragged through every one of the ball.
  Scene scene(2e-3);
  scene.body = test::sphere(Vec3(0.06, -0.05, -0.06), 0.05, 4);
  Vec3s end = scene.sheet.x;
  test::Random random(3);
  for (Vec3& p : end) p = Vec3(0.06, -0.05, -0.06) + random.vector(10);
  std::vector<Impact> impacts;
  EXPECT_FALSE(find_body_impacts(scene.cloth, scene.tree, scene.sheet.x, end, {&scene.body, r_m, scene.exempt},
                                 scene.workspace, impacts));
  EXPECT_GT(impacts.size(), few_impacts);
  EXPECT_LT(impacts.size(), 10 * few_impacts);
}

}  // namespace
}  // namespace toile::internal
