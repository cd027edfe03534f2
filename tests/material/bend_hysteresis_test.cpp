// Bending that stays: the loop that KES-F draws, in any direction, and a set that comes slowly.
#include "material/bend_hysteresis.hpp"

#include "material/plate.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double B = 1.2e-5, HB = 6e-4, slip = 20;

Fabric poplin() {
  Fabric fabric;
  fabric.bend_u_N_m = fabric.bend_v_N_m = B;
  fabric.bend_friction_N = HB;
  fabric.bend_friction_curvature_per_m = slip;
  return fabric;
}

// Rolled up across the direction at `angle` from the warp, as (S_uu, S_vv, 2 S_uv).
Vec3 rolled(double curvature, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return curvature * Vec3(c * c, s * s, 2 * c * s);
}

// Bends one place and says its moment across the direction of the roll.
struct Bent {
  explicit Bent(const Fabric& fabric, double direction = 0)
      : of(bend_hysteresis(fabric)), C(bending_rigidity(fabric)), angle(direction) {}
  double to(double curvature, double h_s = 1e-6) {
    const double from = now, steps = std::ceil(std::abs(curvature - from) / 0.1);
    for (double k = 1; k <= steps; ++k)
      place.follow(of, rolled(now = from + (curvature - from) * k / steps, angle), h_s);
    const Vec3 M = C * (rolled(now, angle) - place.rest(of));
    const Vec3 across = rolled(1, angle);
    return M.x() * across.x() + M.y() * across.y() + M.z() * across.z();
  }
  BendHysteresis of;
  Mat3 C;
  double angle, now = 0;
  BentCurvature place;
};

// Up, back and up again between 250 and -250 1/m, the range of the instrument.
TEST(BendHysteresis, DrawsTheLoopOfTheInstrument) {
  Bent bent(poplin());
  EXPECT_NEAR(bent.to(1), B + HB / slip, 1e-9);  // before threads slip
  const double at_50 = bent.to(50), at_150 = bent.to(150);
  EXPECT_NEAR((at_150 - at_50) / 100, B, 1e-9);  // B is read between 0.5 and 1.5 1/cm
  EXPECT_NEAR(at_50, B * 50 + HB, 1e-8);
  bent.to(250);
  const double back_150 = bent.to(150), back_50 = bent.to(50);
  EXPECT_NEAR(at_50 - back_50, 2 * HB, 1e-8);  // 2HB is read at 1 1/cm
  EXPECT_NEAR(at_150 - back_150, 2 * HB, 1e-8);
  bent.to(-250);
  EXPECT_NEAR(bent.to(50), at_50, 1e-8);  // the loop closes
}

TEST(BendHysteresis, OfNoFrictionIsTheElasticCloth) {
  Fabric fabric = poplin();
  fabric.bend_friction_N = 0;
  EXPECT_FALSE(bend_hysteresis(fabric).any());
  EXPECT_EQ(friction_stiffening(fabric), 1);
  Fabric other;
  other.bend_u_N_m = other.bend_v_N_m = B;
  other.bend_friction_N = 0;
  EXPECT_EQ(bending_rigidity(fabric), bending_rigidity(other));
}

// Where nothing pushes, a bend that was far beyond slipping stays at HB/B.
TEST(BendHysteresis, LeavesABendOfTheFrictionOverTheRigidity) {
  Bent bent(poplin());
  bent.to(200);
  EXPECT_GT(bent.to(HB / B + 1), 0);
  EXPECT_LT(bent.to(HB / B - 1), 0);
}

