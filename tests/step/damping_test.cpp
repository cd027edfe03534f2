// Damping in motion: what it leaves alone, how fast modes decay, and its two Jacobians.                       [BW98 4.5]
#include "step/explicit_reference.hpp"
#include "support/bending_stiffness.hpp"
#include "support/run_cloth.hpp"

#include <Eigen/Eigenvalues>

namespace toile::internal {
namespace {

using test::ClothRun;

TEST(DampingInMotion, RigidTranslationAndRotationOfAStrainedClothFeelNone) {
  ClothRun run(test::equilateral_sheet(0.1, 0.1, 0.02), fabric_preset("denim", "", ""));
  run.state.x = test::crumpled(run.state.x, 0.004, 8);
  Elements elements(run.model);
  const auto forces = [&](const auto& velocity) {
    for (std::size_t i = 0; i < run.state.v.size(); ++i) run.state.v[i] = velocity(run.state.x[i]);
    elements.evaluate(run.model, run.state);
    Vec3s f(run.state.x.size());
    elements.forces(f);
    return f;
  };
  const auto size = [](const Vec3s& a, const Vec3s& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
  };
  const Vec3 omega(3, -5, 2);
  const Vec3s still = forces([](const Vec3&) { return Vec3(0, 0, 0); });
  const Vec3s rigid = forces([&](const Vec3& x) -> Vec3 { return Vec3(4, 1, -2) + omega.cross(x); });
  const Vec3s other = forces([&](const Vec3& x) -> Vec3 { return omega.cwiseProduct(x); });
  EXPECT_LT(size(rigid, still), 1e-11 * size(other, still));
}

// A fabric with one stiffness only, its stiffest mode, and the true motion of it: energy falls by exp(-tau omega^2 t) over whole
// periods of omega sqrt(1 - zeta^2), zeta = tau omega/2, with the tau of that stiffness and of no other.
enum class Kind { stretch, shear, bend };

double decay(Kind kind, const Fabric& taus, BendElement element = BendElement::hinge) {  // tau that the decay belies
  Fabric fabric = taus;
  fabric.stretch_u_N_per_m = fabric.stretch_v_N_per_m = kind == Kind::stretch ? 1000 : 0;
  fabric.shear_N_per_m = kind == Kind::shear ? 100 : 0;
  fabric.bend_u_N_m = fabric.bend_v_N_m = kind == Kind::bend ? 1e-2 : 0;
  ModelOptions weightless;
  weightless.gravity_m_per_s2.setZero();
  weightless.bend_element = element;
  ClothRun run(test::equilateral_sheet(0.06, 0.06, 0.02), fabric, weightless);
  Elements elements(run.model);
  elements.evaluate(run.model, run.state);
  BlockMatrix<double> A(elements.pattern());
  const double h = 0.01;
  elements.assemble(h, A);
  const Eigen::MatrixXd once = A.to_dense();
  elements.assemble(2 * h, A);
  Eigen::MatrixXd K = (0.5 * A.to_dense() - once) / (h * h);
  if (element == BendElement::plate) {  // whose matrix is not the derivative of its forces
    const Eigen::MatrixXd across = test::bending_stiffness(run.model, run.state.x);
    K.setZero();
    for (Eigen::Index i = 0; i < across.rows(); ++i)
      for (Eigen::Index j = 0; j < across.cols(); ++j) K(3 * i + 1, 3 * j + 1) = across(i, j);
  }
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(K.rows(), K.rows());
  for (Eigen::Index i = 0; i < K.rows(); ++i) M(i, i) = run.model.mass_kg[static_cast<std::size_t>(i / 3)];
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K, M);
  const Eigen::Index top = K.rows() - 1;
  const double omega = std::sqrt(modes.eigenvalues()[top]);
  const Eigen::VectorXd mode = modes.eigenvectors().col(top).normalized();
  for (std::size_t i = 0; i < run.state.x.size(); ++i)
    run.state.x[i] += 1e-7 * mode.segment<3>(3 * static_cast<Eigen::Index>(i));

