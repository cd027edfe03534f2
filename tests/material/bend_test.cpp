// Hinges: the angle and its sign, the moment, the guard, and what the stiffness means for a sheet.
// The derivatives of theta are checked in condition_test.cpp.
#include "material/bend.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "material/bend_condition.hpp"
#include "material/random_elements.hpp"
#include "support/finite_difference.hpp"

namespace toile::internal {
namespace {

constexpr int configurations = 1000;
const std::array<Vec3, 4> at_rest = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // velocities

TEST(Bend, TheAngleIsTheOneTheHingeWasFoldedBy) {
  Random random(51);
  for (int n = 0; n < configurations; ++n) {
    const double theta = random.uniform(-3.1, 3.1);
    EXPECT_NEAR(hinge_angle(hinge_at(random, theta)), theta, 1e-11);
  }
}

TEST(Bend, ARidgeSeenFromTheRightSideIsPositive) {
  const double drop = 0.2;
  const Vec3 x0(0, 0, 0), x1(1, 0, 0), a(0.5, 1, -drop), b(0.5, -1, -drop);  // the right side faces +z
  EXPECT_NEAR(hinge_angle({x0, x1, a, b}), 2 * std::atan(drop), 1e-14);
  // The same hinge walked from its other end is the same hinge.
  EXPECT_NEAR(hinge_angle({x1, x0, b, a}), 2 * std::atan(drop), 1e-14);
  // Seen from the wrong side it is a valley.
  EXPECT_NEAR(hinge_angle({x1, x0, a, b}), -2 * std::atan(drop), 1e-14);
}

TEST(Bend, ResponseIsThatOfTheConditionOfThePaper) {
  Random random(52);
  for (int n = 0; n < configurations; ++n) {
    const std::array<Vec3, 4> x = hinge_at(random, random.uniform(-3, 3)), v = random.vectors<4>(1);
    const BendRest rest{.kappa_N_m = 1e-5, .tau_s = 2e-3, .theta_0 = random.uniform(-1, 1)};
    const BendResponse r = bend_response(rest, x, v);
    const auto paper = condition_force(BendCondition::evaluate({rest.theta_0}, x), v,
                                       ConditionStiffness<1>{{rest.kappa_N_m}, {rest.tau_s * rest.kappa_N_m}});
    ASSERT_FALSE(r.degenerate());
    EXPECT_NEAR(r.energy_J(rest), paper.energy_J, 1e-12 * paper.energy_J);
    EXPECT_LT(relative_error(-r.moment * flat(r.g), flat(paper.force)), 1e-12);
    EXPECT_LT(relative_error(-r.damping * flat(r.g), flat(paper.damping)), 1e-9);
    EXPECT_LT(relative_error(rest.kappa_N_m * flat(r.g) * flat(r.g).transpose(), dense<4>(paper.gauss_newton)), 1e-12);
  }
}

TEST(Bend, MomentIsTheDerivativeOfTheEnergyAndHasNoNetForce) {
  Random random(53);
  for (int n = 0; n < configurations; ++n) {
    const std::array<Vec3, 4> x = hinge_at(random, random.uniform(-3, 3));
    const BendRest rest{.kappa_N_m = 1e-5, .theta_0 = random.uniform(-1, 1)};
    const BendResponse r = bend_response(rest, x, at_rest);
    const auto energy = [&](const Eigen::VectorXd& at) {
      return Eigen::VectorXd::Constant(1, bend_response(rest, corners<4>(at), at_rest).energy_J(rest)).eval();
    };
    const FiniteDifference dE = finite_difference(energy, flat(x), 0.1 * (x[1] - x[0]).norm());
    ASSERT_LT(relative_error(r.moment * flat(r.g), dE.derivative.transpose()), 1e-6) << "configuration " << n;
    std::array<Vec3, 4> force;
    for (std::size_t i = 0; i < 4; ++i) force[i] = -r.moment * r.g[i];
    expect_no_net_force(x, force, "bend");
  }
}

TEST(Bend, IsAtRestFlatAndCurved) {
  Random random(54);
  for (int n = 0; n < configurations; ++n) {
    const double theta = n % 2 == 0 ? 0 : random.uniform(-2.5, 2.5);
    const std::array<Vec3, 4> x = hinge_at(random, theta);
    const BendRest rest{.kappa_N_m = 1, .theta_0 = theta};
    EXPECT_NEAR(bend_response(rest, x, at_rest).moment, 0, 1e-11);
    EXPECT_GT(std::abs(bend_response({.kappa_N_m = 1, .theta_0 = theta + 0.1}, x, at_rest).moment), 0.09);
  }
}

TEST(Bend, TheLeftOutPartIsIndefiniteAndTheKeptOneIsNot) {
  Random random(55);
  int indefinite = 0;
  for (int n = 0; n < configurations; ++n) {
    const std::array<Vec3, 4> x = hinge_at(random, random.uniform(-3, 3));
    const auto paper = condition_force(BendCondition::evaluate({0.0}, x), at_rest, ConditionStiffness<1>{{1}, {0}});
    const Eigen::MatrixXd kept = dense<4>(paper.gauss_newton), left_out = dense<4>(paper.curvature);
    using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
    const Eigen::VectorXd values = Solver(kept).eigenvalues();
    EXPECT_GE(values.minCoeff(), -1e-10 * values.maxCoeff());
    const Eigen::VectorXd full = Solver(kept + left_out).eigenvalues();
    if (full.minCoeff() < -1e-3 * full.maxCoeff()) ++indefinite;
  }
  EXPECT_GT(indefinite, configurations * 9 / 10);
}

TEST(Bend, AnEquilateralHingeHasTheEigenvaluesOfTheTheoryPage) {
  // Unit edges, flat at rest, folded by 0.5 rad, kappa = 1.
  const double height = std::sqrt(3.0) / 2, theta = 0.5;
  const std::array<Vec3, 4> x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, height, 0),
                                 Vec3(0.5, -height * std::cos(theta), -height * std::sin(theta))};
  const auto paper = condition_force(BendCondition::evaluate({0.0}, x), at_rest, ConditionStiffness<1>{{1}, {0}});
  const Eigen::MatrixXd full = dense<4>(paper.gauss_newton) + dense<4>(paper.curvature);
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues();
  const std::array<double, 12> expected = {-1.840, -0.796, -0.177, -0.133, 0, 0, 0, 0, 0.613, 1.116, 1.361, 5.027};
  for (Eigen::Index i = 0; i < 12; ++i) EXPECT_NEAR(values[i], expected[static_cast<std::size_t>(i)], 0.001);
}

