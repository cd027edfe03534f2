// How far cloth has moved against a body that moves: exact answers.
#include "verify/slip.hpp"

#include "body/arms.hpp"
#include "body/mannequin.hpp"
#include "body/measure.hpp"
#include "support/tubes.hpp"
#include "verify/hem_loops.hpp"
#include "verify/nearest_point.hpp"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace toile::internal {
namespace {

using test::Tube;
using test::tube;

constexpr double cm = 0.01;

ClothMesh cloth_of(const Tube& tube, const std::string& panel = "skirt") {
  ClothMesh mesh;
  mesh.particle_count = static_cast<Index>(tube.x.size());
  mesh.triangles = tube.triangles;
  mesh.panel.assign(mesh.triangles.size(), 0);
  mesh.panel_names = {panel};
  return mesh;
}

struct Rigid {
  double angle = 0;
  Vec3 axis{0, 1, 0}, shift{0, 0, 0};
  Vec3s operator()(Vec3s x) const {
    const Mat3 turn = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    for (Vec3& p : x) p = turn * p + shift;
    return x;
  }
};

// Frame 0: both as they are; then the cloth slides as `slide` says (in the axes of the body), and both are carried about.
SlipStatistics after(const ClothMesh& mesh, const Vec3s& x, const Tube& body, const std::vector<Vec3>& slides,
                     const std::function<Rigid(int)>& carried) {
  SlipMeter meter(mesh, body.triangles);
  meter.add(x, body.x);
  meter.add(x, body.x);  // it stands
  int frame = 1;
  for (const Vec3& slide : slides) {
    Vec3s moved = x;
    for (Vec3& p : moved) p += slide;
    ++frame;
    meter.add(carried(frame)(moved), carried(frame)(body.x));
  }
  return meter.statistics();
}

Rigid about(int frame) { return {0.2 * frame, Vec3(1, 2, 3), Vec3(0.1 * frame, 0.2, -0.3)}; }

// A trunk of radius 15 cm up to 1.4 m, and a skirt 3 mm off it from 0.6 to 1 m.
Tube trunk() { return tube(0.15, 0, 1.4, 48, 28, true); }
Tube skirt() { return tube(0.153, 0.6, 1.0, 40, 8, false); }

TEST(Slip, OfWhatIsCarriedByOneRigidMotionIsZero) {
  Tube bulging = skirt();
  for (Vec3& p : bulging.x)
    if (p.x() > 0) p.x() += 2 * cm;  // or what a turn does to one side would make up for the other
  const SlipStatistics slip = after(cloth_of(bulging), bulging.x, trunk(), std::vector<Vec3>(5, Vec3::Zero()), about);
  EXPECT_EQ(slip.first_frame, 1);
  ASSERT_EQ(slip.loops.size(), 2U);
  for (const LoopSlip& loop : slip.loops) {
    EXPECT_NEAR(loop.drop.last_m, 0, 1e-12);
    EXPECT_NEAR(loop.drop.worst_m, 0, 1e-12);
  }
}

TEST(Slip, OfASkirtThatSlidesDownATrunkIsHowFarItSlid) {
  const double d = 3.7 * cm;
  const SlipStatistics slip = after(cloth_of(skirt()), skirt().x, trunk(), {{0, -d / 2, 0}, {0, -d, 0}}, about);
  ASSERT_EQ(slip.loops.size(), 2U);
  EXPECT_FALSE(slip.loops[0].holds) << "what is worn is worn by a person";
  EXPECT_EQ(slip.loops[0].name, "skirt");
  EXPECT_NEAR(slip.loops[0].height_m, 1.0, 1e-12);
  EXPECT_NEAR(slip.loops[0].girth_m, 2 * 40 * 0.153 * std::sin(M_PI / 40), 1e-12);
  EXPECT_EQ(slip.loops[0].drop.vertices, 40);
  for (const LoopSlip& loop : slip.loops) {
    EXPECT_NEAR(loop.drop.last_m, d, 1e-12);
    EXPECT_NEAR(loop.drop.worst_m, d, 1e-12);
    EXPECT_EQ(loop.drop.worst_frame, 3);
  }
  EXPECT_EQ(slip.waist.vertices, 0) << "a trunk alone is no person";
}

TEST(Slip, RemembersTheWorstOfWhatComesBack) {
  const SlipStatistics slip =
      after(cloth_of(skirt()), skirt().x, trunk(), {{0, -1 * cm, 0}, {0, -4 * cm, 0}, {0, 0, 0}}, about);
  EXPECT_NEAR(slip.loops.at(0).drop.worst_m, 4 * cm, 1e-12);
  EXPECT_EQ(slip.loops.at(0).drop.worst_frame, 3);
  EXPECT_NEAR(slip.loops.at(0).drop.last_m, 0, 1e-12);
}

TEST(Slip, OfACuffIsAlongItsArmOutwards) {
  Tube arm = trunk(), cuff = skirt();
  const Rigid nearly_level{100 * M_PI / 180, Vec3(0, 0, 1), Vec3(0, 1, 0)};
  arm.x = nearly_level(arm.x);
  cuff.x = nearly_level(cuff.x);
  const Vec3 outwards(-std::sin(100 * M_PI / 180), std::cos(100 * M_PI / 180), 0);
  const SlipStatistics slip = after(cloth_of(cuff), cuff.x, arm, {2 * cm * outwards}, about);
  ASSERT_EQ(slip.loops.size(), 2U);
  EXPECT_NEAR(slip.loops[1].drop.last_m, 2 * cm, 1e-12) << "the outer end";
  EXPECT_NEAR(slip.loops[0].drop.last_m, -2 * cm, 1e-12) << "the inner end, from the cloth's middle";
}

TEST(Slip, IsNotAskedOfFreeHemsAndOfHolesThatNothingGoesThrough) {
  Tube wide = tube(0.153, 0.6, 1.0, 40, 8, false);
  for (Vec3& p : wide.x)
    if (p.y() < 0.65) p = Vec3(2.5 * p.x(), p.y(), 2.5 * p.z());  // its hem hangs free
  EXPECT_EQ(after(cloth_of(wide), wide.x, trunk(), {{0, -cm, 0}}, about).loops.size(), 1U);
  Tube torn = skirt();
  torn.triangles.erase(torn.triangles.begin() + 8 * 40, torn.triangles.begin() + 8 * 40 + 2);  // a square of it
  EXPECT_EQ(hem_loops(torn.triangles).size(), 3U);
  EXPECT_EQ(after(cloth_of(torn), torn.x, trunk(), {{0, -cm, 0}}, about).loops.size(), 2U);
}

TEST(Slip, IsUnknownWhereTheBodyNeverMoved) {
  SlipMeter meter(cloth_of(skirt()), trunk().triangles);
  for (int frame = 0; frame < 4; ++frame) {
    Vec3s x = skirt().x;
    for (Vec3& p : x) p.y() -= frame * cm;
    meter.add(x, trunk().x);
  }
  EXPECT_EQ(meter.statistics().first_frame, -1);
  SlipMeter without(cloth_of(skirt()), {});
  without.add(skirt().x, {});
  EXPECT_EQ(without.statistics().first_frame, -1);
}

// What settles before the body moves is no slip, and a frame that cannot be measured counts as a frame.
TEST(Slip, BeginsWhenTheBodyDoes) {
  SlipMeter meter(cloth_of(skirt()), trunk().triangles);
  const auto down = [](double by) {
    Vec3s x = skirt().x;
    for (Vec3& p : x) p.y() -= by;
    return x;
  };
  meter.add(down(0), trunk().x);
  meter.add(down(5 * cm), trunk().x);
  const Rigid aside{0, Vec3(0, 1, 0), Vec3(0.01, 0, 0)};
  meter.skip();
  meter.add(aside(down(6 * cm)), aside(trunk().x));
  EXPECT_NEAR(meter.statistics().loops.at(0).drop.last_m, 1 * cm, 1e-12);
  EXPECT_EQ(meter.statistics().loops.at(0).drop.worst_frame, 3);
}

// ---- on a person --------------------------------------------------------------------------------------------

const Mannequin& woman() {
  static const Mannequin made = make_mannequin(MannequinKind::woman);
  return made;
}

// The triangles of the woman's skin whose three corners are chosen, 3 mm off it, as one cloth.
struct Skin {
  ClothMesh mesh;
  Vec3s x, normals;
};
Skin off_the_skin(const std::function<bool(const Vec3&)>& chosen) {
  const Mannequin& m = woman();
  Vec3s normals(m.positions.size(), Vec3::Zero());
  for (const auto& [a, b, c] : m.triangles) {
    const auto at = [&](Index i) -> const Vec3& { return m.positions[static_cast<std::size_t>(i)]; };
    const Vec3 n = (at(b) - at(a)).cross(at(c) - at(a));
    for (const Index i : {a, b, c}) normals[static_cast<std::size_t>(i)] += n;
  }
  Skin skin;
  std::vector<Index> own(m.positions.size(), -1);
  for (const Triangle& t : m.triangles) {
    Triangle mine{};
    bool all = true;
    for (const Index i : t) all = all && chosen(m.positions[static_cast<std::size_t>(i)]);
    if (!all) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(t[k]);
      if (own[i] < 0) {
        own[i] = static_cast<Index>(skin.x.size());
        skin.normals.push_back(normals[i].normalized());
        skin.x.push_back(m.positions[i] + 0.003 * skin.normals.back());
      }
      mine[k] = own[i];
    }
    skin.mesh.triangles.push_back(mine);
    skin.mesh.panel.push_back(0);
  }
  skin.mesh.particle_count = static_cast<Index>(skin.x.size());
  skin.mesh.panel_names = {"skin"};
  return skin;
}