// Whatever the direction, threads slip at one curvature, and of two bends that cross the later one is remembered.
TEST(BendHysteresis, FavoursNoDirection) {
  for (const double angle : {0.0, 0.3, 0.8, 1.2, 1.6, 2.5}) {
    Bent bent(poplin(), angle);
    bent.to(100);
    EXPECT_LT((rolled(100 - slip, angle) - bent.place.slipped).norm(), 1e-9) << angle;
    BentCurvature crossed;
    for (double k = 0; k < 100; k += 0.1) crossed.follow(bent.of, rolled(k, angle + 1), 1e-6);
    for (double k = 0; k < 100; k += 0.1)
      crossed.follow(bent.of, rolled(100, angle + 1) * (1 - k / 100) + rolled(k, angle), 1e-6);
    EXPECT_LT((rolled(100, angle) - crossed.slipped).norm(), 1.5 * slip) << angle;
    Bent straight(poplin());
    EXPECT_NEAR(bent.to(100), straight.to(100), 1e-9 + 0.01 * straight.to(100)) << angle;
  }
}

// Friction and set take work over any closed path, and never give it.
TEST(BendHysteresis, NeverGivesWork) {
  Fabric fabric = poplin();
  fabric.bend_set = 0.4;
  fabric.bend_set_s = 1;
  const Mat3 C = bending_rigidity(fabric);
  const BendHysteresis of = bend_hysteresis(fabric);
  test::Random random(7);
  for (int n = 0; n < 20; ++n) {
    std::array<Vec3, 4> corners;
    for (Vec3& corner : corners) corner = Vec3(random(-80, 80), random(-80, 80), random(-80, 80));
    BentCurvature place;
    double work = 0;
    Vec3 S = Vec3::Zero();
    const auto go = [&](const Vec3& to) {
      const Vec3 from = S;
      for (int k = 1; k <= 2000; ++k) {
        const Vec3 next = from + (to - from) * (k / 2000.0), before = C * (S - place.rest(of));
        place.follow(of, next, 1e-3);
        work += 0.5 * (before + C * (next - place.rest(of))).dot(next - S);
        S = next;
      }
    };
    for (const Vec3& corner : corners) go(corner);
    go(Vec3::Zero());
    EXPECT_GT(work, 0);
  }
}

TEST(BendHysteresis, ASetComesOverItsTimeAndGoesLikewise) {
  Fabric fabric = poplin();
  fabric.bend_friction_N = 0;
  fabric.bend_set = 0.25;
  fabric.bend_set_s = 10;
  Bent bent(fabric);
  EXPECT_NEAR(bent.to(100), B * 100, 1e-3 * B * 100);  // at once nothing gives way
  const auto hold = [&](double seconds) {
    for (int k = 0; k < 1000; ++k) bent.place.follow(bent.of, rolled(bent.now, 0), seconds / 1000);
  };
  hold(10);
  const double one_time = (bent.C * (rolled(100, 0) - bent.place.rest(bent.of))).x();
  EXPECT_NEAR(one_time, B * 100 * (1 - 0.25 * (1 - std::exp(-1.0))), 1e-3 * B * 100);
  hold(1000);
  EXPECT_NEAR((bent.C * (rolled(100, 0) - bent.place.rest(bent.of))).x(), 0.75 * B * 100, 1e-6);
  EXPECT_NEAR(bent.to(0), -0.25 * B * 100, 1e-3 * B * 100);  // unbent, it wants to be bent
  hold(1000);
  EXPECT_NEAR(bent.place.set.norm(), 0, 1e-6);
}

// The stiffer thread has the larger friction: the moments keep the ratio of the rigidities.
TEST(BendHysteresis, OfWarpAndWeftIsAsTheirRigidities) {
  Fabric fabric = poplin();
  fabric.bend_u_N_m = 4 * B;
  fabric.bend_v_N_m = B;
  fabric.bend_poisson = 0;
  Bent warp(fabric), weft(fabric, 0.5 * 3.14159265358979323846);
  EXPECT_NEAR(warp.to(100) - 4 * B * 100, 2 * HB, 1e-6);
  EXPECT_NEAR(weft.to(100) - B * 100, 0.5 * HB, 1e-6);
}

}  // namespace
}  // namespace toile::internal
