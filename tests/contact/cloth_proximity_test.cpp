#include "contact/meshes.hpp"
#include "contact/proximity.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace toile::internal {
namespace {

using contact_test::Mesh;
using contact_test::Random;
using Key = std::pair<ContactKind, std::array<Index, 4>>;

struct Cloth {
  Mesh mesh;
  Topology topology;
  std::vector<Index> merged;
  std::vector<std::array<Index, 2>> bent;  // as ProximityOptions has it
  explicit Cloth(Mesh m, std::vector<Index> with = {})
      : mesh(std::move(m)),
        topology(build_topology(static_cast<Index>(mesh.x.size()), mesh.triangles)),
        merged(std::move(with)) {}
  const Vec3& x(Index i) const { return mesh.x[static_cast<std::size_t>(i)]; }
  Index m(Index i) const { return merged.empty() ? i : merged[static_cast<std::size_t>(i)]; }
};

std::vector<ClothContact> contacts_of(const Cloth& cloth, double range) {
  static ProximityWorkspace workspace;  // one for all: it must not remember anything
  const ClothTopology topology(cloth.mesh.x.size(), cloth.mesh.triangles, cloth.topology, cloth.merged);
  TriangleTree tree(cloth.mesh.x, cloth.mesh.triangles);
  std::vector<ClothContact> contacts;
  find_cloth_contacts(topology, tree, cloth.mesh.x, {range, 0, region_tolerance, cloth.bent}, workspace, contacts);
  return contacts;
}

// ---- The rules of proximity.hpp once more, by trying everything ----

// `merged` must name the smallest particle of each class here.
class Reference {
 public:
  Reference(const Cloth& cloth, double range) : cloth_(cloth), range_(range) {
    for (const Triangle& c : cloth.mesh.triangles) {
      normals_.push_back((cloth.x(c[1]) - cloth.x(c[0])).cross(cloth.x(c[2]) - cloth.x(c[0])).normalized());
    }
    for (Index v = 0; v < static_cast<Index>(cloth.mesh.x.size()); ++v) vertex(v);
    const auto edges = static_cast<Index>(cloth.topology.edges.size());
    for (Index e = 0; e < edges; ++e) {
      for (Index f = e + 1; f < edges; ++f) edge_pair(e, f);
    }
  }
  std::map<Key, Vec3> records;  // gap * normal

 private:
  const Edge& edge(Index e) const { return cloth_.topology.edges[static_cast<std::size_t>(e)]; }
  static bool leans(const Vec3& u, const Vec3& t) { return u.dot(t.normalized()) > 0.1; }
  bool near(Index i, Index j) const { return (cloth_.x(i) - cloth_.x(j)).norm() < range_; }

