#include "solver/coarse_space.hpp"

#include "core/denormals.hpp"
#include "core/disjoint_sets.hpp"
#include "core/parallel.hpp"
#include "solver/sweep_kernels.hpp"
#include "solver/vector_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace toile::internal {
namespace {

// Of the whole cloth.  Twice as many save a tenth of the iterations, but cost as much time.
double wanted_aggregates(std::size_t particles) { return std::clamp(static_cast<double>(particles) / 240, 1.0, 512.0); }

constexpr std::size_t most_pieces = 24;  // of a panel; more stay together
constexpr std::size_t particles_per_block = 256;

// Splits members[begin, end) into `parts` of equal size, always across the longer pattern direction.
void bisect(std::vector<Index>& members, std::size_t begin, std::size_t end, std::size_t parts, const Vec2s& uv,
            std::vector<Index>& aggregate, int& count) {
  if (parts == 1) {
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
  const std::size_t left = parts / 2, middle = begin + (end - begin) * left / parts;
  bisect(members, begin, middle, left, uv, aggregate, count);
  bisect(members, middle, end, parts - left, uv, aggregate, count);
}

// [particle] the smallest particle of its connected component.
std::vector<Index> connected_to(const ClothMesh& mesh) {
  DisjointSets sets(static_cast<std::size_t>(mesh.particle_count));
  for (const Triangle& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  return sets.representatives();
}

// The sets that are cut into aggregates: the particles of each panel, or of each of its components.  Two components in one aggregate
// could drift apart: only their total momentum would be kept.  The smallest of very many components stay together.
std::vector<std::vector<Index>> patches(const ClothMesh& mesh, const std::vector<Index>& panel, Index panels) {
  const std::vector<Index> root = connected_to(mesh);
  std::vector<std::vector<Index>> patches;
  for (Index k = 0; k < panels; ++k) {
    std::vector<std::vector<Index>> pieces;
    std::vector<std::pair<Index, Index>> members;  // (root, particle)
    for (std::size_t p = 0; p < panel.size(); ++p) {
      if (panel[p] == k) members.emplace_back(root[p], static_cast<Index>(p));
    }
    std::sort(members.begin(), members.end());
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (m == 0 || members[m].first != members[m - 1].first) pieces.emplace_back();
      pieces.back().push_back(members[m].second);
    }
    std::stable_sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
    for (std::size_t piece = most_pieces; piece < pieces.size(); ++piece)
      pieces[most_pieces - 1].insert(pieces[most_pieces - 1].end(), pieces[piece].begin(), pieces[piece].end());
    if (pieces.size() > most_pieces) pieces.resize(most_pieces);
    patches.insert(patches.end(), pieces.begin(), pieces.end());
  }
  return patches;
}

}  // namespace

template <class T>
CoarseSpace<T>::CoarseSpace(const ClothMesh& mesh) {
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
  const double size = static_cast<double>(particles) / wanted_aggregates(particles);
  for (std::vector<Index>& members : patches(mesh, panel, panels)) {
    const auto parts = static_cast<std::size_t>(std::lround(static_cast<double>(members.size()) / size));
    bisect(members, 0, members.size(), std::max<std::size_t>(parts, 1), uv, aggregate_, aggregate_count_);
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
  members_.resize(static_cast<std::size_t>(aggregate_count_));
  for (std::size_t p = 0; p < particles; ++p)
    members_[static_cast<std::size_t>(aggregate_[p])].push_back(static_cast<Index>(p));
  rhs_.resize(static_cast<std::size_t>(dimension()));
}

// The aggregates that the row of a particle reaches, in the order of places.
template <class T>
void CoarseSpace<T>::find_entries(const BlockPattern& pattern) {
  pattern_ = &pattern;
  const auto n = static_cast<std::size_t>(pattern.rows());
  entry_begin_.assign(1, 0);
  entry_begin_.reserve(n + 1);
  entry_aggregate_.clear();
  for (std::vector<Index>& members : members_) {  // in the order in which their entries lie
    std::sort(members.begin(), members.end(), [&](Index a, Index b) { return pattern.place(a) < pattern.place(b); });
  }
  basis_at_.resize(n);
  aggregate_at_.resize(n);
  for (Index place = 0; place < pattern.rows(); ++place) {
    const Index i = pattern.row_at(place);
    basis_at_[static_cast<std::size_t>(place)] = basis_[static_cast<std::size_t>(i)];
    aggregate_at_[static_cast<std::size_t>(place)] = aggregate_[static_cast<std::size_t>(i)];
    const auto reach = [&](Index particle) {
      const Index aggregate = aggregate_[static_cast<std::size_t>(particle)];
      const auto first = entry_aggregate_.begin() + entry_begin_.back();
      if (std::find(first, entry_aggregate_.end(), aggregate) == entry_aggregate_.end())
        entry_aggregate_.push_back(aggregate);
    };
    reach(i);
    for (const auto& above : pattern.above(i)) reach(above.row);
    for (Slot s = pattern.first_slot(i); s < pattern.end_slot(i); ++s) reach(pattern.column(s));
    entry_begin_.push_back(static_cast<std::int32_t>(entry_aggregate_.size()));
  }
  const auto entry = [&](Index i, Index aggregate) {
    std::int32_t e = entry_begin_[static_cast<std::size_t>(pattern.place(i))];
    while (entry_aggregate_[static_cast<std::size_t>(e)] != aggregate) ++e;
    return e;
  };
  slot_entry_.clear();
  slot_entry_.reserve(static_cast<std::size_t>(pattern.block_count()));
  for (Index i = 0; i < pattern.rows(); ++i) {
    for (Slot s = pattern.first_slot(i); s < pattern.end_slot(i); ++s) {
      const Index j = pattern.column(s);
      slot_entry_.push_back(
          {entry(i, aggregate_[static_cast<std::size_t>(j)]), entry(j, aggregate_[static_cast<std::size_t>(i)])});
    }
  }
  AZ_.resize(entry_aggregate_.size());
  version_ = 0;
  find_blocks();
}

// The blocks of E from A, sorted by the aggregate of their columns, and the block that each entry belongs to.
template <class T>
void CoarseSpace<T>::find_blocks() {
  couples_of_A_.clear();
  couple_begin_.assign(1, 0);
  entry_couple_.assign(entry_aggregate_.size(), -1);
  for (Index aggregate = 0; aggregate < aggregate_count_; ++aggregate) {
    const auto first = static_cast<std::ptrdiff_t>(couples_of_A_.size());
    for (const Index member : members_[static_cast<std::size_t>(aggregate)]) {
      const auto p = static_cast<std::size_t>(pattern_->place(member));
      for (auto e = static_cast<std::size_t>(entry_begin_[p]); e < static_cast<std::size_t>(entry_begin_[p + 1]); ++e) {
        if (entry_aggregate_[e] > aggregate) continue;
        const std::pair<Index, Index> couple{entry_aggregate_[e], aggregate};
        const auto found = std::find(couples_of_A_.begin() + first, couples_of_A_.end(), couple);
        entry_couple_[e] = static_cast<std::int32_t>(found - couples_of_A_.begin());
        if (found == couples_of_A_.end()) couples_of_A_.push_back(couple);
      }
    }
    couple_begin_.push_back(static_cast<std::int32_t>(couples_of_A_.size()));
  }
  E_of_A_.resize(couples_of_A_.size());
}

namespace {

template <class T>
void add_columns(std::array<Lane<T>, 9>& sum, const Block<T>& B, const std::array<T, 3>& q) {
  for (std::size_t l = 0; l < 3; ++l) {
    sum[3 * l] += B.c0 * q[l];
    sum[3 * l + 1] += B.c1 * q[l];
    sum[3 * l + 2] += B.c2 * q[l];
  }
}

template <class T>
Block<T> product(const Block<T>& A, const Block<T>& B) {
  return {A.times(B.c0), A.times(B.c1), A.times(B.c2)};
}

}  // namespace

template <class T>
void CoarseSpace<T>::find_stale_rows(const LinearSystem<T>& system) {
  const BlockPattern& pattern = system.A().pattern();
  const ParticleConstraints& constraints = system.constraints();
  const auto n = static_cast<std::size_t>(pattern.rows());
  const bool all = version_ != system.A().version();
  version_ = system.A().version();
  was_held_.resize(n, 0);
  held_.reserve(n);  // untouched without constraints
  S_of_held_.reserve(n);
  stale_.assign(n, all);
  const auto compare = [&](Index i, const Mat3& before) {
    if (before == constraints.S(i)) return;
    stale_[static_cast<std::size_t>(i)] = 1;
    for (const auto& above : pattern.above(i)) stale_[static_cast<std::size_t>(above.row)] = 1;
    for (Slot s = pattern.first_slot(i); s < pattern.end_slot(i); ++s)
      stale_[static_cast<std::size_t>(pattern.column(s))] = 1;
  };
  const std::span<const Index> held = constraints.constrained();
  for (std::size_t k = 0; k < held_.size(); ++k) compare(held_[k], S_of_held_[k]);
  for (const Index i : held)
    if (!was_held_[static_cast<std::size_t>(i)]) compare(i, Mat3::Identity());
  for (const Index i : held_) was_held_[static_cast<std::size_t>(i)] = 0;
  held_.assign(held.begin(), held.end());
  S_of_held_.clear();
  for (const Index i : held) {
    was_held_[static_cast<std::size_t>(i)] = 1;
    S_of_held_.push_back(constraints.S(i));
  }
}

// Written with differences as the product is (assembly/block_matrix.hpp): (A Z)_i = G_i Z_i + sum_j L_ij (Z_j - Z_i).
template <class T>
void CoarseSpace<T>::multiply_basis(const LinearSystem<T>& system) {
  const BlockPattern& pattern = system.A().pattern();
  const ParticleConstraints& constraints = system.constraints();
  const auto q_of = [&](Index i) {
    const Vec3& q = basis_[static_cast<std::size_t>(i)];
    return std::array<T, 3>{static_cast<T>(q[0]), static_cast<T>(q[1]), static_cast<T>(q[2])};
  };
  parallel_for(static_cast<std::size_t>(pattern.rows()), particles_per_block, [&](std::size_t row) {
    if (!stale_[row]) return;
    const DenormalsAreZero here;
    const auto i = static_cast<Index>(row);
    const auto place = static_cast<std::size_t>(pattern.place(i));
    const auto own = static_cast<std::size_t>(entry_begin_[place]),
               end = static_cast<std::size_t>(entry_begin_[place + 1]);
    Columns none;
    none.fill(to_lane<T>(Vec3::Zero()));
    std::fill(AZ_.begin() + entry_begin_[place], AZ_.begin() + entry_begin_[place + 1], none);
    const std::array<T, 3> q_i = q_of(i);
    const bool i_free = constraints.is_free(i);
    // The terms of the particle's own aggregate: the columns, and the blocks that all come before S_i q_i.
    Columns columns = none;
    Block<T> before_own = Block<T>::from(Mat3::Zero());
    // L_ij (S_j Z_j - S_i Z_i)
    const auto add = [&](const Block<T>& L, Index j, std::size_t other) {
      const std::array<T, 3> q_j = q_of(j);
      const bool j_free = constraints.is_free(j);
      if (i_free && j_free && other == own) {
        const T u = q_j[1] - q_i[1], v = q_j[2] - q_i[2];
        columns[3] += L.c0 * u;
        columns[4] += L.c1 * u;
        columns[5] += L.c2 * u;
        columns[6] += L.c0 * v;
        columns[7] += L.c1 * v;
        columns[8] += L.c2 * v;
        return;
      }
      before_own.c0 -= L.c0;
      before_own.c1 -= L.c1;
      before_own.c2 -= L.c2;
      add_columns(other == own ? columns : AZ_[other], j_free ? L : product(L, Block<T>::from(constraints.S(j))), q_j);
    };
    for (const auto& [above, slot] : pattern.above(i))
      add(system.A().below(slot), above, static_cast<std::size_t>(slot_entry_[static_cast<std::size_t>(slot)][1]));
    for (Slot s = pattern.first_slot(i); s < pattern.end_slot(i); ++s)
      add(system.A().below(s).transpose(), pattern.column(s),
          static_cast<std::size_t>(slot_entry_[static_cast<std::size_t>(s)][0]));
    const Block<T> G = system.A().grounded_block(i);
    before_own.c0 += G.c0;
    before_own.c1 += G.c1;
    before_own.c2 += G.c2;
    const Block<T> S_i = Block<T>::from(constraints.S(i));
    add_columns(columns, i_free ? before_own : product(before_own, S_i), q_i);
    AZ_[own] = columns;
    if (i_free) return;
    for (std::size_t e = own; e < end; ++e) {
      for (Lane<T>& column : AZ_[e]) column = S_i.times(column);
    }
  });
}

// The columns of Z^T A' Z of an aggregate, if they have changed.
template <class T>
void CoarseSpace<T>::sum_columns(std::size_t aggregate) {
  const std::vector<Index>& members = members_[aggregate];
  const auto is_stale = [&](Index i) { return stale_[static_cast<std::size_t>(i)] != 0; };
  if (std::none_of(members.begin(), members.end(), is_stale)) return;
  std::fill(E_of_A_.begin() + couple_begin_[aggregate], E_of_A_.begin() + couple_begin_[aggregate + 1],
            std::array<double, 81>{});
  for (const Index member : members) {
    const auto p = static_cast<std::size_t>(pattern_->place(member));
    const double q[3] = {basis_at_[p][0], basis_at_[p][1], basis_at_[p][2]};
    for (auto e = static_cast<std::size_t>(entry_begin_[p]); e < static_cast<std::size_t>(entry_begin_[p + 1]); ++e) {
      if (entry_couple_[e] < 0) continue;
      std::array<double, 81>& block = E_of_A_[static_cast<std::size_t>(entry_couple_[e])];
      for (std::size_t m = 0; m < 9; ++m) {
        const Lane<T>& column = AZ_[e][m];
        const double c[3] = {static_cast<double>(column[0]), static_cast<double>(column[1]),
                             static_cast<double>(column[2])};
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t r = 0; r < 3; ++r) block[9 * m + 3 * k + r] += q[k] * c[r];
        }
      }
    }
  }
}