Tube woman_as_tube() { return {woman().positions, woman().triangles}; }

TEST(Slip, OfABandAtTheWaistIsTheWaistsDrop) {
  const double waist_m = waist_height_m(woman().positions, woman().triangles);
  const Skin band =
      off_the_skin([&](const Vec3& p) { return std::abs(p.y() - waist_m) < 0.08 && std::abs(p.x()) < 0.2; });
  const SlipStatistics slip = after(band.mesh, band.x, woman_as_tube(), {{0, -3 * cm, 0}, {0, -2 * cm, 0}}, about);
  EXPECT_GT(slip.waist.vertices, 30);
  EXPECT_NEAR(slip.waist.worst_m, 3 * cm, 1e-9);
  EXPECT_NEAR(slip.waist.last_m, 2 * cm, 1e-9);
  EXPECT_EQ(slip.shoulders.vertices, 0);
  ASSERT_EQ(slip.loops.size(), 2U);
  EXPECT_TRUE(slip.loops[0].holds);
}

// A paper-bag waist: the edge stands off by more than the reach, and the cloth below it holds.
TEST(Slip, WhereTheEdgeStandsOffIsThatOfWhatLiesHighest) {
  const double waist_m = waist_height_m(woman().positions, woman().triangles);
  Skin bag = off_the_skin([&](const Vec3& p) { return std::abs(p.y() - waist_m) < 0.1 && std::abs(p.x()) < 0.2; });
  double highest_m = 0;
  for (std::size_t i = 0; i < bag.x.size(); ++i) {
    if (bag.x[i].y() > waist_m + 0.06) {
      bag.x[i] += 0.08 * bag.normals[i];
    } else {
      highest_m = std::max(highest_m, bag.x[i].y());
    }
  }
  const SlipStatistics slip = after(bag.mesh, bag.x, woman_as_tube(), {{0, -6 * cm, 0}}, about);
  ASSERT_EQ(slip.loops.size(), 2U);
  EXPECT_FALSE(slip.loops[0].holds) << "the lower edge";
  EXPECT_TRUE(slip.loops[1].holds);
  EXPECT_EQ(slip.loops[1].girth_m, 0);
  EXPECT_LT(slip.loops[1].height_m, highest_m);
  EXPECT_GT(slip.loops[1].height_m, highest_m - 0.05);
  EXPECT_NEAR(slip.loops[1].drop.last_m, 6 * cm, 1e-9);
  // A patch that goes round nothing is no garment, wherever it slides.
  const Skin patch = off_the_skin([&](const Vec3& p) { return std::abs(p.y() - waist_m) < 0.05 && p.z() > 0.05; });
  for (const LoopSlip& loop : after(patch.mesh, patch.x, woman_as_tube(), {{0, -6 * cm, 0}}, about).loops)
    EXPECT_FALSE(loop.holds);
}