  bool leaves_edge(Index a, Index b, const Vec3& u) const {
    for (const Triangle& c : cloth_.mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index p = c[k], q = c[(k + 1) % 3];
        const bool same = (p == a && q == b) || (p == b && q == a);
        const bool partner =
            !same && ((cloth_.m(p) == cloth_.m(a) && cloth_.m(q) == cloth_.m(b) && near(p, a) && near(q, b)) ||
                      (cloth_.m(p) == cloth_.m(b) && cloth_.m(q) == cloth_.m(a) && near(p, b) && near(q, a)));
        if (!same && !partner) continue;
        const Vec3 e = (cloth_.x(q) - cloth_.x(p)).normalized(), to = cloth_.x(c[(k + 2) % 3]) - cloth_.x(p);
        if (leans(u, to - to.dot(e) * e)) return false;
      }
    }
    return true;
  }
  bool leaves_vertex(Index w, const Vec3& u) const {
    for (const Triangle& c : cloth_.mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (c[k] != w && !(cloth_.m(c[k]) == cloth_.m(w) && near(c[k], w))) continue;
        for (const Index j : c) {
          if (j != c[k] && leans(u, cloth_.x(j) - cloth_.x(c[k]))) return false;
        }
      }
    }
    return true;
  }

  void vertex(Index v) {
    std::set<std::set<Index>> faces, kept_edges;
    std::set<std::pair<Index, Index>> edges;
    std::set<Index> vertices;
    const Vec3& p = cloth_.x(v);
    for (const Triangle& c : cloth_.mesh.triangles) {
      const std::set<Index> merged{cloth_.m(c[0]), cloth_.m(c[1]), cloth_.m(c[2])};
      if (merged.count(cloth_.m(v))) continue;
      const VertexTriangle at = closest_vertex_triangle(p, cloth_.x(c[0]), cloth_.x(c[1]), cloth_.x(c[2]));
      if (!(std::sqrt(at.distance2) < range_)) continue;
      const auto k = static_cast<std::size_t>(at.index);
      if (at.feature == Feature::face) {
        faces.insert(merged);
        records[{ContactKind::vertex_face, {v, c[0], c[1], c[2]}}] = p - at.barycentric[0] * cloth_.x(c[0]) -
                                                                     at.barycentric[1] * cloth_.x(c[1]) -
                                                                     at.barycentric[2] * cloth_.x(c[2]);
      } else if (at.feature == Feature::edge) {
        edges.insert(std::minmax(c[k], c[(k + 1) % 3]));
      } else {
        vertices.insert(c[k]);
      }
    }
    const auto within = [&](const std::set<std::set<Index>>& list, Index a, Index b) {
      return std::any_of(list.begin(), list.end(),
                         [&](const auto& s) { return s.count(cloth_.m(a)) && s.count(cloth_.m(b)); });
    };
    for (const auto& [a, b] : edges) {
      const Vec3 e = cloth_.x(b) - cloth_.x(a);
      const double t = std::clamp((p - cloth_.x(a)).dot(e) / e.dot(e), 0.0, 1.0);
      const Vec3 between = p - cloth_.x(a) - t * e;
      if (within(faces, a, b) || !leaves_edge(a, b, between.normalized())) continue;
      kept_edges.insert({cloth_.m(a), cloth_.m(b)});
      records[{ContactKind::vertex_edge, {v, a, b, -1}}] = between;
    }
    for (const Index w : vertices) {
      const Vec3 between = p - cloth_.x(w);
      if (within(faces, w, w) || within(kept_edges, w, w) || !leaves_vertex(w, between.normalized())) continue;
      chosen_.insert({v, w});
      if (!chosen_.count({w, v})) continue;  // until the other has chosen it too
      records[{ContactKind::vertex_vertex, {std::min(v, w), std::max(v, w), -1, -1}}] =
          v < w ? between : Vec3(-between);
    }
  }

  bool flat(Index e) const {
    const auto& t = edge(e).triangle;
    const std::array<Index, 2> ends{edge(e).a, edge(e).b};
    if (t[1] < 0 || std::find(cloth_.bent.begin(), cloth_.bent.end(), ends) != cloth_.bent.end()) return false;
    const Vec3 &n = normals_[static_cast<std::size_t>(t[0])], &m = normals_[static_cast<std::size_t>(t[1])];
    return n.dot(m) > 0 && n.cross(m).norm() <= 0.1;
  }
  void edge_pair(Index e, Index f) {
    const Index a = edge(e).a, b = edge(e).b, c = edge(f).a, d = edge(f).b;
    for (const Index i : {a, b}) {
      if (cloth_.m(i) == cloth_.m(c) || cloth_.m(i) == cloth_.m(d)) return;
    }
    if (flat(e) && flat(f)) return;
    const EdgeEdge at = closest_edge_edge(cloth_.x(a), cloth_.x(b), cloth_.x(c), cloth_.x(d));
    if (!at.interior || !(std::sqrt(at.distance2) < range_)) return;
    const Vec3 between = (1 - at.s) * cloth_.x(a) + at.s * cloth_.x(b) - (1 - at.t) * cloth_.x(c) - at.t * cloth_.x(d);
    const Vec3 u = between.normalized();
    if (leaves_edge(c, d, u) && leaves_edge(a, b, -u)) records[{ContactKind::edge_edge, {a, b, c, d}}] = between;
  }

  const Cloth& cloth_;
  double range_;
  std::vector<Vec3> normals_;
  std::set<std::pair<Index, Index>> chosen_;
};