// A triangle that is crushed to a share of its height: the gradient is that of the angle until the least height, and then falls to zero with it, without
// a torque on the whole.
TEST(Bend, ACrushedTriangleHasNoEndlessGradient) {
  const double height_m = 0.015;
  const double area_m2 = 0.5 * 0.02 * height_m;
  const BendRest rest{.kappa_N_m = 1e-2, .tau_s = 2e-3, .least_normal2 = least_normal2(area_m2, 2 * area_m2)};
  const BendRest endless{.kappa_N_m = 1e-2, .tau_s = 2e-3};
  std::array<Vec3, 4> v = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)};
  for (const std::size_t crushed : {2u, 3u}) {
    const auto at_share = [&](double share) {
      std::array<Vec3, 4> x = {Vec3(0, 0, 0), Vec3(0.02, 0, 0), Vec3(0.008, height_m, 0), Vec3(0.011, -0.6, 0.8)};
      x[3].tail<2>() *= height_m;
      x[crushed].tail<2>() *= share;
      return x;
    };
    const auto g_of = [&](double share) { return bend_response(rest, at_share(share), v).g; };
    EXPECT_EQ(flat(g_of(0.051)), flat(bend_response(endless, at_share(0.051), v).g));
    EXPECT_EQ(flat(g_of(1)), flat(bend_response(endless, at_share(1), v).g));
    const double most = flat(g_of(0.05)).norm();
    for (const double share : {0.04, 0.01, 1e-3}) {
      const BendResponse r = bend_response(rest, at_share(share), v);
      EXPECT_FALSE(r.degenerate());
      EXPECT_NEAR(flat(r.g).norm(), most * share / 0.05, 0.02 * most);
      double theta_dot = 0;
      Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
      for (std::size_t i = 0; i < 4; ++i) {
        theta_dot += r.g[i].dot(v[i]);
        force += r.g[i];
        torque += at_share(share)[i].cross(r.g[i]);
      }
      EXPECT_NEAR(r.damping, rest.tau_s * rest.kappa_N_m * theta_dot, 1e-12 * most);
      EXPECT_LT(force.norm(), 1e-12 * most);
      EXPECT_LT(torque.norm(), 1e-10 * height_m * most);
    }
  }
}

