// Impacts of a whole cloth: the same as asking every pair, whose they are, and who is left alone.
#include "contact/impacts.hpp"

#include "contact/ccd.hpp"
#include "contact/meshes.hpp"
#include "core/parallel.hpp"
#include "mesh/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace toile::internal {
namespace {

using contact_test::add_sheet;
using contact_test::Mesh;
using contact_test::Random;

struct Query {
  explicit Query(Mesh start_mesh, std::vector<Index> merged = {})
      : mesh(std::move(start_mesh)),
        topology(build_topology(static_cast<Index>(mesh.x.size()), mesh.triangles)),
        cloth(mesh.x.size(), mesh.triangles, topology, merged),
        tree(mesh.x, mesh.triangles),
        contact_m(mesh.x.size(), 2.5e-3) {}
  std::vector<Impact> operator()(const Vec3s& end) {
    std::vector<Impact> impacts;
    EXPECT_TRUE(find_impacts(cloth, tree, mesh.x, end, contact_m, workspace, impacts));
    return impacts;
  }
  Mesh mesh;
  Topology topology;
  ClothTopology cloth;
  TriangleTree tree;
  std::vector<double> contact_m;
  ImpactWorkspace workspace;
};

using Names = std::set<std::pair<ContactKind, std::array<Index, 4>>>;

// Every vertex with every face and every edge with every edge, no tree and no boxes.
Names every_pair(const Query& query, const Vec3s& end) {
  Names names;
  const Vec3s& x = query.mesh.x;
  const auto ask = [&](ContactKind kind, const std::array<Index, 4>& p) {
    const std::array<Vec3, 4> start{x[at(p[0])], x[at(p[1])], x[at(p[2])], x[at(p[3])]};
    std::array<Vec3, 4> u;
    for (std::size_t k = 0; k < 4; ++k) u[k] = end[at(p[k])] - start[k];
    const bool face = kind == ContactKind::vertex_face;
    const double d = std::sqrt(face ? closest_vertex_triangle(start[0], start[1], start[2], start[3]).distance2
                                    : closest_edge_edge(start[0], start[1], start[2], start[3]).distance2);
    const double xi = std::min(0.1 * 2.5e-3, 0.5 * d);
    if ((face ? vertex_face_impact(start, u, xi) : edge_edge_impact(start, u, xi)) <= 1) names.emplace(kind, p);
  };
  for (Index v = 0; v < static_cast<Index>(x.size()); ++v) {
    for (const Triangle& c : query.mesh.triangles)
      if (std::find(c.begin(), c.end(), v) == c.end()) ask(ContactKind::vertex_face, {v, c[0], c[1], c[2]});
  }
  const auto& edges = query.topology.edges;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t f = e + 1; f < edges.size(); ++f) {
      const std::set<Index> ends{edges[e].a, edges[e].b, edges[f].a, edges[f].b};
      if (ends.size() == 4) ask(ContactKind::edge_edge, {edges[e].a, edges[e].b, edges[f].a, edges[f].b});
    }
  }
  return names;
}

Names names_of(const std::vector<Impact>& impacts) {
  Names names;
  for (const Impact& impact : impacts) names.emplace(impact.kind, impact.particle);
  return names;
}

Mesh two_layers(double gap_m) {
  Mesh mesh;
  add_sheet(mesh, 5, 5, 0.01, Vec3(0, 0, 0));
  add_sheet(mesh, 5, 5, 0.01, Vec3(0.003, gap_m, 0.002));
  return mesh;
}

TEST(Impacts, AreThoseOfEveryPairAndEachOnce) {
  Random random(5);
  std::size_t total = 0;
  for (int round = 0; round < 40; ++round) {
    Query query(two_layers(random.in(2e-3, 8e-3)));
    Vec3s end = query.mesh.x;
    const double size = random.in(1e-3, 8e-3);
    for (Vec3& p : end) p += random.vector(size) + Vec3(0.02, 0.01, 0);
    const std::vector<Impact> impacts = query(end);
    const Names names = names_of(impacts);
    EXPECT_EQ(names.size(), impacts.size()) << "reported twice";
    EXPECT_EQ(names, every_pair(query, end));
    total += impacts.size();
  }
  EXPECT_GT(total, 500U);
}

TEST(Impacts, TellWhereThePairMeetsAndItsGapsAlongTheNormalAgree) {
  Query query(two_layers(4e-3));
  Vec3s end = query.mesh.x;
  for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i].y() -= 8e-3;
  const std::vector<Impact> impacts = query(end);
  ASSERT_FALSE(impacts.empty());
  for (const Impact& impact : impacts) {
    EXPECT_LT(impact.time, (4e-3 - 2.5e-4) / 8e-3);
    EXPECT_GT(impact.time, 0.4);
    EXPECT_NEAR(impact.start_gap_m, 4e-3, 1e-6);
    EXPECT_NEAR(impact.separation_m, 2.5e-4, 1e-12);
    EXPECT_NEAR(std::fabs(impact.normal.y()), 1, 1e-6);
    EXPECT_NEAR(impact.weight[0] + impact.weight[1] + impact.weight[2] + impact.weight[3], 0, 1e-12);
    double before = 0, after = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      before += impact.weight[k] * impact.normal.dot(query.mesh.x[at(impact.particle[k])]);
      after += impact.weight[k] * impact.normal.dot(end[at(impact.particle[k])]);
    }
    EXPECT_NEAR(before, 4e-3, 1e-6) << "the normal leads from the second feature to the first";
    EXPECT_NEAR(after, -4e-3, 1e-6);
    EXPECT_EQ(impact.time, impact_time(impact, query.mesh.x, end));
    EXPECT_EQ(impact_time(impact, query.mesh.x, query.mesh.x), no_impact);
  }
}

