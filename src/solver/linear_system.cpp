#include "solver/linear_system.hpp"

#include "core/parallel.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace toile::internal {
namespace {

constexpr std::size_t held_per_block = 256;

double dot(const ImplicitRow& row, std::span<const Vec3> x) {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (row.particle[k] >= 0) sum += row.weight[k] * row.direction.dot(x[static_cast<std::size_t>(row.particle[k])]);
  }
  return sum;
}

}  // namespace

template <class T>
void LinearSystem<T>::update(std::span<const ImplicitRow> rows, const ParticleConstraints& constraints) {
  rows_ = rows;
  constraints_ = &constraints;
  const auto n = static_cast<std::size_t>(size());
  inverse_at_.resize(n);
  inverse_.assign(A_->diagonals().begin(), A_->diagonals().end());
  add_diagonals(inverse_);
  fast_rows_.clear();
  for (const ImplicitRow& row : rows) {
    Row fast{row.particle, row.particle, {}, to_lane<T>(row.direction), static_cast<T>(row.a)};
    for (std::size_t k = 0; k < 4; ++k) {
      fast.weight[k] = static_cast<T>(row.weight[k]);
      if (row.particle[k] >= 0) fast.place[k] = A_->pattern().place(row.particle[k]);
    }
    fast_rows_.push_back(fast);
  }
  parallel_for(n, 1024, [&](std::size_t i) {
    const auto particle = static_cast<Index>(i);
    const Mat3 diagonal = inverse_[i];
    if (constraints.is_free(particle)) {
      inverse_[i] = diagonal.inverse();
    } else {
      const Mat3& S = constraints.S(particle);
      const double sigma = diagonal.trace() / 3;
      const Mat3 D = S * diagonal * S + sigma * (Mat3::Identity() - S);
      inverse_[i] = S * D.inverse() * S;
    }
    inverse_at_[static_cast<std::size_t>(A_->pattern().place(particle))] = Block<T>::from(inverse_[i]);
  });
  filter_.clear();
  for (const Index i : constraints.constrained()) filter_.push_back(Block<T>::from(constraints.S(i)));
}

template <class T>
void LinearSystem<T>::add_diagonals(std::span<Mat3> of_particles) const {
  for (const ImplicitRow& row : rows_) {
    const Mat3 nn = row.direction * row.direction.transpose();
    for (std::size_t k = 0; k < 4; ++k) {
      if (row.particle[k] >= 0)
        of_particles[static_cast<std::size_t>(row.particle[k])] += (row.a * row.weight[k] * row.weight[k]) * nn;
    }
  }
}

template <class T>
std::vector<Mat3> LinearSystem<T>::diagonals() const {
  std::vector<Mat3> diagonals(A_->diagonals().begin(), A_->diagonals().end());
  add_diagonals(diagonals);
  return diagonals;
}

template <class T>
T LinearSystem<T>::pull(const Row& row, const std::array<Index, 4>& at, std::span<const Lane<T>> x) {
  T sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (at[k] < 0) continue;
    const Lane<T> product = x[static_cast<std::size_t>(at[k])] * row.direction;
    sum += row.weight[k] * (product[0] + product[1] + product[2]);
  }
  return row.a * sum;
}

template <class T>
void LinearSystem<T>::multiply(std::span<const Lane<T>> x, std::span<Lane<T>> y) const {
  A_->multiply(x, y);
  for (const Row& row : fast_rows_) {
    const T pulled = pull(row, row.particle, x);
    for (std::size_t k = 0; k < 4; ++k) {
      if (row.particle[k] >= 0)
        y[static_cast<std::size_t>(row.particle[k])] += row.direction * (row.weight[k] * pulled);
    }
  }
  filter(y);
}