TEST(Bend, AHingeWithoutAnAngleIsSkippedAndSaysSo) {
  const Vec3 x0(0, 0, 0), x1(1, 0, 0), b(0.5, -1, 0);
  const BendRest rest{.kappa_N_m = 1, .tau_s = 1, .theta_0 = 1};
  const std::array<Vec3, 4> v = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)};
  const std::vector<std::array<Vec3, 4>> hinges = {
      {x0, x1, Vec3(0.5, 0.4e-4, 0), b},                 // flat apex: sines 0.8e-4
      {x0, x1, Vec3(1e5, 1, 1), b},                      // sharp at both ends
      {x0, x1, Vec3(1.5, 0, 0), b},                      // on the line
      {x0, x1, x0, b},                                   // apex on the hinge
      {x0, x0, Vec3(0.5, 1, 0), b},                      // no edge
      {x0, x0, x0, x0},                                  // a point
      {x0, x1, Vec3(0.5, 1, 0), Vec3(0.5, -0.4e-4, 0)},  // the other triangle
      {1e-120 * x0, 1e-120 * x1, 1e-120 * Vec3(0.5, 1, 0), 1e-120 * b}};
  for (const auto& x : hinges) {
    const BendResponse r = bend_response(rest, x, v);
    EXPECT_TRUE(r.degenerate());
    EXPECT_EQ(r.moment, 0);
    EXPECT_EQ(r.damping, 0);
    EXPECT_EQ(r.energy_J(rest), 0);
    EXPECT_EQ(flat(r.g).norm(), 0);
    EXPECT_TRUE(std::isfinite(hinge_angle(x)));
  }
  EXPECT_FALSE(bend_response(rest, {x0, x1, Vec3(0.5, 1.2e-4, 0), b}, v).degenerate());
  const BendResponse tiny = bend_response(rest, {1e-30 * x0, 1e-30 * x1, 1e-30 * Vec3(0.5, 1, 0.3), 1e-30 * b},
                                          v);  // absurd, but it has an angle
  EXPECT_FALSE(tiny.degenerate());
  EXPECT_TRUE(flat(tiny.g).allFinite() && std::isfinite(tiny.moment) && std::isfinite(tiny.damping));
}

TEST(Bend, WeightIsCappedForSlivers) {
  EXPECT_NEAR(bend_weight(0.01, 2e-5, 3e-5), 2, 1e-15);
  EXPECT_EQ(bend_weight(0.01, 1e-7, 1e-7), 20);
  EXPECT_EQ(bend_weight(0.01, 0, 0), 20);
}

