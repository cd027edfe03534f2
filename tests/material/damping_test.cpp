// Damping: what it may brake and what it may not.                                              [BW98 4.5]
#include <gtest/gtest.h>

#include "material/bend.hpp"
#include "material/membrane.hpp"
#include "material/random_elements.hpp"

namespace toile::internal {
namespace {

TEST(Damping, AStretchedClothMayTurnFreely) {
  Random random(41);
  for (int n = 0; n < 1000; ++n) {
    const RestTriangle t = random_rest_triangle(random);
    const MembraneStiffness k = random_stiffness(random);
    const Mat3 R = random.rotation();
    const double stretch_u = random.uniform(1, 1.5), stretch_v = random.uniform(1, 1.5);
    const std::array<Vec3, 3> x = deformed(t, stretch_u * R.col(0), stretch_v * R.col(1), random.vector(0.5));
    const Vec3 omega = 5 * random.direction(), velocity = random.vector(2);
    const MembraneResponse rigid = membrane_response(t.membrane, k, x, rigid_velocity(x, velocity, omega));
    const MembraneResponse other = membrane_response(t.membrane, k, x, random.vectors<3>(5 * t.size));
    const double size = other.Q_u.norm() + other.Q_v.norm();
    ASSERT_GT(size, 0);
    EXPECT_LT(rigid.Q_u.norm() + rigid.Q_v.norm(), 1e-10 * size);

    // In the matrix too: D v is the force that the linear system will brake with.
    Eigen::Matrix<double, 6, 1> turning;
    turning << omega.cross(rigid.w_u), omega.cross(rigid.w_v);
    EXPECT_LT((dense(rigid.D) * turning).norm(), 1e-12 * dense(rigid.D).norm() * turning.norm());
  }
}

// Each condition alone: its damping force is its relaxation time times its Gauss-Newton stiffness times v.  At rest
// lengths the stiffness *is* Gauss-Newton, which gives the reference without a second formula.
TEST(Damping, IsTheRelaxationTimeTimesTheStiffnessAtRest) {
  Random random(42);
  for (int n = 0; n < 1000; ++n) {
    RestTriangle t = random_rest_triangle(random);
    const Mat3 R = random.rotation();
    const Vec3 w_u = t.membrane.b_u * R.col(0), w_v = t.membrane.b_v * R.col(1);
    const std::array<Vec3, 3> x = deformed(t, w_u, w_v, Vec3::Zero()), v = random.vectors<3>(1);
    MembraneStiffness k = random_stiffness(random);
    const bool stretch = n % 2 == 0;
    if (stretch)
      k.k_shear = 0;
    else
      k.k_u = k.k_v = 0;
    const double tau = stretch ? k.tau_stretch : k.tau_shear;
    const MembraneResponse r = membrane_response(t.membrane, k, x, v);
    const Eigen::VectorXd expected = -tau * expand(t, r.K) * flat(v);
    ASSERT_GT(expected.norm(), 0);
    EXPECT_LT((flat(corner_forces(t, r.Q_u, r.Q_v)) - expected).norm(), 1e-10 * expected.norm());
    EXPECT_LT((dense(r.D) - tau * dense(r.K)).norm(), 1e-12 * dense(r.D).norm());
  }
}

// Away from rest as well: the matrix the solver gets and the force it starts from are the same operator.
TEST(Damping, ForceIsMinusTheDampingMatrixTimesVelocity) {
  Random random(43);
  for (int n = 0; n < 1000; ++n) {
    const RestTriangle t = random_rest_triangle(random);
    const auto [w_u, w_v] = random_deformation(random);
    const std::array<Vec3, 3> x = deformed(t, w_u, w_v, Vec3::Zero()), v = random.vectors<3>(1);
    const MembraneResponse r = membrane_response(t.membrane, random_stiffness(random), x, v);
    const Eigen::VectorXd expected = -expand(t, r.D) * flat(v);
    ASSERT_GT(expected.norm(), 0);
    EXPECT_LT((flat(corner_forces(t, r.Q_u, r.Q_v)) - expected).norm(), 1e-10 * expected.norm());
    EXPECT_LE(expected.dot(flat(v)), 0);  // takes energy out, never puts it in
  }
}

TEST(Damping, OfBendIsTheRelaxationTimeTimesItsGaussNewtonStiffness) {
  Random random(44);
  for (int n = 0; n < 1000; ++n) {
    const std::array<Vec3, 4> x = hinge_at(random, random.uniform(-3, 3)), v = random.vectors<4>(1);
    const BendRest rest{.kappa_N_m = random.uniform(1e-6, 1e-4), .tau_s = random.uniform(1e-3, 5e-3), .theta_0 = 0.3};
    const BendResponse r = bend_response(rest, x, v);
    const Eigen::VectorXd g = flat(r.g);
    const Eigen::VectorXd expected = -rest.tau_s * rest.kappa_N_m * g * g.dot(flat(v));
    ASSERT_GT(expected.norm(), 0);
    EXPECT_LT((-r.damping * g - expected).norm(), 1e-10 * expected.norm());

    const BendResponse rigid = bend_response(rest, x, rigid_velocity(x, random.vector(2), 5 * random.direction()));
    EXPECT_LT(std::abs(rigid.damping), 1e-10 * std::abs(rest.tau_s * rest.kappa_N_m) * g.norm());
  }
}

// One mode of one thread with mass m: x'' = -(k/m)(x + tau x'), whose decay rate is k tau / (2 m).
TEST(Damping, RelaxationTimeSetsTheRateOfDecay) {
  const RestTriangle t = rest_triangle({Vec2(0, 0), Vec2(0.01, 0), Vec2(0, 0.01)});
  const MembraneStiffness k{.k_u = 1000, .k_v = 1000, .k_shear = 100, .tau_stretch = 2e-3, .tau_shear = 4e-3};
  const std::array<Vec3, 3> x = deformed(t, Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3::Zero());
  const std::array<Vec3, 3> v = {Vec3::Zero(), Vec3(1, 0, 0), Vec3::Zero()};  // stretches the warp alone
  const MembraneResponse r = membrane_response(t.membrane, k, x, v);
  const double per_rate = t.area * 1000 * 2e-3;  // N m per unit of d|w_u|/dt
  EXPECT_NEAR(r.Q_u.x(), per_rate * (1 / 0.01), 1e-12);
  EXPECT_EQ(r.Q_v.norm(), 0);
}

}  // namespace
}  // namespace toile::internal