// The aggregates that a row couples, at most four.
template <class T>
std::size_t CoarseSpace<T>::aggregates_of(const ImplicitRow& row, std::array<Index, 4>& aggregates) const {
  std::size_t count = 0;
  for (const Index particle : row.particle) {
    if (particle < 0) continue;
    const Index aggregate = aggregate_[static_cast<std::size_t>(particle)];
    const auto end = aggregates.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(aggregates.begin(), end, aggregate) == end) aggregates[count++] = aggregate;
  }
  std::sort(aggregates.begin(), aggregates.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

// E += Z^T a g g^T Z
template <class T>
void CoarseSpace<T>::add_row(const ImplicitRow& row, const ParticleConstraints& constraints) {
  std::array<Index, 4> aggregates{};
  const std::size_t count = aggregates_of(row, aggregates);
  std::array<std::array<double, 9>, 4> Zg{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (row.particle[k] < 0) continue;
    const auto i = static_cast<std::size_t>(row.particle[k]);
    const auto at =
        static_cast<std::size_t>(std::find(aggregates.begin(), aggregates.end(), aggregate_[i]) - aggregates.begin());
    const Vec3 g =
        row.weight[k] *
        (constraints.is_free(row.particle[k]) ? row.direction : Vec3(constraints.S(row.particle[k]) * row.direction));
    for (std::size_t l = 0; l < 3; ++l) {
      for (std::size_t c = 0; c < 3; ++c)
        Zg[at][3 * l + c] += basis_[i][static_cast<Eigen::Index>(l)] * g[static_cast<Eigen::Index>(c)];
    }
  }
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t q = p; q < count; ++q) {
      double* block = E_.block(aggregates[p], aggregates[q]);
      for (std::size_t m = 0; m < 9; ++m) {
        const double factor = row.a * Zg[p][m];
        for (std::size_t k = 0; k < 9; ++k) block[9 * m + k] += factor * Zg[q][k];
      }
    }
  }
}

