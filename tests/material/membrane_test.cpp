// The production kernel for stretch and shear: against finite differences, against the conditions of the paper,
// and the closed-form projection against an eigen-solver.
#include "material/membrane_batch.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "material/random_elements.hpp"
#include "material/shear.hpp"
#include "material/stretch.hpp"
#include "support/finite_difference.hpp"

namespace toile::internal {
namespace {

constexpr int configurations = 1000;
const std::array<Vec3, 3> at_rest = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // velocities

struct State {
  RestTriangle t;
  MembraneStiffness k;
  std::array<Vec3, 3> x, v;
  double length = 0;  // on which the energy changes
  explicit State(Random& random) {
    t = random_rest_triangle(random);
    k = random_stiffness(random);
    const auto [w_u, w_v] = random_deformation(random);
    x = deformed(t, w_u, w_v, random.vector(0.5));
    v = random.vectors<3>(3);
    length = t.size * std::min(w_u.norm(), w_v.norm());
  }
  // E(x') beyond what a linear step from x knows of it.
  double energy_beyond(const std::array<Vec3, 3>& end, Projection projection) const {
    MembraneRestBatch rest;
    MembraneStateBatch state;
    for (std::size_t lane = 0; lane < batch_size; ++lane) rest.set(lane, t.membrane, k, {0, 1, 2});
    evaluate_membranes(&rest, 0, 1, x.data(), v.data(), &state);
    std::array<double, batch_size> beyond;
    membrane_energy_beyond({&rest, &state, 0, 1, {DampingJacobian::gauss_newton, projection}}, end.data(),
                           beyond.data());
    return beyond[0];
  }
  MembraneResponse response(Projection projection = Projection::semidefinite,
                            DampingJacobian damping = DampingJacobian::gauss_newton) const {
    return membrane_response(t.membrane, k, x, v, damping, projection);
  }
};

// The reference: sum of the two conditions.
struct Reference {
  ConditionForce<3> stretch, shear;
  explicit Reference(const State& s) {
    const double scale = std::sqrt(s.t.membrane.scale2);
    const Vec2 b(s.t.membrane.b_u, s.t.membrane.b_v);
    const MembraneStiffness& k = s.k;
    stretch = condition_force(StretchCondition::evaluate({s.t.alpha, s.t.beta, scale, b}, s.x), s.v,
                              ConditionStiffness<2>{{k.k_u, k.k_v}, {k.tau_stretch * k.k_u, k.tau_stretch * k.k_v}});
    shear = condition_force(ShearCondition::evaluate({s.t.alpha, s.t.beta, scale}, s.x), s.v,
                            ConditionStiffness<1>{{k.k_shear}, {k.tau_shear * k.k_shear}});
  }
};

Matrix6 eigen_clamped(const Matrix6& K) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(K);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

// The stiffness of one condition alone, before and after projection.
template <class Member>
std::pair<Matrix6, Matrix6> alone(State s, Member only, DampingJacobian damping) {
  const double k = s.k.*only;
  s.k.k_u = s.k.k_v = s.k.k_shear = 0;
  s.k.*only = k;
  return {dense(s.response(Projection::none, damping).K), dense(s.response(Projection::semidefinite, damping).K)};
}

TEST(Membrane, ForceIsMinusTheGradientOfTheEnergy) {
  Random random(21);
  for (int n = 0; n < configurations; ++n) {
    const State s(random);
    const MembraneResponse r = s.response();
    const auto energy = [&](const Eigen::VectorXd& x) {
      State moved_state = s;
      moved_state.x = corners<3>(x);
      return Eigen::VectorXd::Constant(1, moved_state.response().energy_J).eval();
    };
    const Eigen::VectorXd gradient = -flat(corner_forces(s.t, r.P_u, r.P_v));
    const FiniteDifference dE = finite_difference(energy, flat(s.x), s.length);
    ASSERT_LT(relative_error(gradient, dE.derivative.transpose()), 1e-6)
        << "configuration " << n << " step " << dE.step;
  }
}

TEST(Membrane, UnprojectedStiffnessIsMinusTheDerivativeOfTheForce) {
  Random random(22);
  for (int n = 0; n < configurations; ++n) {
    const State s(random);
    const Eigen::MatrixXd K = expand(s.t, s.response(Projection::none).K);
    const auto force = [&](const Eigen::VectorXd& x) {
      State moved_state = s;
      moved_state.x = corners<3>(x);
      const MembraneResponse r = moved_state.response();
      return flat(corner_forces(s.t, r.P_u, r.P_v));
    };
    const FiniteDifference df = finite_difference(force, flat(s.x), s.length);
    ASSERT_LT(relative_error(K, -df.derivative), 1e-6) << "configuration " << n << " step " << df.step;
  }
}

TEST(Membrane, EqualsTheConditionsOfThePaper) {
  Random random(23);
  for (int n = 0; n < configurations; ++n) {
    State s(random);
    if (n % 2 == 1) s.t.membrane.scale2 = s.t.area * s.t.area;  // paper scaling
    const Reference paper(s);
    const MembraneResponse r = s.response(Projection::none);
    const double energy = paper.stretch.energy_J + paper.shear.energy_J;
    ASSERT_GT(energy, 0);
    EXPECT_NEAR(r.energy_J, energy, 1e-11 * energy);
    const Eigen::VectorXd force = flat(paper.stretch.force) + flat(paper.shear.force);
    const Eigen::VectorXd damping = flat(paper.stretch.damping) + flat(paper.shear.damping);
    const double force_size = flat(paper.stretch.force).norm() + flat(paper.shear.force).norm();
    EXPECT_LT((flat(corner_forces(s.t, r.P_u, r.P_v)) - force).norm(), 1e-11 * force_size);
    EXPECT_LT(relative_error(flat(corner_forces(s.t, r.Q_u, r.Q_v)), damping), 1e-11);

    const Eigen::MatrixXd gauss_newton = dense<3>(paper.stretch.gauss_newton) + dense<3>(paper.shear.gauss_newton);
    const Eigen::MatrixXd curvature = dense<3>(paper.stretch.curvature) + dense<3>(paper.shear.curvature);
    const Eigen::MatrixXd dv = dense<3>(paper.stretch.damping_dv) + dense<3>(paper.shear.damping_dv);
    const Eigen::MatrixXd dx = dense<3>(paper.stretch.damping_dx) + dense<3>(paper.shear.damping_dx);
    EXPECT_LT(relative_error(expand(s.t, r.K), gauss_newton + curvature), 1e-10);
    EXPECT_LT(relative_error(expand(s.t, r.D), dv), 1e-11);
    const MembraneResponse with_dx = s.response(Projection::none, DampingJacobian::paper);
    EXPECT_LT(relative_error(expand(s.t, with_dx.K), gauss_newton + curvature + dx), 1e-10);
  }
}

TEST(Membrane, ClosedFormProjectionEqualsClampingTheEigenvalues) {
  Random random(24);
  int changed = 0;
  for (int n = 0; n < configurations; ++n) {
    const State s(random);
    for (const DampingJacobian damping : {DampingJacobian::gauss_newton, DampingJacobian::paper}) {
      Matrix6 sum = Matrix6::Zero();
      for (const auto only : {&MembraneStiffness::k_u, &MembraneStiffness::k_v, &MembraneStiffness::k_shear}) {
        const auto [raw, projected] = alone(s, only, damping);
        const Matrix6 clamped = eigen_clamped(raw);
        ASSERT_LT((projected - clamped).norm(), 1e-12 * raw.norm()) << "configuration " << n;
        if ((clamped - raw).norm() > 1e-3 * raw.norm()) ++changed;
        sum += clamped;
      }
      ASSERT_LT(relative_error(dense(s.response(Projection::semidefinite, damping).K), sum), 1e-12);
    }
  }
  EXPECT_GT(changed, configurations);  // the projection had work to do
}

// Directions in which the eigenvectors of the closed form meet or vanish.
TEST(Membrane, ProjectionHoldsWhereEigenvaluesMeet) {
  Random random(25);
  State s(random);
  const Vec3 w = random.direction();
  const Vec3 across = w.cross(Vec3(0.1, 0.7, -0.3)).normalized();
  const std::vector<std::pair<Vec3, Vec3>> frames = {{w, w},
                                                     {w, -w},
                                                     {w, across},
                                                     {w, 0.5 * w},
                                                     {w, 1e-9 * across},
                                                     {w, w + 1e-9 * across},
                                                     {w, -w + 1e-9 * across},
                                                     {1e-3 * w, 1e-3 * across},
                                                     {0.5 * w, 2 * across},
                                                     {w, 1e-9 * w}};
  for (const auto& [w_u, w_v] : frames) {
    s.x = deformed(s.t, w_u, w_v, Vec3::Zero());
    for (int n = 0; n < 50; ++n) {
      s.v = random.vectors<3>(n % 2 == 0 ? 3 : 30);
      for (const DampingJacobian damping : {DampingJacobian::gauss_newton, DampingJacobian::paper}) {
        const auto [raw, projected] = alone(s, &MembraneStiffness::k_shear, damping);
        ASSERT_LT((projected - eigen_clamped(raw)).norm(), 1e-12 * raw.norm());
      }
    }
  }
}

TEST(Membrane, ElementMatricesAreSemidefinite) {
  Random random(26);
  for (int n = 0; n < configurations; ++n) {
    State s(random);
    s.k.tau_stretch *= n % 3 == 0 ? 100 : 1;  // large rates as well: the damping part then rules the bracket
    s.k.tau_shear *= n % 3 == 0 ? 100 : 1;
    for (const DampingJacobian damping : {DampingJacobian::gauss_newton, DampingJacobian::paper}) {
      const MembraneResponse r = s.response(Projection::semidefinite, damping);
      for (const FMatrix* part : {&r.K, &r.D}) {
        const Eigen::MatrixXd K = expand(s.t, *part);
        EXPECT_LE((K - K.transpose()).norm(), 1e-14 * K.norm());
        const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
        ASSERT_GT(values.maxCoeff(), 0);
        ASSERT_GE(values.minCoeff(), -1e-10 * values.maxCoeff()) << "configuration " << n;
      }
    }
  }
}

TEST(Membrane, TheTrueStiffnessIsIndefiniteUnderCompression) {
  Random random(27);
  State s(random);
  s.x = deformed(s.t, Vec3(0.5, 0, 0), Vec3(0, 0.5, 0), Vec3::Zero());
  const auto values = Eigen::SelfAdjointEigenSolver<Matrix6>(dense(s.response(Projection::none).K)).eigenvalues();
  EXPECT_LT(values.minCoeff(), -0.1 * values.maxCoeff());
}

TEST(Membrane, RigidMotionChangesNothing) {
  Random random(28);
  for (int n = 0; n < configurations; ++n) {
    const State s(random);
    const MembraneResponse before = s.response();
    const Mat3 R = random.rotation();
    State other = s;
    other.x = moved(s.x, R, random.vector(1));
    other.v = moved(s.v, R, random.vector(1));  // and a common velocity
    const MembraneResponse after = other.response();
    const double force = before.P_u.norm() + before.P_v.norm(), damping = before.Q_u.norm() + before.Q_v.norm();
    EXPECT_NEAR(after.energy_J, before.energy_J, 1e-11 * before.energy_J);
    EXPECT_LT((after.P_u - R * before.P_u).norm() + (after.P_v - R * before.P_v).norm(), 1e-11 * force);
    EXPECT_LT((after.Q_u - R * before.Q_u).norm() + (after.Q_v - R * before.Q_v).norm(), 1e-10 * damping);
    EXPECT_LT(relative_error(after.K.uv, R * before.K.uv * R.transpose()), 1e-9);
  }
}

TEST(Membrane, ForcesHaveNoSumAndNoMoment) {
  Random random(29);
  for (int n = 0; n < configurations; ++n) {
    const State s(random);
    const MembraneResponse r = s.response();
    expect_no_net_force(s.x, corner_forces(s.t, r.P_u, r.P_v), "elastic");
    expect_no_net_force(s.x, corner_forces(s.t, r.Q_u, r.Q_v), "damping");
  }
}

TEST(Membrane, IsAtRestWhereTheThreadsHaveTheirRestLength) {
  Random random(30);
  for (int n = 0; n < configurations; ++n) {
    State s(random);
    const Mat3 R = random.rotation();
    s.x = deformed(s.t, s.t.membrane.b_u * R.col(0), s.t.membrane.b_v * R.col(1), random.vector(0.5));
    const MembraneResponse r = s.response();
    const double stiffness = s.t.area * (s.k.k_u + s.k.k_v + s.k.k_shear);
    EXPECT_LT(r.P_u.norm() + r.P_v.norm(), 1e-12 * stiffness);
    EXPECT_LT(r.energy_J, 1e-24 * stiffness);
  }
}

// Swapping corners (cyclically, so that the triangle keeps its side) is a matter of names.
TEST(Membrane, CornersMayBeNumberedFromAny) {
  Random random(31);
  for (int n = 0; n < 100; ++n) {
    const State s(random);
    State turned = s;
    turned.t = rest_triangle({s.t.uv[1], s.t.uv[2], s.t.uv[0]});
    turned.t.membrane.b_u = s.t.membrane.b_u;
    turned.t.membrane.b_v = s.t.membrane.b_v;
    turned.x = {s.x[1], s.x[2], s.x[0]};
    turned.v = {s.v[1], s.v[2], s.v[0]};
    const MembraneResponse a = s.response(), b = turned.response();
    EXPECT_NEAR(a.energy_J, b.energy_J, 1e-12 * a.energy_J);
    EXPECT_LT((a.P_u - b.P_u).norm(), 1e-11 * (a.P_u.norm() + a.P_v.norm()));
    EXPECT_LT((a.Q_v - b.Q_v).norm(), 1e-10 * (a.Q_u.norm() + a.Q_v.norm()));
  }
}

double energy_with_pattern_turned(const RestTriangle& t, const MembraneStiffness& k, const std::array<Vec3, 3>& x,
                                  double angle) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const RestTriangle turned = rest_triangle({turn * t.uv[0], turn * t.uv[1], turn * t.uv[2]});
  return membrane_response(turned.membrane, k, x, at_rest).energy_J;
}

// k_u = k_v = 2 k_shear is the isotropic setting: k/2 (e_uu^2 + e_vv^2 + 2 e_uv^2) for small strains e, the squared
// norm of the strain tensor.  A quarter turn changes nothing at any strain.
TEST(Membrane, ALinearStepKnowsTheEnergyUpToThirdOrder) {
  Random random(31);
  for (int i = 0; i < configurations; ++i) {
    const State s(random);
    const MembraneResponse at = s.response(Projection::none);
    const double least = std::min(at.w_u.norm(), at.w_v.norm());
    // so short that no thread passes from slack to taut
    const double way =
        1e-2 * std::min(std::abs(at.w_u.norm() - s.t.membrane.b_u), std::abs(at.w_v.norm() - s.t.membrane.b_v));
    const Vec3 u = random.vector(way), v = random.vector(way);
    const double third = (s.k.k_u + s.k.k_v + s.k.k_shear) * s.t.membrane.scale2 * std::pow(u.norm() + v.norm(), 3);
    const double beyond = s.energy_beyond(deformed(s.t, at.w_u + u, at.w_v + v, s.x[0]), Projection::none);
    EXPECT_LT(std::abs(beyond),
              2 * third * std::max(1 / (least * least), at.w_u.norm() + at.w_v.norm()) + 1e-13 * at.energy_J)
        << i;
    EXPECT_NEAR(s.energy_beyond(s.x, Projection::none), 0, 1e-12 * at.energy_J);
  }
}

TEST(Membrane, ATurnAlongTangentsMakesEnergyThatTheStepDoesNotKnow) {
  Random random(32);
  State s(random);
  s.t.membrane.b_u = s.t.membrane.b_v = 1;
  s.x = deformed(s.t, Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3::Zero());
  const double angle = 0.2, longer = std::sqrt(1 + angle * angle) - 1;
  const auto beyond = [&](const Vec3& w_u) {
    return s.energy_beyond(deformed(s.t, w_u, Vec3(0, 1, 0), Vec3::Zero()), Projection::semidefinite);
  };
  const double unit = s.k.k_u * s.t.membrane.scale2;
  EXPECT_NEAR(beyond(Vec3(1, 0, angle)), 0.5 * unit * longer * longer, 1e-12 * unit);
  EXPECT_NEAR(beyond(Vec3(1.01, 0, 0)), 0, 1e-12 * unit) << "along the thread the step is exact";
}

TEST(Membrane, AnIsotropicClothDoesNotFeelHowThePatternIsTurned) {
  Random random(32);
  const MembraneStiffness isotropic{.k_u = 1000, .k_v = 1000, .k_shear = 500};
  const MembraneStiffness woven{.k_u = 1000, .k_v = 1000, .k_shear = 50};
  double largest_difference_woven = 0;
  for (int n = 0; n < 100; ++n) {
    RestTriangle t = random_rest_triangle(random);
    t.membrane.b_u = t.membrane.b_v = 1;
    const auto strained = [&](double strain) {
      Vec3 w_u(1, 0, 0), w_v(0, 1, 0);
      Random same(100 + static_cast<std::uint64_t>(n));
      w_u.head<2>() += strain * same.vector(1).head<2>();
      w_v.head<2>() += strain * same.vector(1).head<2>();
      return deformed(t, w_u, w_v, Vec3::Zero());
    };
    const double angle = random.uniform(0, 6);
    const auto difference = [&](const MembraneStiffness& k, double strain) {
      const double straight = energy_with_pattern_turned(t, k, strained(strain), 0);
      EXPECT_GT(straight, 0);
      return std::abs(energy_with_pattern_turned(t, k, strained(strain), angle) - straight) / straight;
    };
    EXPECT_LT(difference(isotropic, 1e-3), 0.02);
    EXPECT_LT(difference(isotropic, 1e-5), 2e-4);  // falls with the strain: only the linear theory is isotropic
    largest_difference_woven = std::max(largest_difference_woven, difference(woven, 1e-5));

    const auto [w_u, w_v] = random_deformation(random);
    const std::array<Vec3, 3> x = deformed(t, w_u, w_v, Vec3::Zero());
    const double energy = energy_with_pattern_turned(t, woven, x, 0);
    EXPECT_NEAR(energy_with_pattern_turned(t, woven, x, std::numbers::pi / 2), energy, 1e-11 * energy);
  }
  EXPECT_GT(largest_difference_woven, 0.3);
}

// A piece of cloth under one strain, cut into 4^n congruent triangles.
double energy_of_refined(const std::array<Vec2, 3>& uv, int refinements, bool paper_scaling) {
  if (refinements > 0) {
    const Vec2 m01 = (uv[0] + uv[1]) / 2, m12 = (uv[1] + uv[2]) / 2, m20 = (uv[2] + uv[0]) / 2;
    const std::array<std::array<Vec2, 3>, 4> parts = {
        {{uv[0], m01, m20}, {m01, uv[1], m12}, {m20, m12, uv[2]}, {m01, m12, m20}}};
    double sum = 0;
    for (const auto& part : parts) sum += energy_of_refined(part, refinements - 1, paper_scaling);
    return sum;
  }
  RestTriangle t = rest_triangle(uv);
  if (paper_scaling) t.membrane.scale2 = t.area * t.area;
  const std::array<Vec3, 3> x = deformed(t, Vec3(1.1, 0.02, 0), Vec3(0.05, 0.97, 0.1), Vec3::Zero());
  return membrane_response(t.membrane, {.k_u = 3000, .k_v = 2000, .k_shear = 200}, x, at_rest).energy_J;
}

TEST(Membrane, RefinementKeepsTheEnergyAndPaperScalingQuartersIt) {
  const std::array<Vec2, 3> uv = {Vec2(0, 0), Vec2(0.04, 0.01), Vec2(0.01, 0.05)};
  const double coarse = energy_of_refined(uv, 0, false), coarse_1998 = energy_of_refined(uv, 0, true);
  ASSERT_GT(coarse, 0);
  for (int n = 1; n <= 4; ++n) {
    EXPECT_NEAR(energy_of_refined(uv, n, false), coarse, 1e-12 * coarse);
    const double expected = coarse_1998 / std::pow(4, n);
    EXPECT_NEAR(energy_of_refined(uv, n, true), expected, 1e-12 * expected);
  }
}

// A strip pulled along the warp: force per width k_u (|w_u| - 1), and in pure shear by phi the shear force per width
// k_s sin phi cos phi.
TEST(Membrane, StiffnessIsForcePerWidth) {
  const RestTriangle t = rest_triangle({Vec2(0, 0), Vec2(0.02, 0), Vec2(0, 0.03)});
  const MembraneStiffness k{.k_u = 3000, .k_v = 2000, .k_shear = 200};
  const MembraneResponse pulled =
      membrane_response(t.membrane, k, deformed(t, Vec3(1.01, 0, 0), Vec3(0, 1, 0), Vec3::Zero()), at_rest);
  EXPECT_NEAR(pulled.P_u.x() / t.area, 3000 * 0.01, 1e-9);
  const double phi = 0.3;  // threads turn without stretching
  const MembraneResponse sheared = membrane_response(
      t.membrane, k, deformed(t, Vec3(1, 0, 0), Vec3(std::sin(phi), std::cos(phi), 0), Vec3::Zero()), at_rest);
  EXPECT_NEAR(sheared.P_u.y() / t.area, 200 * std::sin(phi) * std::cos(phi), 1e-9);
}

TEST(Membrane, ACollapsedTriangleGivesNumbers) {
  Random random(33);
  State s(random);
  const std::vector<std::pair<Vec3, Vec3>> frames = {{Vec3::Zero(), Vec3::Zero()},
                                                     {1e-30 * Vec3(1, 2, 3), 1e-30 * Vec3(-1, 2, 0)},
                                                     {Vec3::Zero(), Vec3(0, 1, 0)},
                                                     {1e-30 * Vec3(1, 0, 0), Vec3(0, 1, 0)},
                                                     {Vec3(1, 0, 0), Vec3::Zero()},
                                                     {1e-160 * Vec3(1, 2, 3), 1e-160 * Vec3(3, 1, 1)},
                                                     {Vec3(1, 0, 0), Vec3(1, 0, 0)},
                                                     {1e-300 * Vec3(1, 2, 3), 1e-310 * Vec3(3, 1, 1)},
                                                     {1e-75 * Vec3(1, 2, 3), 1e-75 * Vec3(1, 2, 3)}};
  for (const auto& [w_u, w_v] : frames) {
    s.x = deformed(s.t, w_u, w_v, Vec3::Zero());
    for (const DampingJacobian damping : {DampingJacobian::gauss_newton, DampingJacobian::paper}) {
      for (const Projection projection : {Projection::semidefinite, Projection::none}) {
        const MembraneResponse r = s.response(projection, damping);
        EXPECT_TRUE(std::isfinite(r.energy_J));
        for (const Vec3* part : {&r.w_u, &r.w_v, &r.P_u, &r.P_v, &r.Q_u, &r.Q_v}) EXPECT_TRUE(part->allFinite());
        EXPECT_TRUE(dense(r.D).allFinite());
        EXPECT_TRUE(dense(r.K).allFinite()) << w_u.norm() << ' ' << w_v.norm();
        if (projection == Projection::none) continue;
        const auto values = Eigen::SelfAdjointEigenSolver<Matrix6>(dense(r.K)).eigenvalues();
        EXPECT_GE(values.minCoeff(), -1e-10 * std::max(values.maxCoeff(), 1e-300));
      }
    }
  }
}

}  // namespace
}  // namespace toile::internal
