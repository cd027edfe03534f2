// material/condition.hpp: internal forces as energies of conditions, as in the paper.                   [BW98 4.1, 4.5]
//
// A condition C(x) reads N particles, has M components, and is zero at rest.  All an integrator needs follows
// from C and its derivatives, so it is written once, here.  With C_dot = sum_i dC/dx_i . v_i, per component:
//
//   energy        E                   = k/2 C^2
//   force         f_i                 = -k C dC/dx_i
//   stiffness     -df_i/dx_j          =  k (dC/dx_i dC/dx_j^T + C d2C/dx_i dx_j)
//   damping       d_i                 = -k_d C_dot dC/dx_i
//                 -dd_i/dv_j          =  k_d dC/dx_i dC/dx_j^T
//                 -dd_i/dx_j          =  k_d (dC/dx_i dC_dot/dx_j^T + C_dot d2C/dx_i dx_j); the paper keeps the second
//
// This is the reference, to read beside the paper and to check the production kernels (membrane.hpp, bend.hpp) against.
// Those give the same forces from fewer numbers, and a matrix that is always semidefinite; the literal stiffness below
// is indefinite on a compressed triangle.                                              docs/theory/stretch-and-shear.md
#pragma once
#include <concepts>
#include <string_view>

#include "core/types.hpp"

namespace toile::internal {

template <std::size_t N, std::size_t M>
struct ConditionValue {
  std::array<double, M> C{};                                // C[m]
  std::array<std::array<Vec3, N>, M> dC{};                  // dC[m][i]     = dC_m/dx_i
  std::array<std::array<std::array<Mat3, N>, N>, M> d2C{};  // d2C[m][i][j] = d2C_m/dx_i dx_j
};

// A struct with N = particles, M = components, the rest data of one element, and the value.  To try a behaviour of your
// own, write one and add it to the list in tests/material/condition_test.cpp: the derivative and invariance checks then
// run on it.
template <class T>
concept Condition = requires(const typename T::Rest& rest, const std::array<Vec3, T::particles>& x) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::evaluate(rest, x) } -> std::same_as<ConditionValue<T::particles, T::components>>;
};

template <std::size_t N>
using ElementVector = std::array<Vec3, N>;
template <std::size_t N>
using ElementMatrix = std::array<std::array<Mat3, N>, N>;  // [i][j]; symmetric as 3N x 3N

template <std::size_t M>
struct ConditionStiffness {
  std::array<double, M> k{}, k_d{};  // per component; units: the head of each condition's header
};

template <std::size_t N>
struct ConditionForce {
  double energy_J = 0;
  ElementVector<N> force{}, damping{};  // N
  ElementMatrix<N> gauss_newton{};      // k dC dC^T,               N/m
  ElementMatrix<N> curvature{};         // k C d2C,                 N/m; the true -df/dx is the sum of these two
  ElementMatrix<N> damping_dv{};        // k_d dC dC^T,             N s/m
  ElementMatrix<N> damping_dx{};        // k_d C_dot d2C,           N/m; the part of -dd/dx that the paper keeps
};

template <std::size_t N, std::size_t M>
ConditionForce<N> condition_force(const ConditionValue<N, M>& c, const ElementVector<N>& v,
                                  const ConditionStiffness<M>& stiffness) {
  ConditionForce<N> out;
  out.force.fill(Vec3::Zero());
  out.damping.fill(Vec3::Zero());
  for (auto* matrix : {&out.gauss_newton, &out.curvature, &out.damping_dv, &out.damping_dx})
    for (auto& row : *matrix) row.fill(Mat3::Zero());

  for (std::size_t m = 0; m < M; ++m) {
    const double k = stiffness.k[m], k_d = stiffness.k_d[m];
    double C_dot = 0;
    for (std::size_t i = 0; i < N; ++i) C_dot += c.dC[m][i].dot(v[i]);

    out.energy_J += 0.5 * k * c.C[m] * c.C[m];
    for (std::size_t i = 0; i < N; ++i) {
      out.force[i] -= k * c.C[m] * c.dC[m][i];
      out.damping[i] -= k_d * C_dot * c.dC[m][i];
      for (std::size_t j = 0; j < N; ++j) {
        const Mat3 outer = c.dC[m][i] * c.dC[m][j].transpose();
        out.gauss_newton[i][j] += k * outer;
        out.curvature[i][j] += k * c.C[m] * c.d2C[m][i][j];
        out.damping_dv[i][j] += k_d * outer;
        out.damping_dx[i][j] += k_d * C_dot * c.d2C[m][i][j];
      }
    }
  }
  return out;
}

}  // namespace toile::internal