// E = Z^T (A Z) + rows.
template <class T>
void CoarseSpace<T>::sum_coarse_matrix(const LinearSystem<T>& system) {
  parallel_for(members_.size(), 1, [&](std::size_t aggregate) { sum_columns(aggregate); });
  couples_ = couples_of_A_;
  for (const ImplicitRow& row : system.rows()) {
    std::array<Index, 4> aggregates{};
    const std::size_t count = aggregates_of(row, aggregates);
    for (std::size_t p = 0; p < count; ++p) {
      for (std::size_t q = p + 1; q < count; ++q) couples_.emplace_back(aggregates[p], aggregates[q]);
    }
  }
  E_.begin(aggregate_count_, couples_);
  for (std::size_t c = 0; c < couples_of_A_.size(); ++c)
    std::copy(E_of_A_[c].begin(), E_of_A_[c].end(), E_.block(couples_of_A_[c].first, couples_of_A_[c].second));
  for (const ImplicitRow& row : system.rows()) add_row(row, system.constraints());
}

template <class T>
void CoarseSpace<T>::factorise(const LinearSystem<T>& system) {
  const BlockPattern& pattern = system.A().pattern();
  if (pattern_ != &pattern) find_entries(pattern);
  find_stale_rows(system);
  multiply_basis(system);
  sum_coarse_matrix(system);
  E_.factorise();
}

