// constraint/particle_constraints.hpp: constraints on the velocity of single particles.                  [BW98 5.1-5.3]
//
//   S_i   3x3   I                   3 degrees of freedom
//               I - p p^T           2: constrained along p
//               I - p p^T - q q^T   1: constrained along p and q
//               0                   0: fixed
//   z_i   m/s   prescribed change of velocity; lies in the range of (I - S_i)
//
// The solver keeps (I - S) dv = z exactly, at every iteration count: S filters every direction it adds to z.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

class ParticleConstraints {
 public:
  explicit ParticleConstraints(Index particle_count = 0) { resize(particle_count); }

  void resize(Index particle_count);
  void clear();  // every particle free; keeps the memory

  void hold(Index particle, const Vec3& z);  // no degree of freedom left
  // Prescribes z along the unit vector n.  On a particle that is already constrained along another direction the two
  // are combined: z is the one velocity that satisfies both (least norm), S the projection onto the rest.  Of parallel
  // directions the first stays.
  void hold_along(Index particle, const Vec3& n, double z_along_n);

  Index size() const { return static_cast<Index>(S_.size()); }
  const Mat3& S(Index particle) const { return S_[static_cast<std::size_t>(particle)]; }
  std::span<const Vec3> z() const { return z_; }
  const Vec3& z(Index particle) const { return z_[static_cast<std::size_t>(particle)]; }
  int degrees_of_freedom(Index particle) const { return dof_[static_cast<std::size_t>(particle)]; }
  bool is_free(Index particle) const { return dof_[static_cast<std::size_t>(particle)] == 3; }

  // Particles with fewer than 3 degrees of freedom, in the order of their first constraint.
  std::span<const Index> constrained() const { return constrained_; }

  // a_i <- S_i a_i for all particles.
  void filter(std::span<Vec3> a) const;

 private:
  Mat3 constrained_directions(Index particle) const { return Mat3::Identity() - S(particle); }
  std::vector<Mat3> S_;
  std::vector<Vec3> z_;
  std::vector<std::uint8_t> dof_;
  std::vector<Index> constrained_;
};

}  // namespace toile::internal
