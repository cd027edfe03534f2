// solver/linear_system.hpp: the constrained system of one step in prefiltered form.                   [BW98 5, TJM15 8]
//
//   A' = S (A + sum a g g^T) S + sigma (I - S)        b' = S (b - A z)         dv = z + w,  A' w = b'
//
// A' is an ordinary symmetric positive definite matrix, so every preconditioner works on it.  A itself is never
// overwritten: the constraint force (I - S)(A dv - b)/h of a particle needs all of its row.  sigma_i = trace(A_ii)/3
// keeps the spectrum.
//
// All vectors of the iteration stay in the range of S.  Vectors of single precision that sweeps work on are in the
// order of the pattern's places; all others in that of particles.
#pragma once
#include "assembly/block_matrix.hpp"
#include "assembly/implicit_row.hpp"
#include "constraint/particle_constraints.hpp"

#include <span>
#include <vector>

namespace toile::internal {

template <class T>
class LinearSystem {
 public:
  // The matrix must outlive this object.
  explicit LinearSystem(const BlockMatrix<T>& A) : A_(&A) {}
  explicit LinearSystem(BlockMatrix<T>&&) = delete;

  // Call when A, the rows or the constraints have changed.  The spans must outlive the solve.
  void update(std::span<const ImplicitRow> rows, const ParticleConstraints& constraints);

  const BlockMatrix<T>& A() const { return *A_; }
  std::span<const ImplicitRow> rows() const { return rows_; }
  const ParticleConstraints& constraints() const { return *constraints_; }
  Index size() const { return A_->rows(); }

  // y = A' x for x in the range of S, and y <- S y.
  void multiply(std::span<const Lane<T>> x, std::span<Lane<T>> y) const;
  void filter(std::span<Lane<T>> y) const;
  // For divided work: the contribution of a row of sum a g g^T x to its particles k with bit k set in `ends`.
  void add_row(std::size_t row, unsigned ends, std::span<const Vec3> x, std::span<Vec3> y) const;
  void add_row_by_place(std::size_t row, unsigned ends, std::span<const Lane<T>> x, std::span<Lane<T>> y) const;
  // S y of the particle at a position of ParticleConstraints::constrained.
  Lane<T> filtered(std::size_t held, const Lane<T>& y) const { return filter_[held].times(y); }
  // y = (A + sum a g g^T) x, unfiltered, in double, with exact momentum.
  void multiply_unfiltered(std::span<const Vec3> x, std::span<Vec3> y) const;
  // y = (A + sum a g g^T) z of the constraints' z, which is nonzero on constrained particles only.
  void multiply_prescribed(std::span<Vec3> y) const;
  // e = (A + sum a g g^T) x - b of constrained particles: their constraint impulse.  0 for others, where it is
  // only the residual of the solve.
  void held_residual(std::span<const Vec3> x, std::span<const Vec3> b, std::span<Vec3> e) const;
  // y += sum a g g^T x, the part of the rows.
  void add_rows(std::span<const Vec3> x, std::span<Vec3> y) const;

  // G_i = S_i D_i^-1 S_i with D_i the diagonal block of A', in double, and in T by places.
  const Mat3& filtered_inverse(Index i) const { return inverse_[static_cast<std::size_t>(i)]; }
  std::span<const Block<T>> filtered_inverses_by_place() const { return inverse_at_; }
  // A_ii + rows, before filtering; computed on demand.
  std::vector<Mat3> diagonals() const;

  Eigen::MatrixXd to_dense() const;  // A + rows, unfiltered; for tests

 private:
  struct Row {  // an ImplicitRow in the precision of the iteration
    std::array<Index, 4> particle, place;
    std::array<T, 4> weight;
    Lane<T> direction;
    T a;
  };
  // a g^T x, with x at the positions of the row's particles.
  static T pull(const Row& row, const std::array<Index, 4>& at, std::span<const Lane<T>> x);
  const BlockMatrix<T>* A_;
  std::span<const ImplicitRow> rows_;
  std::vector<Row> fast_rows_;
  const ParticleConstraints* constraints_ = nullptr;
  void add_diagonals(std::span<Mat3> of_particles) const;  // of the rows
  std::vector<Mat3> inverse_;
  std::vector<Block<T>> inverse_at_;  // [place]
  std::vector<Block<T>> filter_;      // S of the constrained particles, in their order
};

extern template class LinearSystem<float>;
extern template class LinearSystem<double>;

}  // namespace toile::internal
