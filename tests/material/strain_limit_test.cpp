// Threads that may not get longer than a limit: a barrier in the energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "material/membrane.hpp"
#include "material/membrane_derivatives.hpp"
#include "material/random_elements.hpp"

namespace toile::internal {
namespace {

const std::array<Vec3, 3> at_rest = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};

// A thread of direction w, as long as `share` of the way to its limit.  Elastic (b < 1) counts from its length as cut.
Vec3 stretched(const Vec3& w, double b, double limit, double share) {
  return std::max(b, 1.0) * (1 + share * limit) * w.normalized();
}

TEST(StrainLimit, ForceAndStiffnessAreTheDerivativesOfTheEnergy) {
  Random random(81);
  int barriers = 0, beyond = 0;
  for (int n = 0; n < 1000; ++n) {
    const RestTriangle t = random_rest_triangle(random);
    MembraneStiffness k = random_stiffness(random);
    k.strain_limit = random.uniform(0.01, 0.2);
    const auto [direction_u, direction_v] = random_deformation(random);
    const double share_u = random.uniform(0.3, 1.3), share_v = random.uniform(0.3, 1.3);
    // Away from where the barrier begins, its stiffness has a kink, and from where it is expanded.
    const auto near_kink = [](double share) { return std::abs(share - 0.975) < 0.02 || std::abs(share - 0.5) < 0.03; };
    if (near_kink(share_u) || near_kink(share_v)) continue;
    const Vec3 w_u = stretched(direction_u, t.membrane.b_u, k.strain_limit, share_u),
               w_v = stretched(direction_v, t.membrane.b_v, k.strain_limit, share_v);
    barriers += share_u > 0.5 ? 1 : 0;
    beyond += share_u > 1 ? 1 : 0;
    const std::array<Vec3, 3> x = deformed(t, w_u, w_v, Vec3::Zero());
    const double length = 5e-3 * t.size * k.strain_limit;
    SCOPED_TRACE(n);
    expect_derivatives_of_the_energy(t, k, x, length, 1e-5);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(barriers, 300);
  EXPECT_GT(beyond, 100);
}

TEST(StrainLimit, IsNotFeltBelowHalfOfItAndHoldsAnyClothsWeightAtIt) {
  const RestTriangle t = rest_triangle({Vec2(0, 0), Vec2(0.01, 0), Vec2(0, 0.01)});
  MembraneStiffness k{.k_u = 1000, .k_v = 800, .k_shear = 100, .tau_stretch = 2e-3, .tau_shear = 2e-3};
  const auto response = [&](double stretch) {
    return membrane_response(t.membrane, k, deformed(t, Vec3(stretch, 0, 0), Vec3(0, 1, 0), Vec3::Zero()), at_rest);
  };
  const MembraneResponse free = response(1.0249), at_limit = response(1.05);
  k.strain_limit = 0.05;
  EXPECT_EQ(response(1.0249).P_u, free.P_u);
  EXPECT_EQ(response(1.0249).K.uu, free.K.uu);
  EXPECT_EQ(response(0.9).energy_J, [&] {
    MembraneStiffness none = k;
    none.strain_limit = 0;
    return membrane_response(t.membrane, none, deformed(t, Vec3(0.9, 0, 0), Vec3(0, 1, 0), Vec3::Zero()), at_rest)
        .energy_J;
  }());
  const double d = 0.025;
  EXPECT_NEAR(response(1.05).P_u.x() - at_limit.P_u.x(), 1197 * k.k_u * t.membrane.scale2 * d, 1e-7);
  // Force and stiffness are continuous where the barrier begins and where it is expanded.
  for (const double stretch : {1.025, 1.04875}) {
    const double e = 1e-11;
    EXPECT_LT((response(stretch + e).P_u - response(stretch - e).P_u).norm(), 1e-4 * k.k_u * t.membrane.scale2 * d);
    EXPECT_LT((response(stretch + e).K.uu - response(stretch - e).K.uu).norm(), 1e-4 * response(stretch).K.uu.norm());
  }
}

TEST(StrainLimit, ElementMatricesStaySemidefinite) {
  Random random(83);
  for (int n = 0; n < 1000; ++n) {
    const RestTriangle t = random_rest_triangle(random);
    MembraneStiffness k = random_stiffness(random);
    k.strain_limit = random.uniform(0.005, 0.2);
    const auto [direction_u, direction_v] = random_deformation(random);
    const std::array<Vec3, 3> x =
        deformed(t, stretched(direction_u, t.membrane.b_u, k.strain_limit, random.uniform(-1, 1.5)),
                 stretched(direction_v, t.membrane.b_v, k.strain_limit, random.uniform(-1, 1.5)), Vec3::Zero());
    ASSERT_GT(least_eigenvalue(membrane_response(t.membrane, k, x, random.vectors<3>(3)).K), -1e-9) << n;
  }
}

}  // namespace
}  // namespace toile::internal
