#include "solver/sweep_domains.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <numeric>
#include <type_traits>

namespace toile {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

// Two for up to 16,000 particles, then more: a domain costs a few iterations, and below a thousand particles waiting costs more
// than is gained.
std::size_t wanted_domains(std::size_t particles) {
  std::size_t domains = particles < 2000 ? 1 : 2;
  while (domains < 16 && particles / domains > 8000) domains *= 2;
  return domains;
}

}  // namespace

template <class T>
std::size_t SweepDomains<T>::domain_of(Index particle) const {
  const auto strip = std::upper_bound(strip_begin_.begin(), strip_begin_.end(), particle) - strip_begin_.begin() - 1;
  return static_cast<std::size_t>(strip) / strips_at_once;
}

template <class T>
void SweepDomains<T>::cut(const BlockPattern& pattern) {
  if (pattern_ == &pattern && particles_ == pattern.rows()) return;
  pattern_ = &pattern;
  particles_ = pattern.rows();
  const std::size_t n = at(particles_), domains = wanted_domains(n);
  strip_begin_.assign(1, 0);
  inner_.resize(domains);
  for (std::size_t d = 0; d < domains; ++d) {
    const std::size_t rows = n * (d + 1) / domains - n * d / domains;
    for (std::size_t strip = 0; strip < strips_at_once; ++strip) {
      const std::size_t longer = strip < rows % strips_at_once ? 1 : 0;
      strip_begin_.push_back(strip_begin_.back() + static_cast<Index>(rows / strips_at_once + longer));
    }
    const std::span<const Index> begin = strip_begin_;
    inner_[d].arrange(pattern, begin.template last<strips_at_once + 1>());
  }
  between_.assign(domains, {});
  rows_.assign(domains, {});
  held_.assign(domains, {});
  for (Index i = 0; i < particles_; ++i) {
    const std::size_t domain = domain_of(i);
    for (Slot slot = pattern.first_slot(i); slot < pattern.end_slot(i); ++slot) {
      const Index j = pattern.column(slot);
      const std::size_t other = domain_of(j);
      if (domain == other && inner_[domain].time(i) != inner_[domain].time(j)) continue;
      between_[domain].push_back(Between{Block<T>{}, i, j, slot, false});
      between_[other].push_back(Between{Block<T>{}, j, i, slot, true});
    }
  }
  version_ = 0;
}

template <class T>
void SweepDomains<T>::update(const LinearSystem<T>& system) {
  sort_rows(system);
  if (version_ == system.A().version()) return;  // passes of the active set change the rows only
  version_ = system.A().version();
  parallel_for(between_.size(), 1, [&](std::size_t d) {
    for (Between& between : between_[d]) {
      const Block<T>& below = system.A().below(between.slot);
      between.block = between.below ? below : below.transpose();
    }
  });
  if constexpr (std::is_same_v<T, float>) {
    for (StripRows& rows : inner_) rows.copy(system.A());
  }
}

template <class T>
void SweepDomains<T>::sort_rows(const LinearSystem<T>& system) {
  for (auto& rows : rows_) rows.clear();
  for (auto& held : held_) held.clear();
  const std::span<const ImplicitRow> rows = system.rows();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (unsigned k = 0; k < 4; ++k) {
      if (rows[row].particle[k] < 0) continue;
      std::vector<OwnEnds>& own = rows_[domain_of(rows[row].particle[k])];
      if (own.empty() || own.back().row != static_cast<std::int32_t>(row))
        own.push_back({static_cast<std::int32_t>(row), 0});
      own.back().ends |= 1u << k;
    }
  }
  const std::span<const Index> constrained = system.constraints().constrained();
  for (std::size_t c = 0; c < constrained.size(); ++c) held_[domain_of(constrained[c])].push_back(c);
}

// (D + L) D^-1 (D + U) s = r with A' = L + D + U inside a domain: rows and other domains enter the sweeps through D only.
//   forward    y = (D + L)^-1 r        h = r - L y = D y
//   backward   D s + U s = h,          so that A' s = h + L s: L s is pushed while the row of U is at hand, and no product with A'
//              is made at all                                                                          [Eisenstat 1981]
template <class T>
void SweepDomains<T>::sweep(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> r,
                            std::span<Lane<T>> s, std::span<Lane<T>> As) const {
  if constexpr (std::is_same_v<T, float>) {
    sweep_strips(inner_[domain].strips(), &system.filtered_inverse_block(0), r.data(), s.data(), As.data());
  } else {  // the same as it is written in books, for tests and references
    const StripRows& inner = inner_[domain];
    std::vector<Index> order(at(end(domain) - begin(domain)));
    std::iota(order.begin(), order.end(), begin(domain));
    std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return inner.time(i) < inner.time(j); });
    // work(j, A_ji, A_ij) of the later rows j.
    const auto for_later = [&](Index i, const auto& work) {
      const auto is_later = [&](Index j) {
        return j >= begin(domain) && j < end(domain) && inner.time(j) > inner.time(i);
      };
      for (Slot slot = pattern_->first_slot(i); slot < pattern_->end_slot(i); ++slot) {
        const Block<T>& below = system.A().below(slot);
        if (is_later(pattern_->column(slot))) work(at(pattern_->column(slot)), below, below.transpose());
      }
      for (const auto& above : pattern_->above(i)) {
        const Block<T>& below = system.A().below(above.slot);
        if (is_later(above.row)) work(at(above.row), below.transpose(), below);
      }
    };
    std::copy(r.begin() + begin(domain), r.begin() + end(domain), As.begin() + begin(domain));
    for (const Index i : order) {
      s[at(i)] = system.filtered_inverse_block(i).times(As[at(i)]);
      for_later(i, [&](std::size_t j, const Block<T>& A_ji, const Block<T>&) { As[j] -= A_ji.times(s[at(i)]); });
    }
    for (auto row = order.rbegin(); row != order.rend(); ++row) {
      const Index i = *row;
      Lane<T> sum{0, 0, 0, 0};
      for_later(i, [&](std::size_t j, const Block<T>&, const Block<T>& A_ij) { sum += A_ij.times(s[j]); });
      s[at(i)] -= system.filtered_inverse_block(i).times(sum);
      for_later(i, [&](std::size_t j, const Block<T>& A_ji, const Block<T>&) { As[j] += A_ji.times(s[at(i)]); });
    }
  }
}

template <class T>
void SweepDomains<T>::add_between(std::size_t domain, std::span<const Lane<T>> s, std::span<Lane<T>> As) const {
  for (const Between& between : between_[domain]) As[at(between.own)] += between.block.times(s[at(between.other)]);
}

template <class T>
void SweepDomains<T>::add_rows(const LinearSystem<T>& system, std::size_t domain, RowPart part,
                               std::span<const Lane<T>> x, std::span<Lane<T>> y) const {
  for (const OwnEnds& own : rows_[domain]) system.add_row(static_cast<std::size_t>(own.row), own.ends, part, x, y);
}

template <class T>
void SweepDomains<T>::add_rows(const LinearSystem<T>& system, std::size_t domain, std::span<const Vec3> x,
                               std::span<Vec3> y) const {
  for (const OwnEnds& own : rows_[domain]) system.add_row(static_cast<std::size_t>(own.row), own.ends, x, y);
}

template <class T>
void SweepDomains<T>::filter(const LinearSystem<T>& system, std::size_t domain, std::span<Lane<T>> y) const {
  for (const std::size_t held : held_[domain]) system.filter_held(held, y);
}

template class SweepDomains<float>;
template class SweepDomains<double>;

}  // namespace toile