template <class T>
void LinearSystem<T>::add_row_by_place(std::size_t index, unsigned ends, std::span<const Lane<T>> x,
                                       std::span<Lane<T>> y) const {
  const Row& row = fast_rows_[index];
  const T pulled = pull(row, row.place, x);
  for (std::size_t k = 0; k < 4; ++k) {
    if ((ends >> k & 1u) != 0) y[static_cast<std::size_t>(row.place[k])] += row.direction * (row.weight[k] * pulled);
  }
}

template <class T>
void LinearSystem<T>::add_row(std::size_t index, unsigned ends, std::span<const Vec3> x, std::span<Vec3> y) const {
  const ImplicitRow& row = rows_[index];
  const double sum = dot(row, x);
  for (std::size_t k = 0; k < 4; ++k) {
    if ((ends >> k & 1u) != 0)
      y[static_cast<std::size_t>(row.particle[k])] += (row.a * row.weight[k] * sum) * row.direction;
  }
}

template <class T>
void LinearSystem<T>::filter(std::span<Lane<T>> y) const {
  for (std::size_t held = 0; held < filter_.size(); ++held) {
    Lane<T>& y_i = y[static_cast<std::size_t>(constraints_->constrained()[held])];
    y_i = filtered(held, y_i);
  }
}

template <class T>
void LinearSystem<T>::multiply_unfiltered(std::span<const Vec3> x, std::span<Vec3> y) const {
  A_->multiply(x, y);
  A_->balance(x, y);
  add_rows(x, y);
}

template <class T>
void LinearSystem<T>::multiply_prescribed(std::span<Vec3> y) const {
  std::fill(y.begin(), y.end(), Vec3::Zero());
  bool any = false;
  for (const Index i : constraints_->constrained()) {
    const Vec3& z = constraints_->z(i);
    if (z.isZero(0)) continue;
    any = true;
    A_->add_column(i, z, y);
  }
  if (any) add_rows(constraints_->z(), y);
}

template <class T>
void LinearSystem<T>::held_residual(std::span<const Vec3> x, std::span<const Vec3> b, std::span<Vec3> e) const {
  std::fill(e.begin(), e.end(), Vec3::Zero());
  const std::span<const Index> held = constraints_->constrained();
  parallel_for(held.size(), held_per_block, [&](std::size_t k) {
    const Index i = held[k];
    e[static_cast<std::size_t>(i)] = A_->multiply_row(i, x) - b[static_cast<std::size_t>(i)];
  });
  if (held.empty()) return;
  for (const ImplicitRow& row : rows_) {
    const double sum = row.a * dot(row, x);
    for (std::size_t k = 0; k < 4; ++k) {
      const Index i = row.particle[k];
      if (i >= 0 && !constraints_->is_free(i)) e[static_cast<std::size_t>(i)] += (row.weight[k] * sum) * row.direction;
    }
  }
}

template <class T>
void LinearSystem<T>::add_rows(std::span<const Vec3> x, std::span<Vec3> y) const {
  for (const ImplicitRow& row : rows_) {
    const double sum = dot(row, x);
    for (std::size_t k = 0; k < 4; ++k) {
      if (row.particle[k] >= 0)
        y[static_cast<std::size_t>(row.particle[k])] += (row.a * row.weight[k] * sum) * row.direction;
    }
  }
}

template <class T>
Eigen::MatrixXd LinearSystem<T>::to_dense() const {
  const auto first = [](Index i) { return 3 * static_cast<Eigen::Index>(i); };
  Eigen::MatrixXd dense = A_->to_dense();
  for (const ImplicitRow& row : rows_) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = 0; l < 4; ++l) {
        if (row.particle[k] < 0 || row.particle[l] < 0) continue;
        dense.block<3, 3>(first(row.particle[k]), first(row.particle[l])) +=
            (row.a * row.weight[k] * row.weight[l]) * row.direction * row.direction.transpose();
      }
    }
  }
  return dense;
}

template class LinearSystem<float>;
template class LinearSystem<double>;

}  // namespace toile::internal
