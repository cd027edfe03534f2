// The rank-one term of a spring against the force it stands for, written out from its definition.
#include "assembly/implicit_row.hpp"

#include "support/sheets.hpp"

#include <gtest/gtest.h>

namespace toile::internal {
namespace {

TEST(ImplicitRow, IsTheForceOfItsSpringAtTheEndOfTheStep) {
  test::Random random(71);
  for (int n = 0; n < 200; ++n) {
    const double h = random(0.001, 0.03);
    Vec3s v(6), y(6), dv(6);
    for (Vec3s* vectors : {&v, &y, &dv}) {
      for (Vec3& vector : *vectors) vector = random.vector(1);
    }
    LinearSpring spring;
    const std::size_t particles = 1 + static_cast<std::size_t>(n % 4);
    for (std::size_t k = 0; k < particles; ++k) {
      spring.particle[k] = static_cast<Index>((static_cast<std::size_t>(n) + k) % 6);
      spring.weight[k] = random(-1, 1);
    }
    spring.direction = random.vector(1).normalized();
    spring.force_N = random(-1, 1);
    spring.stiffness_N_per_m = random(0, 1000);
    spring.damping_N_s_per_m = random(0, 10);
    spring.body_displacement_m = random(-0.01, 0.01);

    double length = -spring.body_displacement_m, rate = -spring.body_displacement_m / h, impulse = 0;
    for (std::size_t k = 0; k < particles; ++k) {
      const auto i = static_cast<std::size_t>(spring.particle[k]);
      const Vec3 g = spring.weight[k] * spring.direction;
      length += g.dot(h * (v[i] + dv[i]) + y[i]);
      rate += g.dot(v[i] + dv[i]);
      impulse += g.dot(dv[i]);
    }
    const double force = spring.force_N - spring.stiffness_N_per_m * length - spring.damping_N_s_per_m * rate;
    const ImplicitRow row = implicit_row(spring, h, v, y);
    EXPECT_NEAR(row.beta - row.a * impulse, h * force, 1e-12 * (1 + std::abs(row.beta) + row.a));
    EXPECT_EQ(row.particle, spring.particle);
    EXPECT_EQ(row.weight, spring.weight);
    EXPECT_EQ(row.direction, spring.direction);
  }
}

}  // namespace
}  // namespace toile::internal
