#include "solver/coarse_space.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile {
namespace {

// 16 to 32 aggregates of about 128 particles serve up to 10,000 particles: a dense factor of at most 288 rows.
int wanted_aggregates(std::size_t particles) { return std::clamp(static_cast<int>(particles / 160), 1, 32); }

// Splits `members` at the median of its longer pattern direction until no part is larger than `largest`.
void bisect(std::vector<Index>& members, std::size_t begin, std::size_t end, std::size_t largest, const Vec2s& uv,
            std::vector<Index>& aggregate, int& count) {
  if (end - begin <= largest) {
    for (std::size_t k = begin; k < end; ++k) aggregate[static_cast<std::size_t>(members[k])] = count;
    ++count;
    return;
  }
  Vec2 low = uv[static_cast<std::size_t>(members[begin])], high = low;
  for (std::size_t k = begin; k < end; ++k) {
    low = low.cwiseMin(uv[static_cast<std::size_t>(members[k])]);
    high = high.cwiseMax(uv[static_cast<std::size_t>(members[k])]);
  }
  const Eigen::Index axis = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
  std::sort(members.begin() + static_cast<std::ptrdiff_t>(begin), members.begin() + static_cast<std::ptrdiff_t>(end),
            [&](Index a, Index b) {
              const double p = uv[static_cast<std::size_t>(a)][axis], q = uv[static_cast<std::size_t>(b)][axis];
              return p != q ? p < q : a < b;
            });
  const std::size_t middle = begin + (end - begin) / 2;
  bisect(members, begin, middle, largest, uv, aggregate, count);
  bisect(members, middle, end, largest, uv, aggregate, count);
}

}  // namespace

CoarseSpace::CoarseSpace(const ClothMesh& mesh) {
  const auto particles = static_cast<std::size_t>(mesh.particle_count);
  aggregate_.assign(particles, -1);
  basis_.assign(particles, Vec3(1, 0, 0));
  Vec2s uv(particles, Vec2::Zero());
  std::vector<Index> panel(particles, -1);
  Index panels = 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Index of_triangle = mesh.panel.empty() ? 0 : mesh.panel[t];
    panels = std::max(panels, of_triangle + 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto p = static_cast<std::size_t>(mesh.triangles[t][c]);
      if (panel[p] >= 0) continue;
      panel[p] = of_triangle;
      uv[p] = mesh.uv[t][c];
    }
  }
  const std::size_t largest =
      std::max<std::size_t>(8, (particles + static_cast<std::size_t>(wanted_aggregates(particles)) - 1) /
                                   static_cast<std::size_t>(wanted_aggregates(particles)));
  for (Index k = 0; k < panels; ++k) {
    std::vector<Index> members;
    for (std::size_t p = 0; p < particles; ++p) {
      if (panel[p] == k) members.push_back(static_cast<Index>(p));
    }
    if (!members.empty()) bisect(members, 0, members.size(), largest, uv, aggregate_, aggregate_count_);
  }
  // Affine coordinates: centred on the aggregate, scaled by its extent.
  std::vector<Vec2> low(static_cast<std::size_t>(aggregate_count_), Vec2::Constant(1e300)),
      high(low.size(), Vec2::Constant(-1e300));
  for (std::size_t p = 0; p < particles; ++p) {
    if (aggregate_[p] < 0) aggregate_[p] = 0;  // isolated particles are refused by check_cloth
    const auto a = static_cast<std::size_t>(aggregate_[p]);
    low[a] = low[a].cwiseMin(uv[p]);
    high[a] = high[a].cwiseMax(uv[p]);
  }
  for (std::size_t p = 0; p < particles; ++p) {
    const auto a = static_cast<std::size_t>(aggregate_[p]);
    const Vec2 centre = 0.5 * (low[a] + high[a]);
    const double half = std::max(0.5 * (high[a] - low[a]).maxCoeff(), 1e-12);
    const Vec2 local = (uv[p] - centre) / half;
    basis_[p] = Vec3(1, local.x(), local.y());
  }
  const auto n = static_cast<std::size_t>(dimension());
  E_.resize(n * n);
  transpose_.resize(n * n);
  rhs_.resize(n);
  dead_.resize(n);
}

void CoarseSpace::add_block(Index i, Index j, const Mat3& block) {
  const auto n = static_cast<std::size_t>(dimension());
  const Vec3 &p = basis_[static_cast<std::size_t>(i)], &q = basis_[static_cast<std::size_t>(j)];
  const auto a = static_cast<std::size_t>(aggregate_[static_cast<std::size_t>(i)]) * 9,
             b = static_cast<std::size_t>(aggregate_[static_cast<std::size_t>(j)]) * 9;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t r = 0; r < 3; ++r) {
      double* row = &E_[(a + 3 * k + r) * n + b];
      const double p_k = p[static_cast<Eigen::Index>(k)];
      const double m0 = p_k * block(static_cast<Eigen::Index>(r), 0), m1 = p_k * block(static_cast<Eigen::Index>(r), 1),
                   m2 = p_k * block(static_cast<Eigen::Index>(r), 2);
      for (std::size_t l = 0; l < 3; ++l) {
        const double q_l = q[static_cast<Eigen::Index>(l)];
        row[3 * l] += m0 * q_l;
        row[3 * l + 1] += m1 * q_l;
        row[3 * l + 2] += m2 * q_l;
      }
    }
  }
}

