#include "constraint/particle_constraints.hpp"

#include <cmath>

namespace toile::internal {

void ParticleConstraints::resize(Index particle_count) {
  const auto n = static_cast<std::size_t>(particle_count);
  S_.assign(n, Mat3::Identity());
  z_.assign(n, Vec3::Zero());
  dof_.assign(n, 3);
  constrained_.clear();
  constrained_.reserve(n);
}

void ParticleConstraints::clear() {
  for (const Index i : constrained_) {
    const auto p = static_cast<std::size_t>(i);
    S_[p].setIdentity();
    z_[p].setZero();
    dof_[p] = 3;
  }
  constrained_.clear();
}

void ParticleConstraints::hold(Index particle, const Vec3& z) {
  const auto p = static_cast<std::size_t>(particle);
  if (dof_[p] == 3) constrained_.push_back(particle);
  S_[p].setZero();
  z_[p] = z;
  dof_[p] = 0;
}

void ParticleConstraints::hold_along(Index particle, const Vec3& n, double z_along_n) {
  const auto p = static_cast<std::size_t>(particle);
  if (dof_[p] == 0) return;
  if (dof_[p] == 3) {
    constrained_.push_back(particle);
    S_[p] = Mat3::Identity() - n * n.transpose();
    z_[p] = z_along_n * n;
    dof_[p] = 2;
    return;
  }
  // The part of n that is still free; along it z gains the rest of the prescribed z . n.
  Vec3 m = S_[p] * n;
  const double length = m.norm();
  constexpr double parallel = 1e-3;
  if (length < parallel) return;
  m /= length;
  z_[p] += ((z_along_n - n.dot(z_[p])) / length) * m;
  --dof_[p];
  if (dof_[p] == 0) {
    S_[p].setZero();
  } else {
    S_[p] -= m * m.transpose();
  }
}

void ParticleConstraints::filter(std::span<Vec3> a) const {
  for (const Index i : constrained_) {
    Vec3& a_i = a[static_cast<std::size_t>(i)];
    a_i = S(i) * a_i;
  }
}

}  // namespace toile::internal