// Nothing missed, nothing doubled, in order; and each record says what its fields mean.  Counts the kinds into `seen`.
void expect_matches_reference(const Cloth& cloth, double range, std::array<int, 4>& seen) {
  const std::vector<ClothContact> contacts = contacts_of(cloth, range);
  const Reference reference(cloth, range);
  std::vector<Key> keys, expected;
  for (const ClothContact& contact : contacts) keys.emplace_back(contact.kind, contact.particle);
  for (const auto& [key, between] : reference.records) expected.push_back(key);
  ASSERT_TRUE(std::is_sorted(keys.begin(), keys.end()));
  ASSERT_EQ(keys, expected);  // a map's keys: sorted, each once
  for (const ClothContact& contact : contacts) {
    ++seen[static_cast<std::size_t>(contact.kind)];
    Vec3 between = Vec3::Zero();
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      sum += contact.weight[k];
      if (contact.particle[k] < 0) {
        ASSERT_EQ(contact.weight[k], 0);
      } else {
        between += contact.weight[k] * cloth.x(contact.particle[k]);
      }
    }
    ASSERT_NEAR(sum, 0, 1e-14);
    ASSERT_NEAR(contact.normal.norm(), 1, 1e-12);
    ASSERT_LT(contact.gap_m, range);
    ASSERT_GT(contact.gap_m, 0);
    ASSERT_LT((between - contact.gap_m * contact.normal).norm(), 1e-14);
    ASSERT_LT((between - reference.records.at({contact.kind, contact.particle})).norm(), 1e-12);
  }
}