template <class T>
void CoarseSpace::factorise(const LinearSystem<T>& system) {
  std::fill(E_.begin(), E_.end(), 0.0);
  const BlockPattern& pattern = system.A().pattern();
  const ParticleConstraints& constraints = system.constraints();
  const auto filtered = [&](Index i, Index j, const Mat3& block) -> Mat3 {
    if (constraints.is_free(i) && constraints.is_free(j)) return block;
    return constraints.S(i) * block * constraints.S(j);
  };
  for (Index i = 0; i < pattern.rows(); ++i) {
    add_block(i, i, filtered(i, i, system.A().diagonal(i)));
    for (Slot s = pattern.first_slot(i); s < pattern.end_slot(i); ++s) {
      const Index j = pattern.column(s);
      const Mat3 block = filtered(i, j, system.A().off_diagonal(s).to_mat3());
      add_block(i, j, block);
      add_block(j, i, block.transpose());
    }
  }
  for (const ImplicitRow& row : system.rows()) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (row.particle[k] < 0) continue;
      const Vec3 g_k = constraints.S(row.particle[k]) * row.direction;
      for (std::size_t l = 0; l < 4; ++l) {
        if (row.particle[l] < 0) continue;
        const Vec3 g_l = constraints.S(row.particle[l]) * row.direction;
        add_block(row.particle[k], row.particle[l], (row.a * row.weight[k] * row.weight[l]) * g_k * g_l.transpose());
      }
    }
  }
  cholesky();
}

// E = U^T U in place, row by row; a pivot that is nothing beside its aggregate (all of it held) is struck out.
void CoarseSpace::cholesky() {
  const auto n = static_cast<std::size_t>(dimension());
  double largest = 0;
  for (std::size_t k = 0; k < n; ++k) largest = std::max(largest, E_[k * n + k]);
  for (std::size_t k = 0; k < n; ++k) {
    double* row_k = &E_[k * n];
    const double pivot = row_k[k];
    dead_[k] = !(pivot > 1e-9 * largest);
    if (dead_[k]) {
      std::fill(row_k + k, row_k + n, 0.0);
      continue;
    }
    const double inverse = 1 / std::sqrt(pivot);
    for (std::size_t j = k; j < n; ++j) row_k[j] *= inverse;
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = row_k[i];
      if (factor == 0) continue;
      double* row_i = &E_[i * n];
      for (std::size_t j = i; j < n; ++j) row_i[j] -= factor * row_k[j];
    }
  }
  // Both triangular solves walk along rows: sums in a fixed order that still fill vector registers.
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = k; j < n; ++j) transpose_[j * n + k] = E_[k * n + j];
  }
}

template <class T>
void CoarseSpace::add_correction(const LinearSystem<T>& system, std::span<const Lane<T>> r, std::span<Lane<T>> z) {
  const auto n = static_cast<std::size_t>(dimension());
  std::fill(rhs_.begin(), rhs_.end(), 0.0);
  for (std::size_t p = 0; p < r.size(); ++p) {  // r is in the range of S, so S^T r = r
    double* y = &rhs_[static_cast<std::size_t>(aggregate_[p]) * 9];
    const Vec3& q = basis_[p];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c)
        y[3 * k + c] += q[static_cast<Eigen::Index>(k)] * static_cast<double>(r[p][c]);
    }
  }
  for (std::size_t k = 0; k < n; ++k) {  // U^T y = rhs
    const double* row = &E_[k * n];
    if (dead_[k]) {
      rhs_[k] = 0;
      continue;
    }
    const double y = rhs_[k] /= row[k];
    for (std::size_t j = k + 1; j < n; ++j) rhs_[j] -= row[j] * y;
  }
  for (std::size_t k = n; k-- > 0;) {  // U x = y, by columns of U: rows of its transpose
    if (dead_[k]) continue;
    const double* column = &transpose_[k * n];
    const double x = rhs_[k] /= column[k];
    for (std::size_t j = 0; j < k; ++j) rhs_[j] -= column[j] * x;
  }
  const ParticleConstraints& constraints = system.constraints();
  for (std::size_t p = 0; p < r.size(); ++p) {
    const double* y = &rhs_[static_cast<std::size_t>(aggregate_[p]) * 9];
    const Vec3& q = basis_[p];
    Vec3 correction;
    for (int c = 0; c < 3; ++c) correction[c] = q[0] * y[c] + q[1] * y[3 + c] + q[2] * y[6 + c];
    if (!constraints.is_free(static_cast<Index>(p))) correction = constraints.S(static_cast<Index>(p)) * correction;
    z[p] += to_lane<T>(correction);
  }
}

template void CoarseSpace::factorise(const LinearSystem<float>&);
template void CoarseSpace::factorise(const LinearSystem<double>&);
template void CoarseSpace::add_correction(const LinearSystem<float>&, std::span<const Lane<float>>,
                                          std::span<Lane<float>>);
template void CoarseSpace::add_correction(const LinearSystem<double>&, std::span<const Lane<double>>,
                                          std::span<Lane<double>>);

}  // namespace toile
