#include "material/membrane_batch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::internal {
namespace {

MembraneRestBatch all_lanes(const MembraneRest& rest, const MembraneStiffness& k) {
  MembraneRestBatch batch;
  for (std::size_t lane = 0; lane < batch_size; ++lane) batch.set(lane, rest, k, {0, 1, 2});
  return batch;
}

}  // namespace

double pushed_stiffness_N_per_m(double rigidity_N_m, double area_m2) {
  const double wave_m = std::min(2 * std::sqrt(4 / std::sqrt(3.0) * area_m2), longest_wrinkle_m);
  const double curvature_per_m = 2 * std::numbers::pi / wave_m;
  return rigidity_N_m * curvature_per_m * curvature_per_m / wrinkle_shortening;
}

double membrane_energy(const MembraneRest& rest, const MembraneStiffness& k, const Vec3& w_u, const Vec3& w_v) {
  MembraneStateBatch state{};
  for (std::size_t n = 0; n < 3; ++n) {
    std::fill_n(state.w_u[n], batch_size, w_u[static_cast<Eigen::Index>(n)]);
    std::fill_n(state.w_v[n], batch_size, w_v[static_cast<Eigen::Index>(n)]);
  }
  membrane_energies(all_lanes(rest, k), state);
  return state.energy_J[0];
}

MembraneResponse membrane_response(const MembraneRest& rest, const MembraneStiffness& k, const std::array<Vec3, 3>& x,
                                   const std::array<Vec3, 3>& v, DampingJacobian damping_jacobian,
                                   Projection projection) {
  const MembraneRestBatch batch = all_lanes(rest, k);
  MembraneStateBatch state;
  evaluate_membranes(&batch, 0, 1, x.data(), v.data(), &state);
  return membrane_response_of(batch, state, 0, {damping_jacobian, projection});
}

}  // namespace toile::internal