TEST(Slip, OfAYokeIsAlongTheSurfaceOfTheShoulders) {
  const Arms arms = find_arms(woman().positions, woman().triangles);
  ASSERT_TRUE(arms);
  const double root_m = (*arms)[0].root.y(), reach_m = (*arms)[0].root.x();
  const Skin yoke = off_the_skin([&](const Vec3& p) {
    return p.y() > root_m - 0.02 && p.y() < 0.86 * 1.72 && std::abs(p.x()) < reach_m && p.x() > 0;
  });
  ASSERT_GT(yoke.x.size(), 50U);
  const Vec3 d(0, 0, 2 * cm);
  const SlipStatistics slip = after(yoke.mesh, yoke.x, woman_as_tube(), {d}, about);
  ASSERT_GT(slip.shoulders.vertices, 20);
  // Along a surface whose normal leans forwards or backwards at most by 60 degrees from up: between half of d and all of it.
  EXPECT_GT(slip.shoulders.last_m, 0.6 * d.norm());
  EXPECT_LE(slip.shoulders.last_m, d.norm() + 1e-12);
  // Off the surface is no slip.
  const SlipStatistics lifted = after(yoke.mesh, yoke.x, woman_as_tube(), {{0, 2 * cm, 0}}, about);
  EXPECT_LT(lifted.shoulders.last_m, 0.8 * d.norm());
  const SlipStatistics sideways = after(yoke.mesh, yoke.x, woman_as_tube(), {{2 * cm, 0, 0}}, about);
  EXPECT_GT(sideways.shoulders.last_m, 0.6 * d.norm());
  // A garment that lies on the shoulders is held by them.
  const double waist_m = waist_height_m(woman().positions, woman().triangles);
  const Skin vest =
      off_the_skin([&](const Vec3& p) { return p.y() > waist_m && p.y() < 0.86 * 1.72 && std::abs(p.x()) < reach_m; });
  const SlipStatistics of_vest = after(vest.mesh, vest.x, woman_as_tube(), {d}, about);
  EXPECT_GT(of_vest.shoulders.vertices, 40);
  EXPECT_GE(of_vest.loops.size(), 2U) << "neck and waist at least";
  for (const LoopSlip& loop : of_vest.loops) EXPECT_FALSE(loop.holds) << loop.height_m;
  const SlipStatistics still = after(yoke.mesh, yoke.x, woman_as_tube(), {{0, 0, 0}}, about);
  EXPECT_NEAR(still.shoulders.last_m, 0, 1e-12);
}

}  // namespace
}  // namespace toile::internal
