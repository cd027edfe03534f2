#include "assembly/air.hpp"

#include "core/parallel.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace toile::internal {
namespace {

constexpr std::size_t air_grain = 512;  // triangles per block of work

}  // namespace

void Air::prepare(const ClothModel& model, const BlockPattern& pattern) {
  triangles_ = model.mesh.triangles;
  force_.assign(triangles_.size(), Vec3::Zero());
  B_.assign(triangles_.size(), Mat3::Zero());
  std::vector<std::pair<Index, Index>> sides, corners;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [i, j] = std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]);
      sides.emplace_back(pattern.slot(i, j), static_cast<Index>(t));
      corners.emplace_back(triangles_[t][k], static_cast<Index>(t));
    }
  }
  at_slots_.sort(sides, static_cast<std::size_t>(pattern.block_count()));
  at_particles_.sort(corners, static_cast<std::size_t>(pattern.rows()));
}

void Air::evaluate(const ClothState& state, double end_s) {
  const Vec3 wind_m_per_s = wind_ ? wind_(end_s) : options_.wind_m_per_s;
  parallel_for(triangles_.size(), air_grain, [&](std::size_t t) {
    force_[t].setZero();
    B_[t].setZero();
    const Triangle& corner = triangles_[t];
    const Vec3& x0 = state.x[at(corner[0])];
    const Vec3 normal = (state.x[at(corner[1])] - x0).cross(state.x[at(corner[2])] - x0);
    const double twice_area = normal.norm();
    if (!(twice_area > 0)) return;
    const Vec3 n = normal / twice_area;
    const Vec3 u = (state.v[at(corner[0])] + state.v[at(corner[1])] + state.v[at(corner[2])]) / 3 - wind_m_per_s;
    const double u_n = n.dot(u);
    const Vec3 u_t = u - u_n * n;
    const double slip = u_t.norm();
    const double half = 0.25 * options_.density_kg_per_m3 * twice_area;  // rho a/2
    const double c_n = half * options_.normal_coefficient, c_t = half * options_.tangential_coefficient;
    force_[t] = -(c_n * std::abs(u_n) * u_n) * n - (c_t * slip) * u_t;
    const Mat3 nn = n * n.transpose();
    B_[t] = (2 * c_n * std::abs(u_n)) * nn + (c_t * slip) * (Mat3::Identity() - nn);
    if (slip > 0) B_[t] += (c_t / slip) * u_t * u_t.transpose();
  });
}

void Air::add_forces(std::span<Vec3> f) const {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const Index corner : triangles_[t]) f[at(corner)] += force_[t] / 3;
  }
}

void Air::add_damping(std::span<const Vec3> u, std::span<Vec3> f) const {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& corner = triangles_[t];
    const Vec3 brake = B_[t] * (u[at(corner[0])] + u[at(corner[1])] + u[at(corner[2])]) / 9;
    for (const Index c : corner) f[at(c)] += brake;
  }
}

template <class T>
void Air::add_to(BlockMatrix<T>& A, double h_s) const {
  const double ninth = h_s / 9;
  parallel_for(A.blocks().size(), air_grain, [&](std::size_t s) {
    for (const Index side : at_slots_.bucket(s)) {
      Block<T>& block = A.below(static_cast<Slot>(s));  // B is symmetric
      block = Block<T>::from(block.to_mat3() + ninth * B_[at(side / 3)]);
    }
  });
  parallel_for(static_cast<std::size_t>(A.rows()), air_grain, [&](std::size_t i) {
    for (const Index corner : at_particles_.bucket(i))  // the sum of a row: block_matrix.hpp
      A.grounded(static_cast<Index>(i)) += 3 * (ninth * B_[at(corner / 3)]);
  });
  A.update_diagonal();
}

void Air::assemble(double h_s, BlockMatrix<float>& A) const { add_to(A, h_s); }
void Air::assemble(double h_s, BlockMatrix<double>& A) const { add_to(A, h_s); }

}  // namespace toile::internal
