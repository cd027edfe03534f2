// Threads that are softer in compression than in tension.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "material/fabric.hpp"
#include "material/membrane.hpp"
#include "material/membrane_derivatives.hpp"
#include "material/random_elements.hpp"

namespace toile::internal {
namespace {

const std::array<Vec3, 3> at_rest = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};

TEST(Compression, ForceAndStiffnessAreTheDerivativesOfTheEnergyAwayFromTheKink) {
  Random random(71);
  int squeezed = 0;
  for (int n = 0; n < 1000; ++n) {
    const RestTriangle t = random_rest_triangle(random);
    MembraneStiffness k = random_stiffness(random);
    k.compression = random.uniform(0.03, 1);
    const auto [w_u, w_v] = random_deformation(random);
    const double to_kink = std::min(std::abs(w_u.norm() - t.membrane.b_u), std::abs(w_v.norm() - t.membrane.b_v));
    if (to_kink < 0.05) continue;
    squeezed += w_u.norm() < t.membrane.b_u ? 1 : 0;
    const std::array<Vec3, 3> x = deformed(t, w_u, w_v, Vec3::Zero());
    const double length = t.size * std::min({w_u.norm(), w_v.norm(), to_kink});
    SCOPED_TRACE(n);
    expect_derivatives_of_the_energy(t, k, x, length, 1e-6);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(squeezed, 100);
}

TEST(Compression, IsThePartThatIsAskedForAndContinuousAtRest) {
  const RestTriangle t = rest_triangle({Vec2(0, 0), Vec2(0.01, 0), Vec2(0, 0.01)});
  MembraneStiffness k{.k_u = 1000, .k_v = 1000, .k_shear = 100, .tau_stretch = 2e-3, .tau_shear = 2e-3};
  const auto response = [&](double stretch, double rate) {
    const std::array<Vec3, 3> v = {Vec3::Zero(), Vec3(0.01 * rate, 0, 0), Vec3::Zero()};
    return membrane_response(t.membrane, k, deformed(t, Vec3(stretch, 0, 0), Vec3(0, 1, 0), Vec3::Zero()), v);
  };
  const MembraneResponse stiff = response(0.9, 3), tension = response(1.1, 3);
  k.compression = 0.1;
  EXPECT_NEAR(response(0.9, 3).P_u.x(), 0.1 * stiff.P_u.x(), 1e-12);
  EXPECT_NEAR(response(0.9, 3).energy_J, 0.1 * stiff.energy_J, 1e-12);
  EXPECT_EQ(response(1.1, 3).P_u, tension.P_u);
  EXPECT_EQ(response(0.9, 3).Q_u, stiff.Q_u);  // damping is that of tension: nothing jumps as a thread goes slack
  const double e = 1e-9;
  EXPECT_LT((response(1 + e, 3).P_u - response(1 - e, 3).P_u).norm(), 1e-6 * tension.P_u.norm());
  EXPECT_LT((response(1 + e, 3).Q_u - response(1 - e, 3).Q_u).norm(), 1e-6 * tension.Q_u.norm());
}

TEST(Compression, ElementMatricesStaySemidefinite) {
  Random random(72);
  for (int n = 0; n < 1000; ++n) {
    const RestTriangle t = random_rest_triangle(random);
    MembraneStiffness k = random_stiffness(random);
    k.compression = random.uniform(0.01, 1);
    const auto [w_u, w_v] = random_deformation(random);
    const std::array<Vec3, 3> x = deformed(t, w_u, w_v, Vec3::Zero()), v = random.vectors<3>(3);
    for (const DampingJacobian jacobian : {DampingJacobian::gauss_newton, DampingJacobian::paper}) {
      ASSERT_GT(least_eigenvalue(membrane_response(t.membrane, k, x, v, jacobian).K), -1e-9) << n;
    }
  }
}

TEST(Compression, RatiosBeyondOneOrAtZeroAreRefused) {
  for (const double ratio : {0.0, -1.0, 1.5}) {
    Fabric fabric;
    fabric.compression_ratio = ratio;
    EXPECT_THROW(check_fabric(fabric, "scene.json:3", "/cloth/0/fabric"), InputError) << ratio;
  }
}

}  // namespace
}  // namespace toile::internal
