// material/membrane_derivatives.hpp: the membrane's force and stiffness against differences of its energy.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "material/membrane.hpp"
#include "material/random_elements.hpp"
#include "support/finite_difference.hpp"

namespace toile::internal {

// `length`: on which the energy is smooth.  At rest, and with the true Hessian.
inline void expect_derivatives_of_the_energy(const RestTriangle& t, const MembraneStiffness& k,
                                             const std::array<Vec3, 3>& x, double length, double tolerance) {
  const std::array<Vec3, 3> at_rest = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto response = [&](const Eigen::VectorXd& at) {
    return membrane_response(t.membrane, k, corners<3>(at), at_rest, DampingJacobian::gauss_newton, Projection::none);
  };
  const auto energy = [&](const Eigen::VectorXd& at) {
    return Eigen::VectorXd::Constant(1, response(at).energy_J).eval();
  };
  const auto force = [&](const Eigen::VectorXd& at) {
    const MembraneResponse r = response(at);
    return flat(corner_forces(t, r.P_u, r.P_v));
  };
  const MembraneResponse r = response(flat(x));
  const Eigen::VectorXd gradient = -flat(corner_forces(t, r.P_u, r.P_v));
  EXPECT_GT(gradient.norm(), 0);
  EXPECT_LT(relative_error(gradient, finite_difference(energy, flat(x), length).derivative.transpose()), tolerance);
  EXPECT_LT(relative_error(expand(t, r.K), -finite_difference(force, flat(x), length).derivative), tolerance);
}

// Over the largest.
inline double least_eigenvalue(const FMatrix& K) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(dense(K), Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().minCoeff() / eigen.eigenvalues().maxCoeff();
}

}  // namespace toile::internal
