// Plates: exact for constant curvature on any triangles, whatever the rigidities; and what a step's matrix takes for them.
#include "assembly/plate_moments.hpp"

#include "assembly/elements.hpp"
#include "core/parallel.hpp"
#include "support/bending_stiffness.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace toile::internal {
namespace {

// A sheet whose triangles are of all shapes: inner particles moved by up to 0.3 of an edge.
test::Sheet irregular_sheet(std::uint64_t seed, double move = 0.3) {
  constexpr double edge = 0.02, size = 0.12;
  test::Sheet sheet = test::equilateral_sheet(size, size, edge);
  test::Random random(seed);
  std::vector<Vec2> shift(sheet.x.size());
  double least_z = 0;
  for (const Vec3& p : sheet.x) least_z = std::min(least_z, p.z());
  for (std::size_t i = 0; i < shift.size(); ++i) {
    const Vec3& p = sheet.x[i];
    const bool inside = p.x() > 1e-9 && p.x() < size - 1e-9 && p.z() < -1e-9 && p.z() > least_z + 1e-9;
    shift[i] = inside ? Vec2(move * edge * random(-1, 1), move * edge * random(-1, 1)) : Vec2::Zero();
    sheet.x[i] += Vec3(shift[i].x(), 0, -shift[i].y());
  }
  for (std::size_t t = 0; t < sheet.mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) sheet.mesh.uv[t][c] += shift[at(sheet.mesh.triangles[t][c])];
  return sheet;
}

Fabric orthotropic() {
  Fabric fabric;
  fabric.bend_u_N_m = 2e-5;
  fabric.bend_v_N_m = 1e-6;  // 20 : 1
  fabric.bend_poisson = 0.25;
  fabric.bend_uv_N_m = 3e-6;
  return fabric;
}

Eigen::VectorXd heights(const test::Sheet& sheet, const Mat2& S) {
  Eigen::VectorXd z(static_cast<Eigen::Index>(sheet.x.size()));
  for (std::size_t i = 0; i < sheet.x.size(); ++i) {
    const Vec2 p(sheet.x[i].x(), -sheet.x[i].z());
    z[static_cast<Eigen::Index>(i)] = 0.5 * p.dot(S * p);
  }
  return z;
}

// F^-1, moments of unit angles.
Eigen::MatrixXd dense_moments(const ClothModel& model) {
  PlateMoments plates(model);
  const auto n = static_cast<Eigen::Index>(model.bend.size());
  Eigen::MatrixXd H(n, n);
  std::vector<double> turned(model.bend.size(), 0), moment(model.bend.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    turned[static_cast<std::size_t>(j)] = 1;
    plates.solve(turned, moment);
    turned[static_cast<std::size_t>(j)] = 0;
    H.col(j) = Eigen::Map<Eigen::VectorXd>(moment.data(), n);
  }
  return H;
}

TEST(Plates, ConstantCurvatureIsExactOnAnyTriangles) {
  const Fabric fabric = orthotropic();
  const Mat3 C = bending_rigidity(fabric);
  const test::Sheet sheet = irregular_sheet(3);
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  const Eigen::MatrixXd G = test::angle_of_heights(model, sheet.x);
  const std::vector<std::array<Index, 3>> sides = hinges_of_sides(model.topology);
  test::Random random(4);
  for (int n = 0; n < 20; ++n) {
    Mat2 S;
    S << random(-1, 1), random(-1, 1), 0, random(-1, 1);
    S(1, 0) = S(0, 1);
    const Vec3 M = C * Vec3(S(0, 0), S(1, 1), 2 * S(0, 1));
    Mat2 moment;
    moment << M[0], M[2], M[2], M[1];
    const Eigen::VectorXd theta = G * heights(sheet, S);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(theta.size());
    double energy = 0, area = 0;
    for (std::size_t t = 0; t < sides.size(); ++t) {
      const std::array<Vec2, 3>& uv = model.mesh.uv[t];
      Vec3 m;  // L n.M n of all three sides, those at the sheet's edge too
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 e = uv[(k + 1) % 3] - uv[k], across(e.y(), -e.x());
        m[static_cast<Eigen::Index>(k)] = across.dot(moment * across) / e.norm();
      }
      const Vec3 phi = model.plate_compliance[t] * m;
      for (std::size_t k = 0; k < 3; ++k)
        if (sides[t][k] >= 0) sum[sides[t][k]] += phi[static_cast<Eigen::Index>(k)];
      energy += 0.5 * m.dot(phi);
      area += 0.5 * std::abs((uv[1] - uv[0]).x() * (uv[2] - uv[0]).y() - (uv[1] - uv[0]).y() * (uv[2] - uv[0]).x());
    }
    // Valleys where the surface rises: the sign of theta is the other way.  A thousandth: the limit on slivers is in F.
    EXPECT_LT((sum + theta).cwiseAbs().maxCoeff(), 4e-3 * theta.cwiseAbs().maxCoeff());
    EXPECT_NEAR(energy / area, 0.5 * M.dot(Vec3(S(0, 0), S(1, 1), 2 * S(0, 1))), 4e-3 * energy / area);
  }
}

