#include "contact/meshes.hpp"
#include "contact/proximity.hpp"
#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace toile::internal {
namespace {

using contact_test::Mesh;
using contact_test::Random;

struct Scene {
  Mesh cloth;
  Topology topology;
  BodySurface body;
  Scene(Mesh c, const Mesh& b)
      : cloth(std::move(c)),
        topology(build_topology(static_cast<Index>(cloth.x.size()), cloth.triangles)),
        body(b.x, b.triangles) {}
  std::vector<BodyContact> contacts(const ProximityOptions& options) const {
    static ProximityWorkspace workspace;
    const ClothTopology features(cloth.x.size(), cloth.triangles, topology);
    std::vector<BodyContact> list;
    TriangleTree tree(cloth.x, cloth.triangles);
    find_body_contacts(features, tree, cloth.x, body, options, workspace, list);
    return list;
  }
};

struct Key {
  ContactKind kind;
  std::array<Index, 2> body;
  std::array<Index, 3> cloth;
  auto operator<=>(const Key&) const = default;
};

// The rules of proximity.hpp by trying everything.
std::map<Key, Vec3> reference(const Scene& scene, const ProximityOptions& options) {
  std::map<Key, Vec3> records;  // gap * normal
  const auto x = [&](Index i) -> const Vec3& { return scene.cloth.x[static_cast<std::size_t>(i)]; };
  const auto y = [&](Index i) -> const Vec3& { return scene.body.positions()[static_cast<std::size_t>(i)]; };
  // +1 outside, -1 inside, 0: no record
  const auto side = [&](const Vec3& cloth_point, const Vec3& between, const Vec3& out) {
    const double d = between.norm(), cosine = between.dot(out) / d;
    if (std::fabs(cosine) < 0.1) return 0;
    if (cosine > 0) return d < options.range_m ? 1 : 0;
    const BodyPoint at = scene.body.nearest(cloth_point, 1);
    return d < options.depth_m && at.gap_m < 0 && at.normal.dot(-between) > 0 ? -1 : 0;
  };
  for (Index v = 0; v < static_cast<Index>(scene.body.positions().size()); ++v) {
    for (const Triangle& c : scene.cloth.triangles) {
      const VertexTriangle at = closest_vertex_triangle(y(v), x(c[0]), x(c[1]), x(c[2]));
      if (at.feature != Feature::face) continue;
      const Vec3 point = at.barycentric[0] * x(c[0]) + at.barycentric[1] * x(c[1]) + at.barycentric[2] * x(c[2]);
      if (side(point, point - y(v), scene.body.vertex_normal(v)) == 0) continue;
      records[{ContactKind::vertex_face, {v, -1}, c}] = point - y(v);
    }
  }
  for (Index e = 0; e < static_cast<Index>(scene.body.topology().edges.size()); ++e) {
    const Edge& ridge = scene.body.topology().edges[static_cast<std::size_t>(e)];
    const auto opposite = [&](const auto& mesh_x, const Triangle& c, const Edge& edge) {
      for (const Index i : c) {
        if (i != edge.a && i != edge.b) return mesh_x(i);
      }
      return Vec3(0, 0, 0);
    };
    for (const Edge& edge : scene.topology.edges) {
      const EdgeEdge at = closest_edge_edge(x(edge.a), x(edge.b), y(ridge.a), y(ridge.b));
      if (!at.interior) continue;
      const Vec3 n0 = scene.body.face_normal(ridge.triangle[0]), n1 = scene.body.face_normal(ridge.triangle[1]);
      const Vec3 across = opposite(y, scene.body.triangle(ridge.triangle[1]), ridge) - y(ridge.a);
      if (across.dot(n0) >= 0) continue;  // hollow
      if ((n0 - n1).norm() * (x(edge.b) - x(edge.a)).norm() / 4 <= 0.1 * options.range_m) continue;
      const Vec3 point = (1 - at.s) * x(edge.a) + at.s * x(edge.b);
      const Vec3 between = point - (1 - at.t) * y(ridge.a) - at.t * y(ridge.b);
      const int s = side(point, between, scene.body.edge_normal(e));
      if (s == 0) continue;
      const Vec3 normal = s * between.normalized();
      const auto leans = [](const Vec3& u, const Vec3& a, const Vec3& b, const Vec3& c) {
        const Vec3 along = (b - a).normalized();
        return u.dot(((c - a) - (c - a).dot(along) * along).normalized()) > 0.1;
      };
      bool leaves = true;
      for (const Index t : ridge.triangle) {
        leaves = leaves && !leans(normal, y(ridge.a), y(ridge.b), opposite(y, scene.body.triangle(t), ridge));
      }
      for (const Index t : edge.triangle) {
        if (t < 0) continue;
        leaves = leaves && !leans(-normal, x(edge.a), x(edge.b),
                                  opposite(x, scene.cloth.triangles[static_cast<std::size_t>(t)], edge));
      }
      if (leaves) records[{ContactKind::edge_edge, {ridge.a, ridge.b}, {edge.a, edge.b, -1}}] = between;
    }
  }
  return records;
}

TEST(BodyContacts, MatchTheRulesOnAThousandRandomFrames) {
  Random random(1);
  std::map<ContactKind, int> outside, inside;
  for (int frame = 0; frame < 1000; ++frame) {
    SCOPED_TRACE(frame);
    const double rough = random.in(0, 0.4);
    Mesh body = contact_test::ball(7, 5, [&](const Vec3&) { return 0.03 * random.in(1 - rough, 1); });
    Mesh cloth;
    const double bottom = random.in(-0.005, 0.035);
    contact_test::add_sheet(cloth, 4, 4, random.in(0.006, 0.015), Vec3(-0.025, bottom, -0.025));
    const double height = random.in(0, 0.006);
    for (Vec3& p : cloth.x) {
      const double z = random.in(-1e-3, 1e-3), y = random.in(-height, height), x = random.in(-1e-3, 1e-3);
      p += Vec3(x, y, z);
    }
    const Scene scene(std::move(cloth), body);
    const ProximityOptions options{random.in(2e-3, 8e-3), random.in(2e-3, 12e-3)};
    const auto expected = reference(scene, options);
    const auto contacts = scene.contacts(options);
    std::map<Key, int> found;
    for (const BodyContact& contact : contacts) {
      const Key key{contact.kind, contact.body_vertex, contact.particle};
      ASSERT_EQ(++found[key], 1) << "doubled";
      ASSERT_TRUE(expected.count(key)) << "kind " << int(contact.kind) << " body " << contact.body_vertex[0] << " gap "
                                       << contact.gap_m;
      // sum w x - body point = gap * normal
      Vec3 between = Vec3::Zero();
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        sum += contact.weight[k];
        if (contact.particle[k] >= 0)
          between += contact.weight[k] * scene.cloth.x[static_cast<std::size_t>(contact.particle[k])];
      }
      const auto y = scene.body.positions();
      between -= (1 - contact.body_parameter) * y[static_cast<std::size_t>(contact.body_vertex[0])];
      if (contact.body_vertex[1] >= 0)
        between -= contact.body_parameter * y[static_cast<std::size_t>(contact.body_vertex[1])];
      ASSERT_NEAR(sum, 1, 1e-14);
      ASSERT_NEAR(contact.normal.norm(), 1, 1e-12);
      ASSERT_LT((between - contact.gap_m * contact.normal).norm(), 1e-12);
      ASSERT_LT((between - expected.at(key)).norm(), 1e-12);
      ++(contact.gap_m < 0 ? inside : outside)[contact.kind];
    }
    ASSERT_EQ(found.size(), expected.size()) << "missed";
  }
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    EXPECT_GT(outside[kind], 300);
    EXPECT_GT(inside[kind], 100);
  }
}

