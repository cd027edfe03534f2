// assembly/block_matrix.hpp: symmetric sparse matrix of 3x3 blocks, one block row per particle.              [BW98 2.3]
//
// Pattern and values are separate because their lifetimes differ: the pattern follows the mesh and is built once; the
// values follow the state and are rewritten every step.  The pattern lists the blocks above the diagonal by rows,
// columns ascending.  Their transposes, the blocks below it, are stored: a sweep scatters from a row into many others
// twice, as products of columns with the same three numbers, and gathers once, with sums across lanes (lane.hpp).
//
// Internal forces do not act on a rigid translation, so every row of their derivative sums to zero.  The product is
// therefore written with differences:
//
//   (A x)_i = G_i x_i + sum_j L_ij (x_j - x_i),        A_ij = L_ij,   A_ii = G_i - sum_j L_ij
//
// with G_i the grounded part, which resists a translation (mass, drag, attachments).  In float, a stiff A_ii x_i + sum
// A_ij x_j would lose a translation in cancellation (about 1e-3 of the mass term at 3000 N/m); in this form it is
// exact.
#pragma once
#include "assembly/block_pattern.hpp"
#include "assembly/lane.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace toile::internal {

// The arrays of a matrix in single precision, for kernels over its rows (assembly/block_kernels.hpp).
struct BlockRows {
  const BlockPattern* pattern;
  const Block<float>* below;  // [slot]
  const Mat3* grounded;       // [row]
};

template <class T>
class BlockMatrix {
 public:
  explicit BlockMatrix(std::shared_ptr<const BlockPattern> pattern);

  const BlockPattern& pattern() const { return *pattern_; }
  Index rows() const { return pattern_->rows(); }

  // A_ji = A_ij^T of a slot (i, j), i < j.
  Block<T>& below(Slot slot) { return below_[static_cast<std::size_t>(slot)]; }
  const Block<T>& below(Slot slot) const { return below_[static_cast<std::size_t>(slot)]; }
  std::span<Block<T>> blocks() { return below_; }  // [slot]
  Mat3& grounded(Index row) { return grounded_[static_cast<std::size_t>(row)]; }
  const Mat3& grounded(Index row) const { return grounded_[static_cast<std::size_t>(row)]; }
  // G_i in the precision of the blocks, valid after update_diagonal().
  Block<T> grounded_block(Index row) const {
    const Lane<T>* columns = &grounded_columns_[static_cast<std::size_t>(row) * 3];
    return {columns[0], columns[1], columns[2]};
  }
  // A_ii, valid after update_diagonal().
  const Mat3& diagonal(Index row) const { return diagonal_[static_cast<std::size_t>(row)]; }
  std::span<const Mat3> diagonals() const { return diagonal_; }
  // Call when blocks have changed.
  void update_diagonal();
  // A new number after every update_diagonal() of any matrix: tells holders of a copy of the blocks that it is old.
  std::uint64_t version() const { return version_; }

  // y = A x in the precision of the blocks; x and y must not overlap.
  void multiply(std::span<const Lane<T>> x, std::span<Lane<T>> y) const;
  // y = A x with the stored blocks but double vectors: for residuals that decide constraint forces.
  void multiply(std::span<const Vec3> x, std::span<Vec3> y) const;
  // Rows [begin, end) of it, for divided work, or one of them.
  void multiply_rows(Index begin, Index end, std::span<const Vec3> x, std::span<Vec3> y) const;
  Vec3 multiply_row(Index row, std::span<const Vec3> x) const;
  // Corrects y = A x: internal forces within a piece of cloth sum to zero, but blocks are rounded one by one and leave
  // a little.  It is subtracted, so that sum_i y_i = sum_i G_i x_i for every piece.
  void balance(std::span<const Vec3> x, std::span<Vec3> y) const;
  // y += A x of an x that is nonzero on one particle only.
  void add_column(Index column, const Vec3& x, std::span<Vec3> y) const;

  Eigen::MatrixXd to_dense() const;  // for tests and small inspections only

 private:
  BlockRows block_rows() const;  // single precision only

  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<Block<T>> below_;
  std::uint64_t version_ = 0;
  std::vector<Mat3> grounded_, diagonal_;
  std::vector<Lane<T>> grounded_columns_;  // three per row, in T, for multiply
  mutable std::vector<Vec3> unbalanced_;   // [piece]
};

template <>
BlockRows BlockMatrix<float>::block_rows() const;
extern template class BlockMatrix<float>;
extern template class BlockMatrix<double>;

}  // namespace toile::internal