template <class T>
void CoarseSpace<T>::restrict(Index begin, Index end, std::span<const Lane<T>> r, std::span<const Lane<T>> At,
                              std::span<double> sum) const {
  std::fill(sum.begin(), sum.end(), 0.0);  // S^T r = r, so it is left out
  add_moments(begin, end, r.data(), At.data(), basis_at_.data(), aggregate_at_.data(), sum.data());
}

template <class T>
void CoarseSpace<T>::solve(std::span<const std::vector<double>> parts, Solution& solution) const {
  const auto n = static_cast<std::size_t>(dimension());
  std::vector<double>& rhs = solution.rhs;
  rhs.assign(n, 0.0);
  solution.y.resize(n);
  solution.affine.resize(n / 3);
  for (const std::vector<double>& part : parts) {
    for (std::size_t k = 0; k < n; ++k) rhs[k] += part[k];
  }
  E_.solve(rhs);
  for (std::size_t k = 0; k < n; ++k) {
    const T y = static_cast<T>(rhs[k]);
    solution.y[k] = Lane<T>{y, y, y, 0};
  }
  for (std::size_t k = 0; k < n / 3; ++k)
    solution.affine[k] = Lane<T>{solution.y[3 * k][0], solution.y[3 * k + 1][0], solution.y[3 * k + 2][0], 0};
}

