// solver/linear_system.hpp: the constrained system of one step in prefiltered form.                    [BW98 5, TJM15 8]
//
//   A' = S (A + sum a g g^T) S + sigma (I - S)        b' = S (b - A z)         dv = z + w,  A' w = b'
//
// A' is an ordinary symmetric positive definite matrix, so every preconditioner works on it.  A itself is never overwritten:
// a held particle needs all of its row for its constraint force (I - S)(A dv - b)/h.  sigma_i = trace(A_ii)/3 keeps the spectrum.
// All vectors of the iteration stay in the range of S.
#pragma once
#include "assembly/block_matrix.hpp"
#include "assembly/implicit_row.hpp"
#include "constraint/particle_constraints.hpp"

#include <span>
#include <vector>

namespace toile {

// Of R = sum a g g^T: all of it, or what lies off its block diagonal.
enum class RowPart { whole, off_diagonal };

template <class T>
class LinearSystem {
 public:
  explicit LinearSystem(const BlockMatrix<T>& A) : A_(&A) {}

  // Call when A, the rows or the constraints have changed.  The spans must outlive the solve.
  void update(std::span<const ImplicitRow> rows, const ParticleConstraints& constraints);

  const BlockMatrix<T>& A() const { return *A_; }
  std::span<const ImplicitRow> rows() const { return rows_; }
  const ParticleConstraints& constraints() const { return *constraints_; }
  Index size() const { return A_->rows(); }

  // y = A' x for x in the range of S.
  void multiply(std::span<const Lane<T>> x, std::span<Lane<T>> y) const;
  // The pieces of it, for those who share the work:  what a row of R x gives to those of its particles whose bit k is set in `ends`;  y <- S y
  // of the held particle at a position of ParticleConstraints::constrained.
  void add_row(std::size_t row, unsigned ends, RowPart part, std::span<const Lane<T>> x, std::span<Lane<T>> y) const;
  void add_row(std::size_t row, unsigned ends, std::span<const Vec3> x, std::span<Vec3> y) const;
  void filter_held(std::size_t held, std::span<Lane<T>> y) const;
  void filter(std::span<Lane<T>> y) const;  // all of them
  // y = (A + sum a g g^T) x, unfiltered, in double, and as much momentum as it must be.
  void multiply_unfiltered(std::span<const Vec3> x, std::span<Vec3> y) const;
  // y = (A + sum a g g^T) z of the constraints' z, which only held particles have.
  void multiply_prescribed(std::span<Vec3> y) const;
  // e = (A + sum a g g^T) x - b of held particles: what holds them.  0 of others, where it is what the solve left.
  void held_residual(std::span<const Vec3> x, std::span<const Vec3> b, std::span<Vec3> e) const;
  // y += sum a g g^T x, its part of the rows.
  void add_rows(std::span<const Vec3> x, std::span<Vec3> y) const;

  // G_i = S_i D_i^-1 S_i with D_i the diagonal block of A', in double and in T.
  const Mat3& filtered_inverse(Index i) const { return inverse_[static_cast<std::size_t>(i)]; }
  const Block<T>& filtered_inverse_block(Index i) const { return inverse_block_[static_cast<std::size_t>(i)]; }
  // A_ii + rows, before filtering; made when asked for.
  std::vector<Mat3> diagonals() const;

  Eigen::MatrixXd to_dense() const;  // A + rows, unfiltered; for tests

 private:
  struct Row {  // an ImplicitRow in the precision of the iteration
    std::array<Index, 4> particle;
    std::array<T, 4> weight;
    Lane<T> direction;
    T a;
    bool single;  // all of it is on the diagonal
    T part_of(std::size_t k, std::span<const Lane<T>> x) const {
      const Lane<T> product = x[static_cast<std::size_t>(particle[k])] * direction;
      return weight[k] * (product[0] + product[1] + product[2]);
    }
  };
  const BlockMatrix<T>* A_;
  std::span<const ImplicitRow> rows_;
  std::vector<Row> fast_rows_;
  const ParticleConstraints* constraints_ = nullptr;
  void add_diagonals(std::span<Mat3> of_particles) const;  // of the rows
  std::vector<Mat3> inverse_;
  std::vector<Block<T>> inverse_block_;
  std::vector<Block<T>> filter_;  // S of the constrained particles, in their order
};

extern template class LinearSystem<float>;
extern template class LinearSystem<double>;

}  // namespace toile
