#include "assembly/block_matrix.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace toile {

BlockPattern::BlockPattern(Index particle_count, std::vector<std::pair<Index, Index>> links) {
  for (auto& [a, b] : links) {
    if (a > b) std::swap(a, b);
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  row_begin_.assign(static_cast<std::size_t>(particle_count) + 1, 0);
  column_.reserve(links.size());
  for (const auto& [a, b] : links) {
    if (a == b) continue;
    ++row_begin_[static_cast<std::size_t>(a) + 1];
    column_.push_back(b);
  }
  for (std::size_t i = 1; i < row_begin_.size(); ++i) row_begin_[i] += row_begin_[i - 1];
}

Slot BlockPattern::slot(Index row, Index column) const {
  const auto begin = column_.begin() + first_slot(row), end = column_.begin() + end_slot(row);
  const auto found = std::lower_bound(begin, end, column);
  TOILE_ASSERT(found != end && *found == column);
  return static_cast<Slot>(found - column_.begin());
}

template <class T>
BlockMatrix<T>::BlockMatrix(std::shared_ptr<const BlockPattern> pattern)
    : pattern_(std::move(pattern)),
      off_diagonal_(static_cast<std::size_t>(pattern_->block_count()), Block<T>::from(Mat3::Zero())),
      grounded_(static_cast<std::size_t>(pattern_->rows()), Mat3::Zero()),
      diagonal_(grounded_),
      grounded_columns_(grounded_.size() * 3, to_lane<T>(Vec3::Zero())) {}

template <class T>
void BlockMatrix<T>::update_diagonal() {
  for (std::size_t i = 0; i < grounded_.size(); ++i) {
    diagonal_[i] = grounded_[i];
    for (Eigen::Index k = 0; k < 3; ++k)
      grounded_columns_[3 * i + static_cast<std::size_t>(k)] = to_lane<T>(grounded_[i].col(k));
  }
  for (Index i = 0; i < rows(); ++i) {
    for (Slot s = pattern_->first_slot(i); s < pattern_->end_slot(i); ++s) {
      const Mat3 L = off_diagonal(s).to_mat3();
      diagonal_[static_cast<std::size_t>(i)] -= L;
      diagonal_[static_cast<std::size_t>(pattern_->column(s))] -= L.transpose();
    }
  }
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
      const Block<T>& L = off_diagonal(s);
      const Lane<T> d = x[j] - x_i;
      y_i += L.times(d);
      y[j] -= L.transpose_times(d);
    }
    y[static_cast<std::size_t>(i)] = y_i;
  }
}

template <class T>
void BlockMatrix<T>::multiply(std::span<const Vec3> x, std::span<Vec3> y) const {
  for (std::size_t i = 0; i < grounded_.size(); ++i) y[i] = grounded_[i] * x[i];
  for (Index i = 0; i < rows(); ++i) {
    for (Slot s = pattern_->first_slot(i); s < pattern_->end_slot(i); ++s) {
      const auto j = static_cast<std::size_t>(pattern_->column(s));
      const Mat3 L = off_diagonal(s).to_mat3();
      const Vec3 d = x[j] - x[static_cast<std::size_t>(i)];
      y[static_cast<std::size_t>(i)] += L * d;
      y[j] -= L.transpose() * d;
    }
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
      dense.block<3, 3>(at(i), at(j)) = off_diagonal(s).to_mat3();
      dense.block<3, 3>(at(j), at(i)) = off_diagonal(s).to_mat3().transpose();
    }
  }
  return dense;
}

template class BlockMatrix<float>;
template class BlockMatrix<double>;

}  // namespace toile
