// tests/garment/sleeves_test.cpp: sleeves are hung on the arms.
#include "garment/sleeves.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace toile::internal {
namespace {

bool is_sleeve(const GarmentMesh& garment, Index panel) {
  return garment.mesh.panel_names[at(panel)].find("sleeve") != std::string::npos;
}

// In the frontal plane: middles of what is sewn to a body panel, and of the hem.
struct Middles {
  Vec3 armhole{0, 0, 0}, hem{0, 0, 0};
};
Middles middles_of(const GarmentMesh& garment, bool left) {
  const std::vector<Index> panel = garment.panel_of_particle();
  const auto mine = [&](Index i) { return is_sleeve(garment, panel[at(i)]) && (garment.x[at(i)].x() > 0) == left; };
  std::vector<char> sewn(garment.x.size(), 0);
  Middles middles;
  double share = 0, count = 0;
  for (const SeamPair& pair : garment.pairs) {
    sewn[at(pair.a)] = sewn[at(pair.b)] = 1;
    if (mine(pair.a) == mine(pair.b)) continue;
    middles.armhole += pair.share_m * garment.x[at(mine(pair.a) ? pair.a : pair.b)];
    share += pair.share_m;
  }
  for (std::size_t i = 0; i < garment.x.size(); ++i) {
    if (!mine(static_cast<Index>(i)) || sewn[i] != 0 || !garment.on_panel_edge[i]) continue;
    middles.hem += garment.x[i];
    ++count;
  }
  middles.armhole /= share;
  middles.hem /= count;
  return middles;
}

TEST(Sleeves, LieOnTheArmsAndNothingElseMoves) {
  const Pattern pattern = load_pattern(test::source_path("patterns/tshirt.json"));
  const GarmentMesh drawn = mesh_garment(pattern, 0.03);
  const std::vector<Index> panel = drawn.panel_of_particle();
  const Vec3 root(0.2, 1.33, -0.02);
  for (const bool labelled : {false, true}) {
    for (const double below_level : {0.0, 0.3, 0.9}) {
      GarmentMesh garment = drawn;
      for (std::size_t p = 0; labelled && p < garment.panel_labels.size(); ++p)
        garment.panel_labels[p] = is_sleeve(garment, static_cast<Index>(p)) ? "arm" : "body";
      const Vec3 left(std::cos(below_level), -std::sin(below_level), 0), right(-left.x(), left.y(), 0);
      hang_sleeves(garment, {ArmLine{root, left}, ArmLine{Vec3(-root.x(), root.y(), root.z()), right}}, 1.72);
      for (const bool on_left : {true, false}) {
        const Vec3 from(on_left ? root.x() : -root.x(), root.y(), 0), along = on_left ? left : right;
        const Middles middles = middles_of(garment, on_left);
        for (const Vec3& p : {middles.armhole, middles.hem}) {
          const Vec3 off(p.x() - from.x(), p.y() - from.y(), 0);
          EXPECT_NEAR(off.x() * along.y() - off.y() * along.x(), 0, 1e-9) << below_level;
        }
        EXPECT_GT((middles.hem - middles.armhole).dot(along), 0.1) << "the hem is towards the hand";
      }
      int moved = 0;
      for (std::size_t i = 0; i < garment.x.size(); ++i) {
        EXPECT_EQ(garment.x[i].z(), drawn.x[i].z());
        if (is_sleeve(drawn, panel[i])) continue;
        moved += garment.x[i] == drawn.x[i] ? 0 : 1;
      }
      EXPECT_EQ(moved, 0);
      for (const Triangle& t : garment.mesh.triangles)  // nothing is stretched
        for (std::size_t k = 0; k < 3; ++k) {
          const auto a = at(t[k]), b = at(t[(k + 1) % 3]);
          ASSERT_NEAR((garment.x[a] - garment.x[b]).norm(), (drawn.x[a] - drawn.x[b]).norm(), 1e-12);
        }
      GarmentMesh again = garment;
      hang_sleeves(again, {ArmLine{root, left}, ArmLine{Vec3(-root.x(), root.y(), root.z()), right}}, 1.72);
      for (std::size_t i = 0; i < again.x.size(); ++i) ASSERT_LT((again.x[i] - garment.x[i]).norm(), 1e-9);
    }
  }
}

TEST(Sleeves, OfAGarmentWithLabelsAreThePanelsThatSaySo) {
  const Pattern pattern = load_pattern(test::source_path("patterns/tshirt.json"));
  GarmentMesh garment = mesh_garment(pattern, 0.03);
  for (std::string& label : garment.panel_labels) label = "body";
  const Vec3s drawn = garment.x;
  hang_sleeves(garment, {ArmLine{{0.2, 1.33, 0}, {1, 0, 0}}, ArmLine{{-0.2, 1.33, 0}, {-1, 0, 0}}}, 1.72);
  EXPECT_EQ(garment.x, drawn);
}

TEST(Sleeves, AShirtCoversTheShouldersAndASkirtDoesNot) {
  const Vec3 root(0.2, 1.33, -0.02);
  const std::array<ArmLine, 2> arms{ArmLine{root, Vec3::UnitX()},
                                    ArmLine{Vec3(-root.x(), root.y(), root.z()), -Vec3::UnitX()}};
  const auto covers = [&](const char* file) {
    return covers_shoulders(mesh_garment(load_pattern(test::source_path("patterns/") + file), 0.03), arms);
  };
  EXPECT_EQ(covers("tshirt.json"), (std::array<bool, 2>{true, true}));
  EXPECT_EQ(covers("short_skirt.json"), (std::array<bool, 2>{false, false}));
}

}  // namespace
}  // namespace toile::internal
