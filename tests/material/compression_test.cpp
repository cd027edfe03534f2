// Threads that are softer in compression than in tension.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "material/fabric.hpp"
#include "material/membrane.hpp"
#include "material/membrane_derivatives.hpp"
#include "material/random_elements.hpp"

#include <numbers>

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

// A sheet that is pushed by 5 % buckles in waves of two edges, and of 2 cm at most.
TEST(Compression, LargeTrianglesAreAsSoftAsASheetThatBucklesBetweenTheirCorners) {
  const double D = 7.3e-6, pi = std::numbers::pi;
  MembraneStiffness k{.k_u = 3000, .k_v = 2000, .k_shear = 60, .compression = 0.1, .bend = D};
  const auto push = [&](double h) {  // N/m at a shortening of 3 %, of an equilateral triangle
    const RestTriangle t = rest_triangle({Vec2(0, 0), Vec2(h, 0), Vec2(0.5 * h, 0.5 * std::sqrt(3.0) * h)});
    const std::array<Vec3, 3> x = deformed(t, Vec3(0.97, 0, 0), Vec3(0, 1.01, 0), Vec3::Zero());
    const MembraneResponse r = membrane_response(t.membrane, k, x, at_rest);
    EXPECT_NEAR(r.P_v.y() / t.membrane.scale2, 0.01 * 2000, 1e-9) << "pulled as ever";
    return -r.P_u.x() / t.membrane.scale2;
  };
  const auto of_wave = [&](double wave_m) { return D * 4 * pi * pi / (wave_m * wave_m) / 0.05; };
  const double mean = 2500;
  for (const double h : {0.005, 0.007, 0.01}) EXPECT_NEAR(push(h), 0.03 * 3000 * of_wave(2 * h) / mean, 1e-9) << h;
  for (const double h : {0.02, 0.05}) EXPECT_NEAR(push(h), push(0.01), 1e-9) << h;
  EXPECT_NEAR(push(0.002), 0.03 * 3000 * 0.1, 1e-9) << "no softer than yarns";
  k.bend *= 4;
  EXPECT_NEAR(push(0.01), 4 * 0.03 * 3000 * of_wave(0.02) / mean, 1e-9);
  k.bend = 0;
  EXPECT_NEAR(push(0.01), 0.03 * 3000 * 0.1, 1e-9);
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