// a + u' b + v' c
template <class T>
void CoarseSpace<T>::prolong(const Solution& solution, Index begin, Index end, std::span<Lane<T>> Zy) const {
  for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
    const Lane<T>* abc = &solution.affine[static_cast<std::size_t>(aggregate_at_[p]) * 3];
    Zy[p] = abc[0] + abc[1] * static_cast<T>(basis_at_[p][1]) + abc[2] * static_cast<T>(basis_at_[p][2]);
  }
}

template <class T>
void CoarseSpace<T>::add(const Solution& solution, Index begin, Index end, std::span<const Lane<T>> Zy,
                         std::span<Lane<T>> t, std::span<Lane<T>> At) const {
  if constexpr (std::is_same_v<T, float>) {
    add_coarse_columns({entry_begin_.data(), entry_aggregate_.data(), AZ_.data()->data(), solution.y.data()}, begin,
                       end, Zy.data(), t.data(), At.data());
  } else {
    for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
      t[p] += Zy[p];
      for (auto e = static_cast<std::size_t>(entry_begin_[p]); e < static_cast<std::size_t>(entry_begin_[p + 1]); ++e) {
        const Lane<T>* y = &solution.y[static_cast<std::size_t>(entry_aggregate_[e]) * 9];
        for (std::size_t m = 0; m < 9; ++m) At[p] += AZ_[e][m] * y[m];
      }
    }
  }
}

template <class T>
void CoarseSpace<T>::correct(const LinearSystem<T>& system, std::span<const Vec3> r, std::span<Vec3> dv) {
  parallel_for(members_.size(), 1, [&](std::size_t aggregate) {
    Eigen::Map<Mat3> y(&rhs_[aggregate * 9]);
    y.setZero();
    for (const Index p : members_[aggregate])
      y += r[static_cast<std::size_t>(p)] * basis_[static_cast<std::size_t>(p)].transpose();
  });
  E_.solve(rhs_);
  parallel_for(r.size(), particles_per_block, [&](std::size_t p) {
    const Eigen::Map<const Mat3> y(&rhs_[static_cast<std::size_t>(aggregate_[p]) * 9]);
    dv[p] += system.constraints().S(static_cast<Index>(p)) * (y * basis_[p]);
  });
}

template class CoarseSpace<float>;
template class CoarseSpace<double>;

}  // namespace toile::internal