TEST(Plates, MomentsSolveTheSystemOnAnyNumberOfThreads) {
  const Fabric fabric = orthotropic();
  const ClothModel model = build_model(irregular_sheet(5).mesh, {&fabric, 1});
  const Eigen::MatrixXd H = dense_moments(model);
  EXPECT_LT((H - H.transpose()).norm(), 1e-5 * H.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (H + H.transpose())).eigenvalues().minCoeff(), 0);
  const Eigen::MatrixXd F = test::compliance_of_hinges(model);
  EXPECT_LT((F * H - Eigen::MatrixXd::Identity(H.rows(), H.cols())).cwiseAbs().maxCoeff(), 1e-4);

  std::vector<double> turned(model.bend.size()), first;
  test::Random random(6);
  for (double& angle : turned) angle = random(-1, 1);
  for (const int threads : {1, 2, 5}) {
    with_threads(threads, [&] {
      std::vector<double> moment(turned.size());
      PlateMoments(model).solve(turned, moment);
      if (first.empty()) first = moment;
      EXPECT_EQ(first, moment);
    });
  }
}

TEST(Plates, AStepsMatrixIsStiffEnoughForThem) {
  for (const double move : {0.0, 0.3, 0.45}) {
    for (const double nu : {0.0, 0.3, 0.5}) {
      Fabric fabric;
      fabric.bend_poisson = nu;
      for (const double ratio : {1.0, 20.0}) {
        fabric.bend_v_N_m = fabric.bend_u_N_m / ratio;
        const ClothModel model = build_model(irregular_sheet(7, move).mesh, {&fabric, 1});
        Eigen::MatrixXd H = dense_moments(model);
        Eigen::VectorXd bound(H.rows());
        for (Eigen::Index h = 0; h < bound.size(); ++h)
          bound[h] = std::sqrt(model.bend[static_cast<std::size_t>(h)].plate_N_m);
        H = bound.cwiseInverse().asDiagonal() * (0.5 * (H + H.transpose())) * bound.cwiseInverse().asDiagonal();
        const double most = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(H).eigenvalues().maxCoeff();
        EXPECT_LE(most, 1 + 1e-6) << move << ", nu " << nu << ", " << ratio << " : 1";
        EXPECT_GT(most, 0.5) << "stiffer than it need be";
      }
    }
  }
}

TEST(Plates, ForcesAreMinusTheGradientOfTheEnergyAndTurnNothing) {
  const Fabric fabric = orthotropic();
  const test::Sheet sheet = irregular_sheet(8);
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  Elements elements(model);
  ClothState state{test::crumpled(sheet.x, 0.004, 9), Vec3s(sheet.x.size(), Vec3::Zero())};
  const auto energy = [&] {
    elements.evaluate(model, state);
    return elements.energy_J();
  };
  Vec3s f(state.x.size());
  energy();
  elements.forces(f);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    force += f[i];
    torque += state.x[i].cross(f[i]);
    size += f[i].norm();
  }
  EXPECT_LT(force.norm(), 1e-12 * size);
  EXPECT_LT(torque.norm(), 1e-12 * size);
  test::Random random(10);
  for (int n = 0; n < 10; ++n) {
    Vec3s direction(f.size());
    double expected = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      direction[i] = random.vector(1);
      expected -= f[i].dot(direction[i]);
    }
    constexpr double step = 1e-7;
    double difference = 0;
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t i = 0; i < f.size(); ++i) state.x[i] += sign * step * direction[i];
      difference += sign * energy();
      for (std::size_t i = 0; i < f.size(); ++i) state.x[i] -= sign * step * direction[i];
    }
    EXPECT_NEAR(difference / (2 * step), expected, 1e-5 * std::abs(expected) + 1e-9 * size);
  }
}

TEST(Plates, DampingIsTheMomentOfTheRate) {
  Fabric fabric = orthotropic();
  fabric.stretch_damping_s = fabric.shear_damping_s = 0;
  const test::Sheet sheet = irregular_sheet(13);
  const ClothModel model = build_model(sheet.mesh, {&fabric, 1});
  Elements elements(model);
  ClothState state{test::crumpled(sheet.x, 0.004, 14), Vec3s(sheet.x.size(), Vec3::Zero())};
  Vec3s still(state.x.size()), moving(state.x.size());
  elements.evaluate(model, state);
  elements.forces(still);
  test::Random random(15);
  for (Vec3& v : state.v) v = random.vector(0.5);
  elements.evaluate(model, state);
  elements.forces(moving);
  double power = 0;
  for (std::size_t i = 0; i < still.size(); ++i) power += (moving[i] - still[i]).dot(state.v[i]);
  Eigen::VectorXd rate(static_cast<Eigen::Index>(model.bend.size()));
  for (std::size_t h = 0; h < model.bend.size(); ++h)
    rate[static_cast<Eigen::Index>(h)] = elements.bend(static_cast<Index>(h)).theta_dot;
  const double expected = -fabric.bend_damping_s * rate.dot(dense_moments(model) * rate);
  EXPECT_NEAR(power, expected, 1e-4 * std::abs(expected));
  EXPECT_LT(power, 0);
}

TEST(Plates, APanelOfTwiceTheStiffnessHasTwiceTheMoments) {
  const Fabric fabric = orthotropic();
  ClothModel model = build_model(irregular_sheet(11).mesh, {&fabric, 1});
  std::vector<double> turned(model.bend.size()), once(turned.size()), twice(turned.size());
  test::Random random(12);
  for (double& angle : turned) angle = random(-1, 1);
  PlateMoments plates(model);
  plates.solve(turned, once);
  const double bound = model.bend.front().plate_N_m;
  set_panel_stiffness(model, 0, {.bend = 2});
  plates.pack(model);
  plates.solve(turned, twice);
  for (std::size_t h = 0; h < once.size(); ++h) EXPECT_NEAR(twice[h], 2 * once[h], 1e-9 * std::abs(once[h]) + 1e-15);
  EXPECT_NEAR(model.bend.front().plate_N_m, 2 * bound, 1e-12 * bound);
}

}  // namespace
}  // namespace toile::internal