Mesh small_layers(Random& random) {
  Mesh mesh;
  if (random.unit() < 0.3) {  // shards in all directions: corners meet corners
    for (Index first = 0; first < 60; first += 3) {
      const Vec3 at = random.vector(0.015);
      for (int k = 0; k < 3; ++k) mesh.x.push_back(at + random.vector(0.006));
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
  }
  const Index layers = 1 + random.below(3);
  for (Index layer = 0; layer < layers; ++layer) {
    const double z = random.in(-0.01, 0.01), x = random.in(-0.01, 0.01);
    const Index rows = 2 + random.below(4), columns = 2 + random.below(4);
    contact_test::add_sheet(mesh, columns, rows, 0.01, Vec3(x, 0.003 * layer, z));
  }
  // From nearly flat, with flat edges, to crumpled.
  const double height = random.unit() < 0.3 ? 2e-4 : random.in(0, 0.012), sideways = random.in(0, 0.003);
  for (Vec3& p : mesh.x) {
    const double z = random.in(-sideways, sideways), y = random.in(-height, height), x = random.in(-sideways, sideways);
    p += Vec3(x, y, z);
  }
  return mesh;
}

TEST(ClothContacts, MatchTheRulesOnAThousandRandomFrames) {
  Random random(1);
  std::array<int, 4> seen{};
  for (int frame = 0; frame < 1000; ++frame) {
    const Cloth cloth(small_layers(random));
    SCOPED_TRACE(frame);
    ASSERT_NO_FATAL_FAILURE(expect_matches_reference(cloth, random.in(1e-3, 8e-3), seen));
  }
  for (const int count : seen) EXPECT_GT(count, 300);
}

TEST(ClothContacts, EdgesThatAreNamedCountAsBent) {
  Random random(3);
  std::array<int, 4> seen{};
  std::size_t more = 0;
  for (int frame = 0; frame < 300; ++frame) {
    Cloth cloth(small_layers(random));
    const double range = random.in(2e-3, 8e-3);
    const std::size_t without = contacts_of(cloth, range).size();
    for (const Edge& edge : cloth.topology.edges) {
      if (random.unit() < 0.3) cloth.bent.push_back({edge.a, edge.b});
    }
    SCOPED_TRACE(frame);
    ASSERT_NO_FATAL_FAILURE(expect_matches_reference(cloth, range, seen));
    const std::size_t with = contacts_of(cloth, range).size();
    ASSERT_GE(with, without);
    more += with - without;
  }
  EXPECT_GT(more, 100U);
}

TEST(ClothContacts, MatchTheRulesWithSeamsOpenAndClosed) {
  Random random(2);
  std::array<int, 4> seen{};
  for (int frame = 0; frame < 500; ++frame) {
    SCOPED_TRACE(frame);
    // Two panels whose rims x = max and x = min will be sewn, from shut to wide open, and a third one over them.
    Mesh mesh;
    const double gap = random.unit() < 0.5 ? random.in(0, 1e-3) : random.in(0, 0.02);
    contact_test::add_sheet(mesh, 3, 3, 0.01, Vec3::Zero());
    contact_test::add_sheet(mesh, 3, 3, 0.01, Vec3(0.03 + gap, 0, 0));
    contact_test::add_sheet(mesh, 4, 3, 0.01, Vec3(0.01, 0.003, 0.002));
    const double height = random.in(0, 0.004);
    for (Vec3& p : mesh.x) {
      const double z = random.in(-5e-4, 5e-4), y = random.in(-height, height), x = random.in(-5e-4, 5e-4);
      p += Vec3(x, y, z);
    }
    std::vector<Index> merged(mesh.x.size());
    for (std::size_t i = 0; i < merged.size(); ++i) merged[i] = static_cast<Index>(i);
    for (Index row = 0; row < 4; ++row) merged[static_cast<std::size_t>(16 + 4 * row)] = 3 + 4 * row;
    const Cloth cloth(std::move(mesh), std::move(merged));
    ASSERT_NO_FATAL_FAILURE(expect_matches_reference(cloth, random.in(2e-3, 6e-3), seen));
  }
  EXPECT_GT(std::min({seen[0], seen[1], seen[3]}), 100);
}

TEST(ClothContacts, AFlatSheetDoesNotTouchItselfAtAnyRange) {
  Mesh mesh;
  contact_test::add_sheet(mesh, 8, 8, 0.01, Vec3::Zero());
  const Cloth cloth(std::move(mesh));
  for (const double range : {0.002, 0.01, 0.03}) EXPECT_TRUE(contacts_of(cloth, range).empty()) << range;
}

TEST(ClothContacts, TwoParallelSheetsCarryVertexFaceRowsAndEdgesOnlyAtTheirRims) {
  Mesh mesh;
  contact_test::add_sheet(mesh, 20, 20, 0.01, Vec3::Zero());
  contact_test::add_sheet(mesh, 20, 20, 0.01, Vec3(0.0023, 0.002, 0.0031));
  const Cloth cloth(std::move(mesh));
  std::array<int, 4> seen{};
  const std::vector<ClothContact> contacts = contacts_of(cloth, 5e-3);
  std::set<Index> rim;
  for (const Edge& e : cloth.topology.edges) {
    if (e.triangle[1] < 0) rim.insert({e.a, e.b});
  }
  for (const ClothContact& contact : contacts) {
    ++seen[static_cast<std::size_t>(contact.kind)];
    if (contact.kind == ContactKind::vertex_face) {
      EXPECT_NEAR(std::fabs(contact.normal[1]), 1, 1e-12);
      EXPECT_NEAR(contact.gap_m, 0.002, 1e-12);
    } else {
      int on_rim = 0;
      for (const Index i : contact.particle) on_rim += rim.count(i) > 0;
      EXPECT_GT(on_rim, 0) << "sideways row in the middle of a sheet";
    }
  }
  EXPECT_GT(seen[0], 2 * 19 * 19);  // each vertex over the other sheet has its one face
  EXPECT_LE(seen[0], 2 * 21 * 21);
  EXPECT_LT(seen[1] + seen[2] + seen[3], seen[0] / 3);
}

TEST(ClothContacts, AVertexOverAFaceHasNoRowsOfTheEdgesNearby) {
  Mesh mesh;
  contact_test::add_sheet(mesh, 6, 6, 0.01, Vec3::Zero());
  // The tip of a separate triangle, 1 mm above a face and 1.2 mm from its edges; range 5 mm reaches a dozen features.
  const Vec3 tip = Vec3(0.0312, 0.001, 0.0185);
  const auto first = static_cast<Index>(mesh.x.size());
  mesh.x.insert(mesh.x.end(), {tip, tip + Vec3(0.002, 0.03, 0.01), tip + Vec3(-0.002, 0.03, 0.01)});
  mesh.triangles.push_back({first, first + 1, first + 2});
  const auto contacts = contacts_of(Cloth(std::move(mesh)), 5e-3);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].kind, ContactKind::vertex_face);
  EXPECT_EQ(contacts[0].particle[0], first);
  EXPECT_LT((contacts[0].normal - Vec3(0, 1, 0)).norm(), 1e-12);
}