TEST(BodyContacts, ASpikeThroughAFacePushesTheClothBackOut) {
  Mesh cloth;
  contact_test::add_sheet(cloth, 1, 1, 0.02, Vec3(-0.012, 0.01, -0.006));
  Mesh spike;  // its tip reaches 3 mm above the cloth
  spike.x = {{0, 0.013, 0}, {0.01, -0.02, 0.01}, {0.01, -0.02, -0.01}, {-0.012, -0.02, 0}};
  spike.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const Scene scene(std::move(cloth), spike);
  const auto contacts = scene.contacts({5e-3, 10e-3});
  const auto tip = std::find_if(contacts.begin(), contacts.end(),
                                [](const BodyContact& c) { return c.body_vertex[0] == 0 && c.body_vertex[1] < 0; });
  ASSERT_NE(tip, contacts.end());
  EXPECT_NEAR(tip->gap_m, -0.003, 1e-12);
  EXPECT_LT((tip->normal - Vec3(0, 1, 0)).norm(), 1e-12);
  for (const BodyContact& contact : scene.contacts({5e-3, 2e-3})) EXPECT_GT(contact.gap_m, -2e-3);
}

TEST(BodyContacts, TheFarSideOfAThinPartDoesNotPullClothThroughIt) {
  // A 4 mm plate with a fine grid of vertices below; cloth 1 mm above it: 5 mm from the lower vertices, depth 10 mm.
  Mesh plate = contact_test::ball(24, 16, [](const Vec3&) { return 1.0; });
  for (Vec3& p : plate.x) p = Vec3(0.05 * p[0], 0.002 * p[1], 0.05 * p[2]);
  Mesh cloth;
  contact_test::add_sheet(cloth, 8, 8, 0.01, Vec3(-0.04, 0.003, -0.035));
  const Scene scene(std::move(cloth), plate);
  const auto contacts = scene.contacts({5e-3, 10e-3});
  EXPECT_GT(contacts.size(), 50u);
  for (const BodyContact& contact : contacts) {
    EXPECT_GT(contact.gap_m, 0);
    EXPECT_GT(contact.normal[1], 0);
  }
}

