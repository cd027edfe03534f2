#include "assembly/block_matrix.hpp"

#include "assembly/block_kernels.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <type_traits>

namespace toile::internal {
namespace {

constexpr std::size_t row_grain = 512;  // rows

std::uint64_t next_version() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

template <class T>
BlockMatrix<T>::BlockMatrix(std::shared_ptr<const BlockPattern> pattern)
    : pattern_(std::move(pattern)),
      below_(static_cast<std::size_t>(pattern_->block_count()), Block<T>::from(Mat3::Zero())),
      grounded_(static_cast<std::size_t>(pattern_->rows()), Mat3::Zero()),
      diagonal_(grounded_),
      grounded_columns_(grounded_.size() * 3, to_lane<T>(Vec3::Zero())),
      unbalanced_(static_cast<std::size_t>(pattern_->piece_sizes().size())) {}

template <>
BlockRows BlockMatrix<float>::block_rows() const {
  return {pattern_.get(), below_.data(), grounded_.data()};
}

template <class T>
void BlockMatrix<T>::update_diagonal() {
  version_ = next_version();
  const auto rows = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k)
        grounded_columns_[3 * i + static_cast<std::size_t>(k)] = to_lane<T>(grounded_[i].col(k));
    }
    if constexpr (std::is_same_v<T, float>) {
      sum_block_diagonals(block_rows(), static_cast<Index>(begin), static_cast<Index>(end), &diagonal_[begin]);
    } else {
      for (std::size_t i = begin; i < end; ++i) {
        const auto row = static_cast<Index>(i);
        Mat3 diagonal = grounded_[i];
        for (const auto& above : pattern_->above(row)) diagonal -= below(above.slot).to_mat3();
        for (Slot s = pattern_->first_slot(row); s < pattern_->end_slot(row); ++s)
          diagonal -= below(s).to_mat3().transpose();
        diagonal_[i] = diagonal;
      }
    }
  };
  parallel_blocks(grounded_.size(), row_grain, std::cref(rows));  // by reference: no copy of the lambda on the heap
}

template <class T>
void BlockMatrix<T>::multiply(std::span<const Lane<T>> x, std::span<Lane<T>> y) const {
  const auto n = static_cast<std::size_t>(rows());
  for (std::size_t i = 0; i < n; ++i) {
    const Lane<T> x_i = x[i];
    y[i] = grounded_columns_[3 * i] * x_i[0] + grounded_columns_[3 * i + 1] * x_i[1] +
           grounded_columns_[3 * i + 2] * x_i[2];
  }
  for (Index i = 0; i < rows(); ++i) {
    const Lane<T> x_i = x[static_cast<std::size_t>(i)];
    Lane<T> y_i = y[static_cast<std::size_t>(i)];
    const Slot end = pattern_->end_slot(i);
    for (Slot s = pattern_->first_slot(i); s < end; ++s) {
      const auto j = static_cast<std::size_t>(pattern_->column(s));
      const Lane<T> d = x[j] - x_i;
      const Block<T>& L = below(s);
      y_i += L.transpose_times(d);
      y[j] -= L.times(d);
    }
    y[static_cast<std::size_t>(i)] = y_i;
  }
}

template <class T>
void BlockMatrix<T>::multiply(std::span<const Vec3> x, std::span<Vec3> y) const {
  const auto rows = [&](std::size_t begin, std::size_t end) {
    multiply_rows(static_cast<Index>(begin), static_cast<Index>(end), x, y);
  };
  parallel_blocks(grounded_.size(), row_grain, std::cref(rows));  // by reference: no copy of the lambda on the heap
}

template <class T>
void BlockMatrix<T>::multiply_rows(Index begin, Index end, std::span<const Vec3> x, std::span<Vec3> y) const {
  if constexpr (std::is_same_v<T, float>) {
    multiply_block_rows(block_rows(), begin, end, x.data(), y.data() + begin);
  } else {
    for (Index i = begin; i < end; ++i) y[static_cast<std::size_t>(i)] = multiply_row(i, x);
  }
}

template <class T>
void BlockMatrix<T>::balance(std::span<const Vec3> x, std::span<Vec3> y) const {
  std::fill(unbalanced_.begin(), unbalanced_.end(), Vec3::Zero());
  const auto of = [&](std::size_t i) { return static_cast<std::size_t>(pattern_->piece(static_cast<Index>(i))); };
  for (std::size_t i = 0; i < y.size(); ++i) {
    const Vec3 internal = y[i] - grounded_[i] * x[i];
    unbalanced_[of(i)] += internal;
  }
  for (std::size_t p = 0; p < unbalanced_.size(); ++p) unbalanced_[p] /= pattern_->piece_sizes()[p];
  for (std::size_t i = 0; i < y.size(); ++i) y[i] -= unbalanced_[of(i)];
}

template <class T>
Vec3 BlockMatrix<T>::multiply_row(Index i, std::span<const Vec3> x) const {
  Vec3 sum;
  if constexpr (std::is_same_v<T, float>) {
    multiply_block_rows(block_rows(), i, i + 1, x.data(), &sum);
  } else {
    const Vec3& x_i = x[static_cast<std::size_t>(i)];
    sum = grounded(i) * x_i;
    for (const auto& above : pattern_->above(i))
      sum += below(above.slot).to_mat3() * (x[static_cast<std::size_t>(above.row)] - x_i);
    for (Slot s = pattern_->first_slot(i); s < pattern_->end_slot(i); ++s)
      sum += below(s).to_mat3().transpose() * (x[static_cast<std::size_t>(pattern_->column(s))] - x_i);
  }
  return sum;
}

template <class T>
void BlockMatrix<T>::add_column(Index j, const Vec3& x, std::span<Vec3> y) const {
  y[static_cast<std::size_t>(j)] += diagonal(j) * x;
  for (const auto& above : pattern_->above(j)) {  // A_ij = A_ji^T
    const Block<T>& L = below(above.slot);
    y[static_cast<std::size_t>(above.row)] += Vec3(to_vec3(L.c0).dot(x), to_vec3(L.c1).dot(x), to_vec3(L.c2).dot(x));
  }
  for (Slot s = pattern_->first_slot(j); s < pattern_->end_slot(j); ++s) {
    const Block<T>& L = below(s);
    y[static_cast<std::size_t>(pattern_->column(s))] +=
        (to_vec3(L.c0) * x[0] + to_vec3(L.c1) * x[1]) + to_vec3(L.c2) * x[2];
  }
}

template <class T>
Eigen::MatrixXd BlockMatrix<T>::to_dense() const {
  const auto at = [](Index i) { return 3 * static_cast<Eigen::Index>(i); };
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(at(rows()), at(rows()));
  for (Index i = 0; i < rows(); ++i) {
    dense.block<3, 3>(at(i), at(i)) = diagonal(i);
    for (Slot s = pattern_->first_slot(i); s < pattern_->end_slot(i); ++s) {
      const Index j = pattern_->column(s);
      dense.block<3, 3>(at(i), at(j)) = below(s).to_mat3().transpose();
      dense.block<3, 3>(at(j), at(i)) = below(s).to_mat3();
    }
  }
  return dense;
}

template class BlockMatrix<float>;
template class BlockMatrix<double>;

}  // namespace toile::internal