// A vertex in front of the ridge of a roof; the region test lets its row pass where no side of the roof is nearer.
TEST(ClothContacts, AVertexOverARidgeHasOneRowWithTheEdge) {
  for (const double sideways : {0.0, 0.0008, 0.004}) {
    Mesh mesh;
    mesh.x = {{-0.01, 0, 0}, {0.01, 0, 0}, {0, -0.01, 0.01}, {0, -0.01, -0.01}};  // ridge 0-1, slopes of 45 degrees
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
    const Vec3 tip(0.001, 0.002, sideways);
    mesh.x.insert(mesh.x.end(), {tip, tip + Vec3(0.01, 0.03, 0), tip + Vec3(-0.01, 0.03, 0)});
    mesh.triangles.push_back({4, 5, 6});
    const auto contacts = contacts_of(Cloth(std::move(mesh)), 6e-3);
    ASSERT_EQ(contacts.size(), 1u) << sideways;
    const bool over_ridge = sideways < 0.002;
    EXPECT_EQ(contacts[0].kind, over_ridge ? ContactKind::vertex_edge : ContactKind::vertex_face) << sideways;
    if (over_ridge) {
      EXPECT_EQ(contacts[0].particle, (std::array<Index, 4>{4, 0, 1, -1}));
      EXPECT_LT((contacts[0].normal - Vec3(0, 0.002, sideways).normalized()).norm(), 1e-12);
      EXPECT_NEAR(contacts[0].weight[1], -0.45, 1e-12);
      EXPECT_NEAR(contacts[0].weight[2], -0.55, 1e-12);
    }
  }
}

TEST(ClothContacts, TwoTipsHaveOneRowBetweenTheirVertices) {
  Mesh mesh;
  for (const double side : {-1.0, 1.0}) {
    const auto first = static_cast<Index>(mesh.x.size());
    mesh.x.push_back(Vec3(0, 0.001 * side, 0));
    mesh.x.push_back(Vec3(0.01, 0.02 * side, 0.001 * side));
    mesh.x.push_back(Vec3(-0.01, 0.02 * side, 0));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const auto contacts = contacts_of(Cloth(std::move(mesh)), 4e-3);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].kind, ContactKind::vertex_vertex);
  EXPECT_EQ(contacts[0].particle, (std::array<Index, 4>{0, 3, -1, -1}));
  EXPECT_LT((contacts[0].normal - Vec3(0, -1, 0)).norm(), 1e-12);
  EXPECT_NEAR(contacts[0].gap_m, 0.002, 1e-15);
}

