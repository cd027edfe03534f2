// The conditions of the paper: every derivative against finite differences, and what no internal force may do.
// The typed cases run on each condition in `Conditions`; add yours there together with a Sample.
#include "material/condition.hpp"

#include <gtest/gtest.h>

#include "material/bend_condition.hpp"
#include "material/random_elements.hpp"
#include "material/shear.hpp"
#include "material/stretch.hpp"
#include "support/finite_difference.hpp"

namespace toile::internal {
namespace {

constexpr int configurations = 1000;

template <class T>
struct Sample;  // rest data, a state away from rest, and the length on which C changes

template <>
struct Sample<StretchCondition> {
  StretchCondition::Rest rest;
  std::array<Vec3, 3> x;
  double length = 0;
  explicit Sample(Random& random) {
    const RestTriangle t = random_rest_triangle(random);
    const auto [w_u, w_v] = random_deformation(random);
    rest = {t.alpha, t.beta, t.size, Vec2(t.membrane.b_u, t.membrane.b_v)};
    x = deformed(t, w_u, w_v, random.vector(0.5));
    length = t.size * std::min(w_u.norm(), w_v.norm());
  }
};

template <>
struct Sample<ShearCondition> {
  ShearCondition::Rest rest;
  std::array<Vec3, 3> x;
  double length = 0;
  explicit Sample(Random& random) {
    const RestTriangle t = random_rest_triangle(random);
    const auto [w_u, w_v] = random_deformation(random);
    rest = {t.alpha, t.beta, t.size};
    x = deformed(t, w_u, w_v, random.vector(0.5));
    length = t.size;
  }
};

template <>
struct Sample<BendCondition> {
  BendCondition::Rest rest;
  std::array<Vec3, 4> x;
  double length = 0;
  explicit Sample(Random& random) {
    rest = {random.uniform(-1, 1)};
    x = hinge_at(random, random.uniform(-3, 3));
    length = 0.1 * (x[1] - x[0]).norm();
  }
};

template <std::size_t M>
ConditionStiffness<M> some_stiffness(Random& random) {
  ConditionStiffness<M> s;
  for (std::size_t m = 0; m < M; ++m) {
    s.k[m] = random.uniform(1, 10);
    s.k_d[m] = s.k[m] * random.uniform(1e-3, 5e-3);
  }
  return s;
}

template <class T>
class Conditions : public testing::Test {};

using AllConditions = testing::Types<StretchCondition, ShearCondition, BendCondition>;
struct ConditionName {
  template <class T>
  static std::string GetName(int) {
    return std::string(T::name);
  }
};
TYPED_TEST_SUITE(Conditions, AllConditions, ConditionName);

TYPED_TEST(Conditions, FirstDerivativeMatchesFiniteDifferences) {
  constexpr std::size_t N = TypeParam::particles, M = TypeParam::components;
  Random random(11);
  for (int n = 0; n < configurations; ++n) {
    const Sample<TypeParam> sample(random);
    const auto value = TypeParam::evaluate(sample.rest, sample.x);
    Eigen::MatrixXd exact(M, 3 * N);
    for (std::size_t m = 0; m < M; ++m) exact.row(static_cast<Eigen::Index>(m)) = flat(value.dC[m]).transpose();
    const auto C = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      const auto c = TypeParam::evaluate(sample.rest, corners<N>(x)).C;
      return Eigen::Map<const Eigen::VectorXd>(c.data(), M);
    };
    const FiniteDifference difference = finite_difference(C, flat(sample.x), sample.length);
    ASSERT_LT(relative_error(exact, difference.derivative), 1e-6)
        << "configuration " << n << " step " << difference.step;
  }
}

TYPED_TEST(Conditions, SecondDerivativeMatchesFiniteDifferencesAndIsSymmetric) {
  constexpr std::size_t N = TypeParam::particles, M = TypeParam::components;
  Random random(12);
  for (int n = 0; n < configurations; ++n) {
    const Sample<TypeParam> sample(random);
    const auto value = TypeParam::evaluate(sample.rest, sample.x);
    for (std::size_t m = 0; m < M; ++m) {
      const Eigen::MatrixXd exact = dense<N>(value.d2C[m]);
      const auto dC = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        return flat(TypeParam::evaluate(sample.rest, corners<N>(x)).dC[m]);
      };
      const FiniteDifference difference = finite_difference(dC, flat(sample.x), sample.length);
      ASSERT_LT(relative_error(exact, difference.derivative), 1e-6)
          << "configuration " << n << " step " << difference.step;
      ASSERT_LE((exact - exact.transpose()).norm(), 1e-13 * exact.norm()) << "configuration " << n;
    }
  }
}