TEST(BodyContacts, AClothEdgeOverTheEdgeOfATableIsHeld) {
  const Mesh table = contact_test::box({-0.5, -1, -0.5}, {0.5, 0, 0.5});
  Mesh cloth;  // one edge runs obliquely over the table's edge x = 0.5, y = 0; its ends hang free of it
  cloth.x = {{0.49, 0.012, 0.003}, {0.512, -0.01, 0.011}, {0.53, 0.03, 0.01}};
  cloth.triangles = {{0, 2, 1}};
  const Scene scene(std::move(cloth), table);
  const auto contacts = scene.contacts({5e-3, 10e-3});
  ASSERT_EQ(contacts.size(), 1u);
  const BodyContact& contact = contacts[0];
  EXPECT_EQ(contact.kind, ContactKind::edge_edge);
  EXPECT_EQ(contact.particle, (std::array<Index, 3>{0, 1, -1}));
  EXPECT_GT(contact.gap_m, 0);
  EXPECT_GT(contact.normal[0], 0.5);
  EXPECT_GT(contact.normal[1], 0.5);
  EXPECT_NEAR(contact.normal[2], 0, 1e-12);  // perpendicular to the table's edge

  // The same edge 2 mm further in: it cuts the corner.
  Mesh inside = scene.cloth;
  for (Vec3& p : inside.x) p -= Vec3(0.0022, 0.0022, 0);
  const auto penetrating = Scene(std::move(inside), table).contacts({5e-3, 10e-3});
  ASSERT_EQ(penetrating.size(), 1u);
  EXPECT_LT(penetrating[0].gap_m, 0);
  EXPECT_LT((penetrating[0].normal - contact.normal).norm(), 1e-9);
}

TEST(BodyContacts, FlatGroundHasNoEdgeRows) {
  const Mesh table = contact_test::box({-0.5, -1, -0.5}, {0.5, 0, 0.5});
  Mesh cloth;  // over the diagonal of the table's top
  contact_test::add_sheet(cloth, 10, 10, 0.01, Vec3(-0.05, 0.002, -0.05));
  EXPECT_TRUE(Scene(std::move(cloth), table).contacts({5e-3, 10e-3}).empty());
}

TEST(BodyContacts, TouchingClothTakesTheBodysNormal) {
  Mesh tip;
  tip.x = {{0, 0, 0}, {0.02, -0.02, 0.01}, {-0.02, -0.02, 0.01}, {0, -0.02, -0.02}};
  tip.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  Mesh cloth;
  contact_test::add_sheet(cloth, 1, 1, 0.02, Vec3(-0.012, 0, -0.006));
  const Scene scene(std::move(cloth), tip);
  const auto contacts = scene.contacts({5e-3, 10e-3});
  const auto at = std::find_if(contacts.begin(), contacts.end(),
                               [](const BodyContact& c) { return c.body_vertex[0] == 0 && c.body_vertex[1] < 0; });
  ASSERT_NE(at, contacts.end());
  EXPECT_NEAR(at->gap_m, 0, 1e-12);
  EXPECT_EQ(at->normal, scene.body.vertex_normal(0));
}

TEST(BodyContacts, TheListDoesNotDependOnTheNumberOfThreads) {
  const Mesh body = contact_test::torus(60, 40, 0.2, 0.08);
  Mesh cloth;
  contact_test::add_sheet(cloth, 50, 50, 0.01, Vec3(-0.25, 0.081, -0.22));
  for (Vec3& p : cloth.x)
    p[1] = 0.003 + 0.08 * std::sqrt(std::max(0.0, 1 - std::pow((std::hypot(p[0], p[2]) - 0.2) / 0.08, 2)));
  const Scene scene(std::move(cloth), body);
  std::vector<BodyContact> one, many;
  with_threads(1, [&] { one = scene.contacts({}); });
  ASSERT_GT(one.size(), 500u);
  for (const int threads : {2, 5}) {
    with_threads(threads, [&] { many = scene.contacts({}); });
    ASSERT_EQ(one.size(), many.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      ASSERT_EQ(one[i].kind, many[i].kind);
      ASSERT_EQ(one[i].particle, many[i].particle);
      ASSERT_EQ(one[i].body_vertex, many[i].body_vertex);
      ASSERT_EQ(one[i].weight, many[i].weight);
      ASSERT_EQ(one[i].normal, many[i].normal);
      ASSERT_EQ(one[i].gap_m, many[i].gap_m);
    }
  }
}

}  // namespace
}  // namespace toile::internal