TEST(ClothContacts, TwoCrossedRidgesHaveOneRowBetweenTheirEdges) {
  Mesh mesh;
  mesh.x = {{-0.01, 0, 0},     {0.01, 0, 0},     {0, -0.01, 0.01}, {0, -0.01, -0.01},
            {0, 0.002, -0.01}, {0, 0.002, 0.01}, {0.01, 0.012, 0}, {-0.01, 0.012, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {4, 6, 5}, {4, 5, 7}};
  const auto contacts = contacts_of(Cloth(std::move(mesh)), 4e-3);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].kind, ContactKind::edge_edge);
  EXPECT_EQ(contacts[0].particle, (std::array<Index, 4>{0, 1, 4, 5}));
  EXPECT_LT((contacts[0].normal - Vec3(0, -1, 0)).norm(), 1e-12);
}

TEST(ClothContacts, ASeamThatIsNearlyShutActsAsOneSheet) {
  // Two flat panels 0.3 mm apart; a vertex above the left one, 1 mm from the seam.  Without the merge the rim of the
  // right panel pushes it sideways.
  Mesh mesh;
  contact_test::add_sheet(mesh, 3, 4, 0.01, Vec3::Zero());
  const auto right = static_cast<Index>(mesh.x.size());
  contact_test::add_sheet(mesh, 3, 4, 0.01, Vec3(0.0303, 0, 0));
  const auto tip_index = static_cast<Index>(mesh.x.size());
  const Vec3 tip(0.03166, 0.001, 0.0127);  // the rim stands at x = 0.0323 there
  mesh.x.insert(mesh.x.end(), {tip, tip + Vec3(0.002, 0.03, 0.01), tip + Vec3(-0.002, 0.03, 0.01)});
  mesh.triangles.push_back({tip_index, tip_index + 1, tip_index + 2});
  std::vector<Index> merged(mesh.x.size());
  for (std::size_t i = 0; i < merged.size(); ++i) merged[i] = static_cast<Index>(i);
  for (Index row = 0; row < 5; ++row) merged[static_cast<std::size_t>(right + 4 * row)] = 3 + 4 * row;
  const auto of_tip = [&](const std::vector<ClothContact>& contacts) {
    std::vector<ClothContact> list;
    for (const ClothContact& c : contacts) {
      if (c.particle[0] == tip_index) list.push_back(c);
    }
    return list;
  };
  const auto apart = of_tip(contacts_of(Cloth(mesh), 3e-3));
  EXPECT_EQ(apart.size(), 2u);
  const auto together = of_tip(contacts_of(Cloth(mesh, merged), 3e-3));
  ASSERT_EQ(together.size(), 1u);
  EXPECT_EQ(together[0].kind, ContactKind::vertex_face);
  EXPECT_LT((together[0].normal - Vec3(0, 1, 0)).norm(), 1e-12);
}

TEST(ClothContacts, FeaturesThatWillBeWeldedDoNotRepelEachOther) {
  // Two panels one above the other, every particle merged with the one above: their vertices touch nothing of their
  // own ring.
  Mesh mesh;
  contact_test::add_sheet(mesh, 4, 4, 0.01, Vec3::Zero());
  const std::size_t half = mesh.x.size();
  contact_test::add_sheet(mesh, 4, 4, 0.01, Vec3(0, 0.002, 0));
  std::vector<Index> merged(mesh.x.size());
  for (std::size_t i = 0; i < merged.size(); ++i) merged[i] = static_cast<Index>(i % half);
  EXPECT_FALSE(contacts_of(Cloth(mesh), 5e-3).empty());
  EXPECT_TRUE(contacts_of(Cloth(mesh, merged), 5e-3).empty());
}