// The threads that bend are those that run across the edge: a fold along the weft bends the warp.
TEST(Bend, APapersHingeMixesBothStiffnessesByTheDirectionOfItsEdge) {
  const double k_u = 8e-5, k_v = 2e-5;
  EXPECT_DOUBLE_EQ(paper_bend_stiffness(Vec2(2, 0), k_u, k_v), k_u);
  EXPECT_DOUBLE_EQ(paper_bend_stiffness(Vec2(0, -3), k_u, k_v), k_v);
  EXPECT_NEAR(paper_bend_stiffness(Vec2(std::sqrt(3.0), 1), k_u, k_v), 0.75 * k_u + 0.25 * k_v, 1e-18);
  EXPECT_DOUBLE_EQ(paper_bend_stiffness(Vec2::Zero(), k_u, k_v), (k_u + k_v) / 2);
}

TEST(Bend, RigidityIsThatOfTheThreadsAcrossTheEdge) {
  const double D_u = 8e-5, D_v = 2e-5;  // roots 2 : 1, so z = (cos 2b - cos(6b)/4)/2
  EXPECT_NEAR(hinge_rigidity(Vec2(3, 0), D_u, D_v), 4e-5 * 1.375 / 0.625, 1e-18);
  EXPECT_NEAR(hinge_rigidity(Vec2(0, -3), D_u, D_v), 4e-5 * 0.625 / 1.375, 1e-18);
  EXPECT_NEAR(hinge_rigidity(Vec2(std::sqrt(3.0), 1), D_u, D_v), 4e-5 * 1.375 / 0.625, 1e-18);   // 30 degrees
  EXPECT_NEAR(hinge_rigidity(Vec2(-1, std::sqrt(3.0)), D_u, D_v), 4e-5 * 0.625 / 1.375, 1e-18);  // 120 degrees
  EXPECT_NEAR(hinge_rigidity(Vec2(1, -1), D_u, D_v), 4e-5, 1e-18);                               // the bias
  EXPECT_NEAR(hinge_rigidity(Vec2::Zero(), D_u, D_v), 4e-5, 1e-18);
  EXPECT_EQ(hinge_rigidity(Vec2(1, 0), 0, 0), 0);
  Random random(56);
  for (int n = 0; n < 100; ++n) {
    const Vec2 any = random.vector(1).head<2>();
    EXPECT_EQ(hinge_rigidity(any, D_u, D_u), D_u);  // isotropic cloth has no direction
    // Above the largest ratio, and with a thread that resists nothing: raised; positive and at most twice the stiffer.
    EXPECT_DOUBLE_EQ(hinge_rigidity(any, D_u, 0), hinge_rigidity(any, D_u, D_u / largest_bend_ratio));
    EXPECT_GT(hinge_rigidity(any, 0, D_u), 0);
    EXPECT_LT(hinge_rigidity(any, 0, D_u), 2 * D_u);
  }
}

TEST(Bend, AnEquilateralSheetHasBothRigiditiesAtAnyAngleToFirstOrder) {
  // theta of the hinge at b is -h (S_nn - S_tt/3).  Rolled about one axis the rigidity is the sum of D q^2, q = cos^2 b - sin^2 b/3;
  // a strip free to curve sideways has the compliance 8/9 sum of cos^4 b/D.  To first order in the difference the mean of both is
  // asked for; each alone then depends on how the triangles lie by a sixteenth of it.
  const double part = 1e-4, D = 1e-5;  // D_u and D_v differ from D by this part of it
  for (double turn = 0; turn < 3.2; turn += 0.1) {
    double rolled[2] = {0, 0}, soft[2] = {0, 0};  // along u, v
    for (int k = 0; k < 3; ++k) {
      const double b = turn + k * std::acos(0.5), c2 = std::cos(b) * std::cos(b), s2 = 1 - c2;
      const double hinge = hinge_rigidity(Vec2(std::cos(b), std::sin(b)), D * (1 + part), D * (1 - part));
      rolled[0] += hinge * (c2 - s2 / 3) * (c2 - s2 / 3);
      rolled[1] += hinge * (s2 - c2 / 3) * (s2 - c2 / 3);
      soft[0] += 8.0 / 9 * c2 * c2 / hinge;
      soft[1] += 8.0 / 9 * s2 * s2 / hinge;
    }
    for (int thread = 0; thread < 2; ++thread) {
      const double asked = thread == 0 ? part : -part;
      const double roll = rolled[thread] / D - 1, strip = 1 / (soft[thread] * D) - 1;
      EXPECT_NEAR(0.5 * (roll + strip), asked, 1e-3 * part) << turn;
      EXPECT_NEAR(roll, asked, 0.13 * part) << turn;
      EXPECT_NEAR(strip, asked, 0.13 * part) << turn;
    }
  }
}