  const double tau = kind == Kind::stretch ? taus.stretch_damping_s
                     : kind == Kind::shear ? taus.shear_damping_s
                                           : taus.bend_damping_s;
  const double zeta = 0.5 * tau * omega;
  EXPECT_LT(zeta, 0.2);
  const double seconds = 4 * 2 * 3.14159265358979323846 / (omega * std::sqrt(1 - zeta * zeta));
  ExplicitReference reference(run.model, {});
  const double before = reference.energy_J(run.state);
  constexpr int steps = 800;
  for (int k = 0; k < steps; ++k) reference.step(run.state, seconds / steps, ExplicitScheme::runge_kutta_4);
  return std::log(before / reference.energy_J(run.state)) / (omega * omega * seconds);
}

TEST(DampingInMotion, StretchShearAndBendDecayEachAtItsOwnRate) {
  Fabric taus = test::linear_cotton();
  taus.stretch_damping_s = 2e-6;
  taus.shear_damping_s = 1e-5;
  taus.bend_damping_s = 4e-6;
  EXPECT_NEAR(decay(Kind::stretch, taus) / taus.stretch_damping_s, 1, 0.01);
  EXPECT_NEAR(decay(Kind::shear, taus) / taus.shear_damping_s, 1, 0.01);
  EXPECT_NEAR(decay(Kind::bend, taus) / taus.bend_damping_s, 1, 0.01);
  EXPECT_NEAR(decay(Kind::bend, taus, BendElement::plate) / taus.bend_damping_s, 1, 0.01);
}

struct Swing {
  ClothState state;
  int iterations = 0;
};
// A sheet held at two corners: let fall from the level, or hanging and given a small push.
Swing swing(DampingJacobian jacobian, double step_s, bool fall) {
  ModelOptions options;
  options.damping_jacobian = jacobian;
  test::Sheet sheet = test::equilateral_sheet(0.3, 0.3, 0.03);
  if (!fall) {
    for (Vec3& p : sheet.x) p = Vec3(p.x(), p.z(), 0);
  }
  Fabric fabric;
  fabric.shear_N_per_m = 200;  // folds that both take alike
  ClothRun run(sheet, fabric, options);
  if (!fall) {
    for (std::size_t i = 0; i < sheet.x.size(); ++i)
      run.state.v[i] = Vec3(0, 0, -sheet.x[i].y());  // 0.3 m/s at the hem
  }
  run.adaptive.step_max_s = step_s;
  run.step.pcg.tolerance = 1e-4;
  run.step.rows.cloth_cloth = false;
  run.pin(0);
  run.pin(10);
  Swing result;
  for (int f = 0; f < 9; ++f) result.iterations += run.frame().cg_iterations;
  result.state = run.state;
  return result;
}
double rms(const Vec3s& a, const Vec3s& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(DampingInMotion, BothJacobiansGiveTheSameMotionWithinTheErrorOfTheStep) {
  for (const bool fall : {false, true}) {
    const Vec3s exact = swing(DampingJacobian::gauss_newton, 1.0 / 960, fall).state.x;
    double last = 1;
    for (const double step : {1.0 / 30, fall ? 1.0 / 480 : 1.0 / 240}) {
      const Swing ours = swing(DampingJacobian::gauss_newton, step, fall),
                  paper = swing(DampingJacobian::paper, step, fall);
      const double error = rms(ours.state.x, exact), apart = rms(ours.state.x, paper.state.x);
      std::printf("%s, 1/%.0f s: %.3g mm from the true motion, %.3g mm from each other; iterations %d and %d\n",
                  fall ? "fall" : "swing", 1 / step, 1e3 * error, 1e3 * apart, ours.iterations, paper.iterations);
      EXPECT_LT(apart, (fall ? 0.5 : 0.1) * error);
      EXPECT_LT(apart, 0.5 * last);  // second order: it goes with h
      last = apart;
      if (!fall) {
        EXPECT_NEAR(paper.iterations, ours.iterations, 0.05 * ours.iterations);
      }
    }
  }
}

}  // namespace
}  // namespace toile::internal