TEST(Impacts, LeaveParticlesWithoutADistanceAlone) {
  Query query(two_layers(4e-3));
  Vec3s end = query.mesh.x;
  for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i].y() -= 8e-3;
  query.contact_m[14] = 0;
  for (const Impact& impact : query(end)) EXPECT_EQ(std::count(impact.particle.begin(), impact.particle.end(), 14), 0);
  query.contact_m.assign(end.size(), 0);
  EXPECT_TRUE(query(end).empty());
}

TEST(Impacts, FeaturesThatASeamWillJoinMayMeet) {
  // Two triangles that close like a book along the edge they will share.
  Mesh mesh;
  mesh.x = {{0, 0, 0}, {0.01, 0, 0}, {0, 0, -0.01}, {0, 2e-3, 0}, {0.01, 2e-3, 0}, {0, 2e-3, 0.01}};
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}};
  Vec3s end = mesh.x;
  for (const std::size_t i : {3U, 4U}) end[i].y() = -1e-3;
  Query apart(mesh), sewn(mesh, {0, 1, 2, 0, 1, 5});
  EXPECT_FALSE(apart(end).empty());
  EXPECT_TRUE(sewn(end).empty());
}

TEST(Impacts, AreTheSameListOnAnyNumberOfThreads) {
  Mesh mesh;
  add_sheet(mesh, 40, 40, 0.01, Vec3(0, 0, 0));
  add_sheet(mesh, 40, 40, 0.01, Vec3(0.003, 4e-3, 0.002));
  Query query(mesh);
  Vec3s end = mesh.x;
  for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i].y() -= 8e-3;
  std::vector<std::vector<Impact>> lists;
  for (const int threads : {1, 2, 5}) with_threads(threads, [&] { lists.push_back(query(end)); });
  ASSERT_GT(lists[0].size(), 1000U);
  for (const auto& list : lists) {
    ASSERT_EQ(list.size(), lists[0].size());
    for (std::size_t i = 0; i < list.size(); ++i) {
      ASSERT_EQ(list[i].particle, lists[0][i].particle);
      ASSERT_EQ(list[i].time, lists[0][i].time);
    }
  }
}

TEST(Impacts, LayersNearerThanTheSeparationAreGuardedByHalfTheirGap) {
  Query query(two_layers(1e-4));  // xi would be 0.25 mm
  Vec3s end = query.mesh.x;
  const auto move = [&](double up_m) {
    for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i].y() = query.mesh.x[i].y() + up_m;
  };
  move(1e-4);
  EXPECT_TRUE(query(end).empty()) << "they move apart";
  move(-3e-5);
  EXPECT_TRUE(query(end).empty()) << "seven tenths of the gap are left";
  move(-1.3e-4);
  const std::vector<Impact> impacts = query(end);
  ASSERT_FALSE(impacts.empty());
  for (const Impact& impact : impacts) EXPECT_NEAR(impact.separation_m, 0.5 * impact.start_gap_m, 1e-15);
}

TEST(Impacts, HalfOfAGapMayGoDownToAMicrometre) {
  const auto separation = [](double gap_m) {
    const std::array<Vec3, 4> x = {Vec3(0.2, gap_m, 0.2), Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
    std::array<Vec3, 4> u = {Vec3(0, -2 * gap_m, 0), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    Impact impact{ContactKind::vertex_face, {0, 1, 2, 3}, {}, Vec3::Zero(), no_impact, 0, 2.5e-3, 0};
    EXPECT_TRUE(decide_impact(x, u, impact));
    return impact.separation_m;
  };
  EXPECT_NEAR(separation(1e-4), 5e-5, 1e-15);
  EXPECT_NEAR(separation(1.5e-6), 1e-6, 1e-15);
  EXPECT_NEAR(separation(1e-6), 0.999e-6, 1e-15);
  EXPECT_NEAR(separation(2e-7), 0.999 * 2e-7, 1e-15);
  EXPECT_NEAR(separation(5e-8), 2.5e-8, 1e-15) << "nearer than anything that we keep apart";
}

TEST(Impacts, FlatLayersThatEndNearerThanTheSeparationMeetThoughTheirWaysDoNot) {
  Query query(two_layers(4e-3));
  Vec3s end = query.mesh.x;
  for (std::size_t i = end.size() / 2; i < end.size(); ++i) end[i].y() = 2e-4;  // xi is 0.25 mm
  EXPECT_FALSE(query(end).empty());
}

TEST(Impacts, AWorkspaceOfAnotherClothIsAsGoodAsANewOne) {
  Mesh more = two_layers(4e-3);
  add_sheet(more, 5, 5, 0.01, Vec3(0.001, 8e-3, 0));
  Query small(two_layers(4e-3)), large(more);
  const auto turned_over = [](const Query& query) {
    Vec3s end = query.mesh.x;
    for (Vec3& p : end) p.y() *= -1;
    return end;
  };
  const Names expected = names_of(large(turned_over(large)));
  small(turned_over(small));
  large.workspace = small.workspace;
  EXPECT_EQ(names_of(large(turned_over(large))), expected);
}

}  // namespace
}  // namespace toile::internal