TYPED_TEST(Conditions, RigidMotionChangesNothing) {
  constexpr std::size_t M = TypeParam::components;
  Random random(13);
  for (int n = 0; n < configurations; ++n) {
    const Sample<TypeParam> sample(random);
    const auto before = TypeParam::evaluate(sample.rest, sample.x);
    const auto after = TypeParam::evaluate(sample.rest, moved(sample.x, random.rotation(), random.vector(1)));
    double size = 0;
    for (std::size_t m = 0; m < M; ++m) size += std::abs(before.C[m]);
    EXPECT_GT(size, 0);
    for (std::size_t m = 0; m < M; ++m) EXPECT_NEAR(after.C[m], before.C[m], 1e-11 * std::max(size, 1e-2));
  }
}

TYPED_TEST(Conditions, ForceAndDampingHaveNoSumAndNoMoment) {
  Random random(14);
  for (int n = 0; n < configurations; ++n) {
    const Sample<TypeParam> sample(random);
    const auto force =
        condition_force(TypeParam::evaluate(sample.rest, sample.x), random.vectors<TypeParam::particles>(1),
                        some_stiffness<TypeParam::components>(random));
    expect_no_net_force(sample.x, force.force, "force");
    expect_no_net_force(sample.x, force.damping, "damping");
  }
}

TYPED_TEST(Conditions, ForceIsMinusTheGradientOfTheEnergy) {
  constexpr std::size_t N = TypeParam::particles, M = TypeParam::components;
  Random random(15);
  for (int n = 0; n < 200; ++n) {
    const Sample<TypeParam> sample(random);
    const ConditionStiffness<M> stiffness = some_stiffness<M>(random);
    const std::array<Vec3, N> still = rigid_velocity(sample.x, Vec3::Zero(), Vec3::Zero());
    const auto at = [&](const Eigen::VectorXd& x) {
      return condition_force(TypeParam::evaluate(sample.rest, corners<N>(x)), still, stiffness);
    };
    const auto energy = [&](const Eigen::VectorXd& x) { return Eigen::VectorXd::Constant(1, at(x).energy_J).eval(); };
    const auto force = [&](const Eigen::VectorXd& x) { return flat(at(x).force); };
    const auto exact = condition_force(TypeParam::evaluate(sample.rest, sample.x), still, stiffness);
    const Eigen::VectorXd gradient = -flat(exact.force);
    const Eigen::MatrixXd hessian = dense<N>(exact.gauss_newton) + dense<N>(exact.curvature);
    const FiniteDifference dE = finite_difference(energy, flat(sample.x), sample.length);
    const FiniteDifference df = finite_difference(force, flat(sample.x), sample.length);
    ASSERT_LT(relative_error(gradient, dE.derivative.transpose()), 1e-6) << "configuration " << n;
    ASSERT_LT(relative_error(hessian, -df.derivative), 1e-6) << "configuration " << n;
  }
}

// d is linear in v; its dx part, here by differences at fixed v, splits into the symmetric half that the paper
// keeps and  k_d dC (dC_dot/dx)^T = k_d dC (d2C v)^T,  which it drops.
TYPED_TEST(Conditions, DampingDerivativesAreThoseOfThePaper) {
  constexpr std::size_t N = TypeParam::particles, M = TypeParam::components;
  Random random(16);
  for (int n = 0; n < 200; ++n) {
    const Sample<TypeParam> sample(random);
    const ConditionStiffness<M> stiffness = some_stiffness<M>(random);
    const std::array<Vec3, N> v = random.vectors<N>(1);
    const auto value = TypeParam::evaluate(sample.rest, sample.x);
    const auto exact = condition_force(value, v, stiffness);
    const auto damping = [&](const Eigen::VectorXd& x) {
      return flat(condition_force(TypeParam::evaluate(sample.rest, corners<N>(x)), v, stiffness).damping);
    };
    Eigen::MatrixXd dropped = Eigen::MatrixXd::Zero(3 * N, 3 * N);
    for (std::size_t m = 0; m < M; ++m)
      dropped += stiffness.k_d[m] * flat(value.dC[m]) * (dense<N>(value.d2C[m]) * flat(v)).transpose();
    const FiniteDifference dd = finite_difference(damping, flat(sample.x), sample.length);
    ASSERT_LT(relative_error(dense<N>(exact.damping_dx) + dropped, -dd.derivative), 1e-6) << "configuration " << n;
    ASSERT_LT(relative_error(-dense<N>(exact.damping_dv) * flat(v), flat(exact.damping)), 1e-12);
  }
}

TYPED_TEST(Conditions, RigidVelocityIsNotDamped) {
  constexpr std::size_t N = TypeParam::particles;
  Random random(17);
  for (int n = 0; n < configurations; ++n) {
    const Sample<TypeParam> sample(random);
    const auto value = TypeParam::evaluate(sample.rest, sample.x);
    const auto stiffness = some_stiffness<TypeParam::components>(random);
    const auto rigid = condition_force(value, rigid_velocity(sample.x, random.vector(1), random.vector(5)), stiffness);
    const auto other = condition_force(value, random.vectors<N>(5), stiffness);
    EXPECT_LT(flat(rigid.damping).norm(), 1e-10 * flat(other.damping).norm());
  }
}

}  // namespace
}  // namespace toile::internal
