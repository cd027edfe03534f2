// How fast a small oscillation dies by the integrator alone: backward Euler's own damping, and no other.
//
//   a mode of angular frequency w:  amplitude after N steps of h = (1 + a w^2 h^2)^(-N/2)
//
// a = 1 for hinges by themselves.  Of plates a step's matrix has only a diagonal (assembly/plate_moments.hpp): a is what that has for the
// mode's stiffness, over the stiffness.
//
// The mode is the first of a strip held at one end, without gravity and damping; its amplitude is the root of its energy.
#include "support/bending_stiffness.hpp"
#include "support/run_cloth.hpp"
#include "validation/figures.hpp"

#include <Eigen/Eigenvalues>

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Figures;
using test::Sheet;

constexpr double pi = 3.14159265358979323846;

struct Mode {
  double omega;           // rad/s
  double in_matrix;       // what the matrix of a step has for its stiffness, over that
  std::vector<double> y;  // [particle] of largest entry 1
};

// The lowest mode out of the plane, lumped masses.
Mode lowest_mode(const ClothRun& run) {
  const auto n = static_cast<Eigen::Index>(run.state.x.size());
  const Eigen::MatrixXd K_bend = test::bending_stiffness(run.model, run.state.x);
  Eigen::MatrixXd K = K_bend, M = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) M(i, i) = run.model.mass_kg[static_cast<std::size_t>(i)];
  const double stiff = 1e6 * K.diagonal().maxCoeff();
  for (const Pin& pin : run.world.pins) K(pin.particle, pin.particle) += stiff;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solved(K, M);
  const Eigen::VectorXd shape = solved.eigenvectors().col(0) / solved.eigenvectors().col(0).cwiseAbs().maxCoeff();
  const double in_matrix =
      shape.dot(test::bending_in_matrix(run.model, run.state.x) * shape) / shape.dot(K_bend * shape);
  return {std::sqrt(solved.eigenvalues()[0]), in_matrix, {shape.data(), shape.data() + n}};
}

struct Strip : ClothRun {
  Strip(double D, BendElement element)
      : ClothRun(test::equilateral_sheet(0.04, 0.16, 0.01), undamped(D), weightless_with(element)) {
    step.rows.cloth_cloth = false;
    for (std::size_t i = 0; i < state.x.size(); ++i) {
      if (-state.x[i].z() < 0.01) pin(static_cast<Index>(i));
    }
  }
  static ModelOptions weightless_with(BendElement element) {
    ModelOptions options = test::weightless();
    options.bend_element = element;
    return options;
  }
  static Fabric undamped(double D) {
    Fabric fabric = test::elastic_cotton();
    fabric.bend_u_N_m = fabric.bend_v_N_m = D;
    fabric.stretch_damping_s = fabric.shear_damping_s = fabric.bend_damping_s = 0;
    return fabric;
  }
};

struct Amplitude {
  double after_one_period, in_matrix;
};

Amplitude amplitude(double period_s, double h_s, BendElement element) {
  const double omega_at_one = lowest_mode(Strip(1, element)).omega;
  Strip run(std::pow(2 * pi / period_s / omega_at_one, 2), element);
  const Mode mode = lowest_mode(run);
  // Small against D: the sideways move stretches the strip by its square, and that energy is none of the mode's.
  const double size = 2e-5 / period_s;
  for (std::size_t i = 0; i < run.state.x.size(); ++i) run.state.x[i].y() += size * mode.y[i];
  for (const Pin& pin : run.world.pins) run.state.x[static_cast<std::size_t>(pin.particle)].y() = 0;
  Elements elements(run.model);
  const auto energy = [&] {
    elements.evaluate(run.model, run.state);
    double sum = elements.energy_J();
    for (std::size_t i = 0; i < run.state.v.size(); ++i)
      sum += 0.5 * run.model.mass_kg[i] * run.state.v[i].squaredNorm();
    return sum;
  };
  const double start = energy();
  for (long step = 0; step < std::lround(period_s / h_s); ++step) EXPECT_EQ(run.frame(h_s).steps, 1);
  EXPECT_NEAR(mode.omega * period_s / (2 * pi), 1, 1e-7);
  return {std::sqrt(energy() / start), mode.in_matrix};
}

TEST(Decay, ASmallModeDiesAsBackwardEulerSays) {
  struct Row {
    double period_s, amplitude[3];  // at steps of 1/60, 1/120, 1/240 s
  };
  Figures figures("decay"), of_plates("decay_plates");
  for (const Row& row : {Row{2, {0.85, 0.92, 0.96}}, Row{1, {0.72, 0.85, 0.92}}, Row{0.5, {0.53, 0.72, 0.85}},
                         Row{0.25, {0.30, 0.53, 0.72}}, Row{0.1, {0.11, 0.23, 0.45}}, Row{0.05, {0.08, 0.11, 0.23}}}) {
    for (const int k : {0, 1, 2}) {
      const double h = 1.0 / (60 << k), omega = 2 * pi / row.period_s;
      for (const BendElement element : {BendElement::hinge, BendElement::plate}) {
        const bool hinge = element == BendElement::hinge;
        if (!hinge && row.period_s / h < 59)
          continue;  // the energy of a mode of plates swings about the formula's by a (w h)^2
        const auto [measured, in_matrix] = amplitude(row.period_s, h, element);
        EXPECT_GE(in_matrix, 1 - 1e-12);
        EXPECT_LE(in_matrix, hinge ? 1 + 1e-12 : 2.5);
        const double s = in_matrix * omega * omega * h * h;
        const double exact = std::pow(1 + s, -0.5 * std::round(row.period_s / h));
        if (hinge) {
          EXPECT_NEAR(exact, row.amplitude[k], 0.006);  // the table, two digits
        }
        char name[48];
        std::snprintf(name, sizeof name, "period %g s, h = 1/%d s", row.period_s, 60 << k);
        (hinge ? figures : of_plates).add(name, "equilateral 10 mm", "amplitude", exact, measured);
        EXPECT_NEAR(measured / exact, 1, 0.02) << name;
      }
    }
  }
}

}  // namespace
}  // namespace toile::internal
