// solver/coarse_space.hpp: a small dense system that moves whole patches of cloth at once.
//
// The cloth is cut into aggregates of neighbouring particles.  On each, the correction may be any affine function of the
// pattern coordinates, 9 numbers:   z_i = S_i (a + u' b + v' c),   u', v' relative to the aggregate and scaled to [-1, 1].
//
//   additive form:   M^-1 r = SSOR(r) + Z E^-1 Z^T r,      E = Z^T A' Z   (contact rows included)
//
// Without it a loosely solved step leaves the low modes at their old velocity: an artificial brake that makes draping cloth
// look viscous (docs/theory/solver.md#coarse-space has the measurement).        [Nicolaides 1987; Tang et al. 2009]
#pragma once
#include "mesh/cloth_mesh.hpp"
#include "solver/linear_system.hpp"

#include <vector>

namespace toile {

class CoarseSpace {
 public:
  // Cuts each panel by recursive bisection of its particles' pattern coordinates.  A particle of two panels belongs to the first.
  explicit CoarseSpace(const ClothMesh& mesh);

  int aggregates() const { return aggregate_count_; }
  int dimension() const { return 9 * aggregate_count_; }

  template <class T>
  void factorise(const LinearSystem<T>& system);
  // z += Z E^-1 Z^T r
  template <class T>
  void add_correction(const LinearSystem<T>& system, std::span<const Lane<T>> r, std::span<Lane<T>> z);

 private:
  void add_block(Index i, Index j, const Mat3& block);
  void cholesky();
  int aggregate_count_ = 0;
  std::vector<Index> aggregate_;   // [particle]
  std::vector<Vec3> basis_;        // [particle] (1, u', v')
  std::vector<double> E_;          // row-major; upper triangle, then its factor U with E = U^T U
  std::vector<double> transpose_;  // U^T
  std::vector<double> rhs_;
  std::vector<std::uint8_t> dead_;  // directions in which nothing may move
};

}  // namespace toile
