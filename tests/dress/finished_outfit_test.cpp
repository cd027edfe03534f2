// Hems of garments that are put on one after the other, and while they are sewn.
#include "dress/dressing.hpp"
#include "support/tube_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace toile::internal {
namespace {

TEST(FinishedOutfit, EveryGarmentKeepsItsOwnAndIsSewnAsCut) {
  Pattern pattern = test::tube_pattern(0.2, 0.16, 0.1);
  finish_other_edges(pattern, {0.02, 0});
  const GarmentMesh garment = mesh_garment(pattern, 0.04);
  ASSERT_GT(garment.mesh.finished.size(), 8U);
  const std::vector<Fabric> fabrics(pattern.panels.size());
  const std::vector<Vec2> rest(pattern.panels.size(), Vec2(1, 1));
  Outfit outfit;
  wear(outfit, garment, fabrics, rest, {});
  const Index first = outfit.mesh.particle_count;
  wear(outfit, garment, fabrics, rest, {});
  ASSERT_EQ(outfit.mesh.finished.size(), 2 * garment.mesh.finished.size());
  std::set<std::pair<Index, Index>> sides;
  for (const Triangle& t : outfit.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) sides.insert(std::minmax(t[k], t[(k + 1) % 3]));
  for (const FinishedEdge& edge : outfit.mesh.finished) EXPECT_TRUE(sides.contains(std::minmax(edge.a, edge.b)));
  const auto of_second = [&](const FinishedEdge& edge) { return edge.a >= first; };
  EXPECT_EQ(std::count_if(outfit.mesh.finished.begin(), outfit.mesh.finished.end(), of_second),
            static_cast<std::ptrdiff_t>(garment.mesh.finished.size()));
  EXPECT_EQ(build_model(outfit.mesh, outfit.fabrics, {}).threads.size(), outfit.mesh.finished.size());

  const Sewing sewing(garment, fabrics, nullptr, {}, {});
  EXPECT_TRUE(sewing.model().threads.empty());
}

// Nor does cloth remember how it was turned about while its seams closed.
TEST(FinishedOutfit, IsSewnWithoutBendingFrictionAndWithoutStiffening) {
  Fabric fabric;
  fabric.doubling_strain_u = fabric.doubling_strain_v = 0.02;
  fabric.bend_friction_N = 6e-4;
  fabric.bend_set = 0.3;
  const GarmentMesh garment = mesh_garment(test::tube_pattern(0.12, 0.12, 0.1), 0.02);
  const Sewing sewing(garment, {&fabric, 1}, nullptr, {}, {});
  EXPECT_TRUE(sewing.model().hysteresis.empty());
  EXPECT_EQ(sewing.model().stiffness.front().doubling_u, 0);
  EXPECT_EQ(sewing.model().stiffness.front().doubling_v, 0);
  EXPECT_EQ(build_model(garment.mesh, {&fabric, 1}).hysteresis.size(), 1U) << "worn, it does";
  EXPECT_EQ(build_model(garment.mesh, {&fabric, 1}).stiffness.front().doubling_u, 0.02);
}

}  // namespace
}  // namespace toile::internal