// The energy of a sheet with the small curvature z = c/2 p^T S p, per area and per D c^2/2.  A lattice has three
// hinges per particle, given by their edge and the two apexes, all relative to one end.
struct LatticeHinge {
  Vec2 edge, apex_a, apex_b;
};

double energy_over_D(const std::vector<LatticeHinge>& hinges, double area_per_particle, const Mat2& S) {
  const double c = 1e-4;
  const auto lift = [&](const Vec2& p) { return Vec3(p.x(), p.y(), 0.5 * c * p.dot(S * p)); };
  double energy = 0;
  for (const LatticeHinge& h : hinges) {
    const double kappa = bend_weight(h.edge.norm(), area_per_particle / 2, area_per_particle / 2);
    const std::array<Vec3, 4> x = {lift(Vec2::Zero()), lift(h.edge), lift(h.apex_a), lift(h.apex_b)};
    const BendRest rest{.kappa_N_m = kappa};
    energy += bend_response(rest, x, at_rest).energy_J(rest);
  }
  return energy / area_per_particle / (0.5 * c * c);
}

struct Range {
  double low = 1e9, high = 0;
};

// Rolled up in one direction after another, or twisted about one axis after another.
Range over_directions(const std::vector<LatticeHinge>& hinges, double area_per_particle, bool twist) {
  Range range;
  for (int n = 0; n < 24; ++n) {
    const double angle = n * std::numbers::pi / 24;
    const Vec2 s(std::cos(angle), std::sin(angle)), t(-s.y(), s.x());
    const Mat2 S = twist ? Mat2(s * t.transpose() + t * s.transpose()) : Mat2(s * s.transpose());
    const double energy = energy_over_D(hinges, area_per_particle, S);
    range.low = std::min(range.low, energy);
    range.high = std::max(range.high, energy);
  }
  return range;
}

// The theory page derives both numbers: 1 rolled, 8/3 twisted, where a plate has 2 (1 - nu).
TEST(Bend, AnEquilateralSheetHasTheRigidityDInEveryDirectionAndTwistsAtEightThirds) {
  const double height = std::sqrt(3.0) / 2;
  const Vec2 a(1, 0), b(0.5, height), c(-0.5, height);
  const std::vector<LatticeHinge> hinges = {{a, b, -c}, {b, c, a}, {c, -a, b}};
  const Range rolled = over_directions(hinges, height, false), twisted = over_directions(hinges, height, true);
  EXPECT_NEAR(rolled.low, 1, 1e-5);
  EXPECT_NEAR(rolled.high, 1, 1e-5);
  EXPECT_NEAR(twisted.low, 8.0 / 3, 1e-5);
  EXPECT_NEAR(twisted.high, 8.0 / 3, 1e-5);
}

TEST(Bend, AGridWithOneDiagonalIsFourTimesStifferInOneDirection) {
  const Vec2 a(1, 0), b(0, 1), d(1, 1);
  const std::vector<LatticeHinge> hinges = {{a, d, -b}, {b, -a, d}, {d, b, a}};
  const Range rolled = over_directions(hinges, 1, false);
  EXPECT_NEAR(rolled.low, 0.75, 1e-5);
  EXPECT_NEAR(rolled.high, 3, 1e-5);
}

}  // namespace
}  // namespace toile::internal
