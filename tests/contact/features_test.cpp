#include "contact/features.hpp"

#include "contact/meshes.hpp"
#include "core/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace toile::internal {
namespace {

using contact_test::Mesh;

TEST(Features, EveryVertexAndEdgeHasExactlyOneOwner) {
  Mesh mesh;
  contact_test::add_sheet(mesh, 6, 5, 1, Vec3::Zero());
  contact_test::add_sheet(mesh, 3, 2, 1, Vec3(0, 1, 0));
  const Topology topology = build_topology(static_cast<Index>(mesh.x.size()), mesh.triangles);
  const auto owned = assign_features(mesh.x.size(), mesh.triangles, topology);
  std::map<Index, int> vertices, edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      vertices[mesh.triangles[t][k]] += owned[t] >> k & 1;
      edges[topology.triangle_edges[t][k]] += owned[t] >> (3 + k) & 1;
    }
  }
  EXPECT_EQ(vertices.size(), mesh.x.size());
  EXPECT_EQ(edges.size(), topology.edges.size());
  for (const auto& [vertex, count] : vertices) EXPECT_EQ(count, 1) << "vertex " << vertex;
  for (const auto& [edge, count] : edges) EXPECT_EQ(count, 1) << "edge " << edge;
}

TEST(Features, MergedParticlesFormClassesHoweverTheyAreNamed) {
  Mesh mesh;
  contact_test::add_sheet(mesh, 1, 1, 1, Vec3::Zero());  // particles 0..3
  contact_test::add_sheet(mesh, 1, 1, 1, Vec3::Zero());  // particles 4..7
  const Topology topology = build_topology(8, mesh.triangles);
  const std::vector<Index> chain{0, 1, 2, 3, 1, 4, 3, 2};  // 5 -> 4 -> 1;  6 -> 3;  7 -> 2
  const std::vector<Index> mutual{0, 4, 7, 6, 5, 1, 3, 2};
  for (const auto& merged : {chain, mutual}) {
    const ClothTopology cloth(8, mesh.triangles, topology, merged);
    EXPECT_EQ(cloth.merged(1), 1);
    EXPECT_EQ(cloth.merged(4), 1);
    EXPECT_EQ(cloth.merged(5), 1);
    EXPECT_EQ(cloth.merged(6), 3);
    EXPECT_EQ(cloth.merged(7), 2);
    EXPECT_EQ(cloth.merged(0), 0);
    std::vector<Index> around;
    for (const Index corner : cloth.corners_around(6)) {
      around.push_back(mesh.triangles[static_cast<std::size_t>(corner / 3)][static_cast<std::size_t>(corner % 3)]);
    }
    EXPECT_EQ(std::count(around.begin(), around.end(), 3) + std::count(around.begin(), around.end(), 6),
              static_cast<std::ptrdiff_t>(around.size()));
    EXPECT_TRUE(std::count(around.begin(), around.end(), 3) > 0 && std::count(around.begin(), around.end(), 6) > 0);
  }
  // Edge 2-3 of the first sheet and 6-7 of the second will be one.
  const ClothTopology cloth(8, mesh.triangles, topology, chain);
  for (Index e = 0; e < static_cast<Index>(topology.edges.size()); ++e) {
    const Edge& edge = cloth.edge(e);
    const auto merged = cloth.merged_edges(e);
    EXPECT_EQ(std::count(merged.begin(), merged.end(), e), 1);
    if ((edge.a == 2 && edge.b == 3) || (edge.a == 6 && edge.b == 7)) {
      EXPECT_EQ(merged.size(), 2u);
    }
    if (edge.a == 0 || edge.b == 0) {
      EXPECT_EQ(merged.size(), 1u);
    }
  }
}

TEST(Features, NamesAMergedParticleThatDoesNotExist) {
  Mesh mesh;
  contact_test::add_sheet(mesh, 1, 1, 1, Vec3::Zero());
  const Topology topology = build_topology(4, mesh.triangles);
  try {
    const ClothTopology cloth(4, mesh.triangles, topology, std::vector<Index>{0, 1, 9, 3});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("merged_particle 2"), std::string::npos) << error.what();
  }
  EXPECT_THROW(ClothTopology(4, mesh.triangles, topology, std::vector<Index>{0, 1}), InputError);
}

}  // namespace
}  // namespace toile::internal
