// Air on triangles: the law itself, its derivative, and what it must not do.
#include "assembly/air.hpp"

#include "assembly/elements.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace toile::internal {
namespace {

const AirOptions thick_air{{0, 0, 0}, 1.2, 1.2, 0.1};
const Vec3 breeze(3, -1, 2);

struct Blown {
  explicit Blown(std::uint64_t seed, double crumple_m = 0.008) : sheet(test::equilateral_sheet(0.1, 0.1, 0.02)) {
    const Fabric fabric;
    model = build_model(sheet.mesh, {&fabric, 1});
    elements.emplace(model);
    state.x = test::crumpled(sheet.x, crumple_m, seed);
    test::Random random(seed + 1);
    for (std::size_t i = 0; i < state.x.size(); ++i) state.v.push_back(random.vector(2));
  }
  void evaluate(const Vec3& wind) {
    air.emplace(thick_air, [=](double) { return wind; });
    ASSERT_TRUE(air->acts(0));
    air->prepare(model, *elements->pattern());
    air->evaluate(state, 0);
  }
  Vec3s forces(const Vec3& wind) {
    evaluate(wind);
    Vec3s f(state.x.size(), Vec3::Zero());
    air->add_forces(f);
    return f;
  }
  Eigen::MatrixXd damping(const Vec3& wind) {  // h D for h = 1
    evaluate(wind);
    BlockMatrix<double> A(elements->pattern());
    air->assemble(1, A);
    return A.to_dense();
  }
  test::Sheet sheet;
  ClothModel model;
  ClothState state;
  std::optional<Elements> elements;
  std::optional<Air> air;
};

TEST(Air, PressureAndFrictionOfAFlatPlateAreThoseOfTheFormula) {
  Blown plate(1, 0);
  const double area = 0.1 * 0.1;
  for (Vec3& v : plate.state.v) v = Vec3(0, -2, 0);
  Vec3 total = Vec3::Zero();
  for (const Vec3& f : plate.forces(Vec3::Zero())) total += f;
  EXPECT_LT((total - Vec3(0, 0.5 * 1.2 * 1.2 * area * 4, 0)).norm(), 1e-12);
  for (Vec3& v : plate.state.v) v = Vec3(3, 0, 4);
  total.setZero();
  for (const Vec3& f : plate.forces(Vec3::Zero())) total += f;
  EXPECT_LT((total - -0.5 * 1.2 * 0.1 * area * 5 * Vec3(3, 0, 4)).norm(), 1e-12);
}

TEST(Air, ItsMatrixIsMinusTheDerivativeOfItsForceByVelocity) {
  Blown cloth(2);
  const Eigen::MatrixXd D = cloth.damping(breeze);
  const double step = 1e-5;
  for (const std::size_t j : {std::size_t{0}, std::size_t{7}, std::size_t{20}}) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double v = cloth.state.v[j][c];
      cloth.state.v[j][c] = v + step;
      const Vec3s up = cloth.forces(breeze);
      cloth.state.v[j][c] = v - step;
      const Vec3s down = cloth.forces(breeze);
      cloth.state.v[j][c] = v;
      for (std::size_t i = 0; i < up.size(); ++i) {
        const Vec3 expected = -(up[i] - down[i]) / (2 * step);
        const Vec3 column = D.block<3, 1>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j) + c);
        EXPECT_LT((column - expected).norm(), 1e-8 * D.norm()) << i << " by " << j << ", " << c;
      }
    }
  }
}

TEST(Air, ItsMatrixIsSemidefiniteAndTakesNothingFromMotionWithTheWind) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Blown cloth(seed, 0.02);
    const Eigen::MatrixXd D = cloth.damping(breeze);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(D, Eigen::EigenvaluesOnly);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().maxCoeff());
    EXPECT_LT((D - D.transpose()).norm(), 1e-14 * D.norm());
    for (Vec3& v : cloth.state.v) v = breeze;
    for (const Vec3& f : cloth.forces(breeze)) EXPECT_EQ(f, Vec3::Zero());
  }
}

TEST(Air, NeverPushesClothFasterThanTheWind) {
  // In the frame of the wind, air takes energy: F.u <= 0 on every triangle.
  Blown cloth(3, 0.02);
  const Vec3s f = cloth.forces(breeze);
  double power = 0;
  for (std::size_t i = 0; i < f.size(); ++i) power += f[i].dot(cloth.state.v[i] - breeze);
  EXPECT_LT(power, 0);
}

TEST(Air, DampingTimesAVelocityAgreesWithTheMatrix) {
  Blown cloth(4);
  const Eigen::MatrixXd D = cloth.damping(breeze);
  test::Random random(5);
  Vec3s u(cloth.state.x.size()), f(u.size(), Vec3::Zero());
  Eigen::VectorXd dense(D.rows());
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = random.vector(1);
    dense.segment<3>(3 * static_cast<Eigen::Index>(i)) = u[i];
  }
  cloth.air->add_damping(u, f);
  const Eigen::VectorXd expected = D * dense;
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_LT((f[i] - expected.segment<3>(3 * static_cast<Eigen::Index>(i))).norm(), 1e-12 * expected.norm());
}

TEST(Air, ATriangleWithoutAreaFeelsNone) {
  Blown cloth(6);
  for (Vec3& x : cloth.state.x) x = Vec3(0.1, 0.2, 0.3);
  for (const Vec3& f : cloth.forces(breeze)) EXPECT_EQ(f, Vec3::Zero());
}

}  // namespace
}  // namespace toile::internal
