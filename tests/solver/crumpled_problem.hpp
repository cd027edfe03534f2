// tests/solver/crumpled_problem.hpp: a linear system as a step poses it, with its exact solution.
#pragma once
#include "assembly/elements.hpp"
#include "solver/linear_system.hpp"
#include "support/fabrics.hpp"
#include "support/sheets.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace toile::internal::test {

// A crumpled cloth's system with contact-like rows, and constraints of every kind with z different from zero.
template <class T>
struct Problem {
  explicit Problem(double h = 1.0 / 60, double crumple_m = 0.006)
      : Problem(equilateral_sheet(0.2, 0.2, 0.02), h, crumple_m) {}
  Problem(const Sheet& sheet, double h, double crumple_m)
      : model(build_model(sheet.mesh, std::array{test::linear_cotton()})),
        elements(model),
        A(elements.pattern()),
        system(A),
        constraints(model.particle_count()) {
    ClothState state{crumpled(sheet.x, crumple_m, 1), {}};
    Random random(2);
    for (std::size_t i = 0; i < state.x.size(); ++i) state.v.push_back(random.vector(0.3));
    elements.evaluate(model, state);
    for (Index i = 0; i < A.rows(); ++i) A.grounded(i) = model.mass_kg[static_cast<std::size_t>(i)] * Mat3::Identity();
    elements.assemble(h, A);
    const auto n = static_cast<std::size_t>(A.rows());
    b.resize(n);
    reference.assign(n, Vec3::Zero());
    for (std::size_t i = 0; i < n; ++i) {
      reference[i] = h * model.mass_kg[i] * Vec3(0, -9.81, 0);
      b[i] = reference[i] + model.mass_kg[i] * random.vector(1);
    }
    constraints.hold(0, Vec3(0.1, -0.2, 0.3));
    constraints.hold_along(5, Vec3(1, 2, 2) / 3, 0.25);
    constraints.hold_along(9, Vec3(0, 1, 0), -0.5);
    constraints.hold_along(9, Vec3(0.6, 0.8, 0), 0.125);
    rows.push_back({{12, 30, 31, 40}, {1, -0.5, -0.25, -0.25}, Vec3(0, 1, 0), 0.02, 0});
    rows.push_back({{50, 60, -1, -1}, {1, -1, 0, 0}, Vec3(1, 0, 0), 0.5, 0});
    system.update(rows, constraints);
  }
  // Exact: minimise over dv = z + S w with a dense KKT system; also the constraint impulse.
  void dense(Eigen::VectorXd& dv, Eigen::VectorXd& e) const {
    const Eigen::MatrixXd M = system.to_dense();
    const Eigen::Index n = M.rows();
    Eigen::MatrixXd S = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd z = Eigen::VectorXd::Zero(n), rhs(n);
    for (Index i = 0; i < A.rows(); ++i) {
      S.block<3, 3>(3 * i, 3 * i) = constraints.S(i);
      z.segment<3>(3 * i) = constraints.z(i);
      rhs.segment<3>(3 * i) = b[static_cast<std::size_t>(i)];
    }
    const Eigen::MatrixXd filtered = S * M * S + (Eigen::MatrixXd::Identity(n, n) - S);
    dv = z + filtered.ldlt().solve(S * (rhs - M * z));
    e = M * dv - rhs;
  }
  ClothModel model;
  Elements elements;
  BlockMatrix<T> A;
  LinearSystem<T> system;
  ParticleConstraints constraints;
  std::vector<ImplicitRow> rows;
  Vec3s b, reference;
};

template <class T>
double error_against_dense(Problem<T>& p, const Vec3s& dv) {
  Eigen::VectorXd exact, e;
  p.dense(exact, e);
  double sum = 0;
  for (std::size_t i = 0; i < dv.size(); ++i)
    sum += (dv[i] - exact.segment<3>(3 * static_cast<Eigen::Index>(i))).squaredNorm();
  return std::sqrt(sum) / exact.norm();
}

}  // namespace toile::internal::test