TEST(ClothContacts, AFoldTouchesItselfBeyondItsFirstRing) {
  // A strip folded over: the flaps lie 2 mm apart.  Features at the crease share particles and are skipped.
  Mesh mesh;
  contact_test::add_sheet(mesh, 12, 4, 0.01, Vec3::Zero());
  for (Vec3& p : mesh.x) {
    if (p[0] > 0.06) p = Vec3(0.12 - p[0] + 0.0013, 0.002, p[2]);
  }
  const Cloth cloth(std::move(mesh));
  const auto contacts = contacts_of(cloth, 5e-3);
  EXPECT_GT(contacts.size(), 30u);
  for (const ClothContact& contact : contacts) {
    std::set<Index> different;
    for (const Index i : contact.particle) {
      if (i >= 0) {
        EXPECT_TRUE(different.insert(i).second);
      }
    }
  }
}

TEST(ClothContacts, CoincidentFeaturesHaveAFiniteNormal) {
  Mesh mesh;
  contact_test::add_sheet(mesh, 2, 2, 0.01, Vec3::Zero());
  contact_test::add_sheet(mesh, 2, 2, 0.01, Vec3::Zero());           // exactly on the first
  contact_test::add_sheet(mesh, 2, 2, 0.01, Vec3(0.003, 0, 0.002));  // in the same plane, shifted
  for (const ClothContact& contact : contacts_of(Cloth(std::move(mesh)), 5e-3)) {
    ASSERT_TRUE(contact.normal.allFinite());
    ASSERT_NEAR(contact.normal.norm(), 1, 1e-12);
    ASSERT_GE(contact.gap_m, 0);
  }
}

TEST(ClothContacts, TheListDoesNotDependOnTheNumberOfThreads) {
  Mesh mesh;
  for (int layer = 0; layer < 4; ++layer)
    contact_test::add_sheet(mesh, 30, 30, 0.01, Vec3(0.003 * layer, 0.002 * layer, 0));
  Random random(3);
  for (Vec3& p : mesh.x) p[1] += 0.004 * std::sin(p[0] * 90) * std::cos(p[2] * 70) + random.in(-5e-4, 5e-4);
  const Topology topology = build_topology(static_cast<Index>(mesh.x.size()), mesh.triangles);
  const ClothTopology cloth(mesh.x.size(), mesh.triangles, topology);
  TriangleTree tree(mesh.x, mesh.triangles);
  std::vector<ClothContact> one, many;
  ProximityWorkspace workspace;
  with_threads(1, [&] { find_cloth_contacts(cloth, tree, mesh.x, {}, workspace, one); });
  ASSERT_GT(one.size(), 5000u);
  for (const int threads : {2, 5}) {
    with_threads(threads, [&] { find_cloth_contacts(cloth, tree, mesh.x, {}, workspace, many); });
    ASSERT_EQ(one.size(), many.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      ASSERT_EQ(one[i].kind, many[i].kind);
      ASSERT_EQ(one[i].particle, many[i].particle);
      ASSERT_EQ(one[i].weight, many[i].weight);
      ASSERT_EQ(one[i].normal, many[i].normal);
      ASSERT_EQ(one[i].gap_m, many[i].gap_m);
    }
  }
}

TEST(ClothContacts, SaysWhenThePositionsAreNotThoseOfTheCloth) {
  Mesh mesh;
  contact_test::add_sheet(mesh, 2, 2, 0.01, Vec3::Zero());
  const Topology topology = build_topology(static_cast<Index>(mesh.x.size()), mesh.triangles);
  const ClothTopology cloth(mesh.x.size(), mesh.triangles, topology);
  TriangleTree tree(mesh.x, mesh.triangles);
  mesh.x.pop_back();
  ProximityWorkspace workspace;
  std::vector<ClothContact> contacts;
  EXPECT_THROW(find_cloth_contacts(cloth, tree, mesh.x, {}, workspace, contacts), InputError);
}

}  // namespace
}  // namespace toile::internal
