// Where the flat panels hang before they are sewn: the shift that frees the seams, and no longer one than needed.
#include "garment/placement.hpp"

#include "core/parallel.hpp"
#include "garments.hpp"
#include "support/bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <utility>

namespace toile::internal {
namespace {

// A box with half sizes `half` around `centre`.
BodySurface box(const Vec3& centre, const Vec3& half) {
  std::vector<Vec3> x;
  for (const double y : {-1.0, 1.0}) {
    for (const double z : {-1.0, 1.0}) {
      for (const double u : {-1.0, 1.0}) x.push_back(centre + half.cwiseProduct(Vec3(u, y, z)));
    }
  }
  return BodySurface(std::move(x), {test::box_triangles.begin(), test::box_triangles.end()});
}

// Panels 20 cm wide and 10 high before and behind a slab 20 cm deep, 40 wide and 20 high, whose top is at y = 0.  Their sides are sewn straight
// through it unless their lower rim is above.
GarmentMesh panels_over_a_slab(double lower_rim) {
  return mesh_garment(test::tube_pattern(0.2, 0.1, 0.3, {0, lower_rim + 0.05, 0}), 0.02);
}
BodySurface slab() { return box({0, -0.1, 0}, {0.2, 0.1, 0.1}); }

TEST(Placement, PanelsThreeCentimetresTooLowAreRaisedUntilNoSeamIsBlocked) {
  GarmentMesh garment = panels_over_a_slab(-0.025);
  const Vec3s before = garment.x;
  const BodySurface body = slab();
  const Placement placement = place_garment(garment, body);
  // Pairs 2 cm apart along 10 cm of each side: those at -2.5 and -0.5 cm are in the slab.
  EXPECT_EQ(placement.blocked_before, 4);
  EXPECT_EQ(placement.blocked, 0);
  EXPECT_EQ(placement.panel_crossings, 0);
  EXPECT_TRUE(placement.blocked_seams.empty());
  EXPECT_NEAR(placement.shift_m.y(), 0.03, 1e-12) << "the smallest step that does it";
  EXPECT_NEAR(placement.shift_m.z(), 0, 1e-12);
  EXPECT_EQ(placement.shift_m.x(), 0);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((garment.x[i] - before[i] - placement.shift_m).norm(), 1e-12);
}

// Its lower rim is labelled for a waist 6 cm higher, and free there; 6 cm lower its sides are blocked.
TEST(Placement, OfShiftsThatBlockAsLittleTheOneNearestToTheWaistIsTaken) {
  const BodySurface body = slab();
  for (const auto& [waist_m, shift_m] : {std::pair{0.07, 0.06}, std::pair{0.028, 0.0}, std::pair{0.032, 0.02},
                                         std::pair{-0.05, 0.0}, std::pair{1.0, 0.16}}) {
    Pattern pattern = test::tube_pattern(0.2, 0.1, 0.3, {0, 0.06, 0});
    for (Panel& panel : pattern.panels) panel.edges[0].label = "lower_interface";
    GarmentMesh garment = mesh_garment(pattern, 0.02);
    EXPECT_NEAR(place_garment(garment, body, body.positions().size(), waist_m).shift_m.y(), shift_m, 1e-12) << waist_m;
    GarmentMesh unknown = mesh_garment(pattern, 0.02);
    EXPECT_EQ(place_garment(unknown, body).shift_m, Vec3(0, 0, 0));
  }
  GarmentMesh unlabelled = panels_over_a_slab(0.01);
  EXPECT_LT(place_garment(unlabelled, body, body.positions().size(), 0.07).shift_m.norm(), 1e-15);
}

TEST(Placement, AGarmentThatIsFreeStaysToTheBit) {
  GarmentMesh garment = panels_over_a_slab(0.01);
  const Vec3s before = garment.x;
  const BodySurface body = slab();
  const Placement placement = place_garment(garment, body);
  EXPECT_LT(placement.shift_m.norm(), 1e-15);
  EXPECT_EQ(placement.blocked_before, 0);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((garment.x[i] - before[i]).norm(), 1e-15);
}

TEST(Placement, TheShorterOfTwoWaysOutIsTaken) {
  // Samples from -5 to 5 cm, a slab from -0.5 to 4.5 cm (or its mirror image): 6 cm one way free all of them, 10 the other.
  for (const double middle : {-0.02, 0.02}) {
    GarmentMesh garment = mesh_garment(test::tube_pattern(0.2, 0.1, 0.3), 0.02);
    const BodySurface body = box({0, middle, 0}, {0.2, 0.025, 0.1});
    const Placement placement = place_garment(garment, body);
    EXPECT_EQ(placement.blocked_before, 4);
    EXPECT_EQ(placement.blocked, 0);
    EXPECT_NEAR(placement.shift_m.y(), middle > 0 ? -0.06 : 0.06, 1e-12);
    EXPECT_NEAR(placement.shift_m.z(), 0, 1e-12);
  }
}

TEST(Placement, SeamsThatStayBehindTheBodyAreNamed) {
  // A post far taller than any shift, beside the middle, through the right side (+x) only.
  GarmentMesh garment = mesh_garment(test::tube_pattern(0.2, 0.1, 0.3), 0.02);
  const BodySurface body = box({0.1, 0, 0}, {0.03, 1, 0.08});
  const Placement placement = place_garment(garment, body);
  EXPECT_EQ(placement.blocked_before, 6);
  EXPECT_EQ(placement.blocked, 6);
  EXPECT_EQ(placement.blocked_seams, (std::vector<Index>{0}));
  EXPECT_LT(placement.shift_m.norm(), 1e-15) << "nothing is gained, so nothing is moved";
}

TEST(Placement, ALineThatEndsBeforeASlantedFaceIsNotBlocked) {
  // An octahedron, |x| + |y| + |z| <= 10 cm: at the sides of the panels (x = 3, y up to 3 cm) its faces are at z <= 7 cm, the lines end at 8.
  GarmentMesh garment = mesh_garment(test::tube_pattern(0.06, 0.06, 0.1, {0, 0, 0.13}), 0.02);
  const BodySurface body = test::sphere({0, 0, 0}, 0.1, 0);
  EXPECT_EQ(place_garment(garment, body).blocked_before, 0);
}

TEST(Placement, PanelsThatStartInTheBodyAreMovedOut) {
  // A post from z = 12 to 18 cm through the middle of the front panel at 15, away from the seams: none of them is blocked, and yet the garment
  // has to move two steps.
  GarmentMesh garment = mesh_garment(test::tube_pattern(0.1, 0.1, 0.3), 0.02);
  const BodySurface body = box({0.005, 0, 0.15}, {0.02, 1, 0.03});
  const Placement placement = place_garment(garment, body);
  EXPECT_EQ(placement.blocked_before, 0);
  EXPECT_EQ(placement.panel_crossings, 0);
  EXPECT_NEAR(std::abs(placement.shift_m.z()), 0.04, 1e-12);
  EXPECT_NEAR(placement.shift_m.y(), 0, 1e-12);
}

TEST(Placement, PanelsThatNoShiftFreesAreCounted) {
  GarmentMesh garment = mesh_garment(test::tube_pattern(0.1, 0.1, 0.3), 0.02);
  const BodySurface body = box({0.05, 0, 0}, {0.02, 1, 0.5});  // both panels cut it, and no shift in y or z helps
  const Placement placement = place_garment(garment, body);
  EXPECT_GT(placement.panel_crossings, 10);
}

// Shoulders: a block up to y = 0, 40 cm wide, that a tube's short sides are sewn through until the tube is 4 cm higher.  There a third panel, a collar, is in
// the neck that stands on it; a dozen centimetres lower it would be in nothing.
TEST(Placement, ACollarInTheNeckDoesNotKeepTheShouldersUnderTheShoulders) {
  Pattern pattern = test::tube_pattern(0.2, 0.06, 0.3, {0, -0.005, 0});
  for (const double collar_m : {0.005, 0.5}) {  // before the middle of the neck
    pattern.panels.resize(2);
    pattern.panels.push_back(test::front_rectangle(0.3, 0.02, Vec3(0, 0.08, collar_m)));
    pattern.panels.back().name = "collar";
    GarmentMesh garment = mesh_garment(pattern, 0.02);
    const Vec3s drawn = garment.x;
    std::vector<Vec3> x;
    std::vector<Triangle> triangles;
    for (const BodySurface& part : {box({0, -0.1, 0}, {0.2, 0.1, 0.1}), box({0, 0.27, 0}, {0.04, 0.2, 0.06})}) {
      for (const auto& [a, b, c] : part.triangles()) {
        const auto first = static_cast<Index>(x.size());
        triangles.push_back({a + first, b + first, c + first});
      }
      x.insert(x.end(), part.positions().begin(), part.positions().end());
    }
    const Placement placement = place_garment(garment, BodySurface(x, triangles));
    EXPECT_EQ(placement.blocked, 0);
    EXPECT_EQ(placement.panel_crossings, 0);
    EXPECT_NEAR(placement.shift_m.y(), 0.04, 1e-12);
    const std::vector<Index> panel = garment.panel_of_particle();
    const double out_m = collar_m == 0.005 ? 0.06 : 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const Vec3 moved = garment.x[i] - drawn[i] - placement.shift_m;
      EXPECT_LT((moved - Vec3(0, 0, panel[i] == 2 ? out_m : 0)).norm(), 1e-12) << "no other panel goes anywhere";
    }
  }
}

TEST(Placement, ATubeAroundASphereIsRaisedFromBelowItsMiddle) {
  // The sphere hangs low between the panels: their sides pass beside it (x = 9 cm), the bridge of samples does not cross it once they are
  // above 6 cm of its centre's height, since 9^2 + 6^2 > 10^2.
  GarmentMesh garment = mesh_garment(test::tube_pattern(0.18, 0.1, 0.3, {0, 0.085, 0}), 0.01);
  const BodySurface body = test::sphere({0, 0, 0}, 0.1, 4);
  const Placement placement = place_garment(garment, body);
  EXPECT_GT(placement.blocked_before, 0);
  EXPECT_EQ(placement.blocked, 0);
  EXPECT_GT(placement.shift_m.y(), 0);
  EXPECT_LT(placement.shift_m.y(), 0.021);
}

TEST(Placement, SolidsBesideThePersonDoNotRaiseAnOldPattern) {
  GarmentMesh garment = mesh_garment(test::tube_pattern(0.1, 0.1, 0.3), 0.02);
  garment.legacy_frame = true;
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  for (const BodySurface& part : {box({0, 0.5, 0}, {0.01, 0.5, 0.01}), box({50, 7, 0}, {1, 1, 1})}) {
    for (const auto& [a, b, c] : part.triangles()) {
      const auto first = static_cast<Index>(x.size());
      triangles.push_back({a + first, b + first, c + first});
    }
    x.insert(x.end(), part.positions().begin(), part.positions().end());
  }
  const Placement placement = place_garment(garment, BodySurface(x, triangles), 8);
  EXPECT_LT((placement.shift_m - Vec3(0, 0.68, 0)).norm(), 1e-12);
  GarmentMesh alone = mesh_garment(test::tube_pattern(0.1, 0.1, 0.3), 0.02);
  alone.legacy_frame = true;
  EXPECT_EQ(place_garment(alone, box({50, 7, 0}, {1, 1, 1}), 0).shift_m, Vec3(0, 0, 0)) << "nobody there";
}

TEST(Placement, AnOldPatternIsRaisedFromThePelvis) {
  GarmentMesh garment = mesh_garment(test::tube_pattern(0.1, 0.1, 0.3), 0.02);
  garment.legacy_frame = true;
  const Vec3 first = garment.x.front();
  const BodySurface body = box({0, 0.5, 0}, {0.01, 0.5, 0.01});  // 1 m tall from the floor, between the panels
  const Placement placement = place_garment(garment, body);
  EXPECT_LT((placement.shift_m - Vec3(0, 0.68, 0)).norm(), 1e-12);
  EXPECT_LT((garment.x.front() - first - placement.shift_m).norm(), 1e-12);
}

TEST(Placement, DoesNotDependOnTheThreads) {
  const BodySurface body = test::sphere({0.01, 0, 0.02}, 0.1, 4);
  Vec3s reference;
  for (const int threads : {1, 2, 5}) {
    GarmentMesh garment = mesh_garment(test::tube_pattern(0.18, 0.1, 0.3, {0, 0.06, 0}), 0.01);
    with_threads(threads, [&] { place_garment(garment, body); });
    if (threads == 1) reference = garment.x;
    EXPECT_EQ(std::memcmp(reference.data(), garment.x.data(), reference.size() * sizeof(Vec3)), 0) << threads;
  }
}

}  // namespace
}  // namespace toile::internal
