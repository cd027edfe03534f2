#include "solver/sweep_domains.hpp"

#include <algorithm>
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
std::size_t SweepDomains<T>::strip_of(Index particle) const {
  return static_cast<std::size_t>(std::upper_bound(strip_begin_.begin(), strip_begin_.end(), particle) -
                                  strip_begin_.begin()) -
         1;
}

template <class T>
void SweepDomains<T>::cut(const BlockPattern& pattern) {
  if (pattern_ == &pattern && particles_ == pattern.rows()) return;
  pattern_ = &pattern;
  particles_ = pattern.rows();
  const std::size_t n = at(particles_), domains = wanted_domains(n);
  strip_begin_.assign(1, 0);
  for (std::size_t d = 0; d < domains; ++d) {
    const std::size_t first = n * d / domains, last = n * (d + 1) / domains;
    strip_begin_.push_back(static_cast<Index>(first + (last - first + 1) / 2));
    strip_begin_.push_back(static_cast<Index>(last));
  }
  inner_end_.resize(n);
  between_.assign(domains, {});
  row_ends_.assign(domains, {});
  held_.assign(domains, {});
  for (Index i = 0; i < particles_; ++i) {
    const std::size_t strip = strip_of(i);
    Slot slot = pattern.first_slot(i);
    while (slot < pattern.end_slot(i) && pattern.column(slot) < strip_begin_[strip + 1]) ++slot;  // columns ascend
    inner_end_[at(i)] = slot;
    for (; slot < pattern.end_slot(i); ++slot) {
      const Index j = pattern.column(slot);
      between_[strip / 2].push_back({i, j, slot, false});
      between_[domain_of(j)].push_back({j, i, slot, true});
    }
  }
  version_ = 0;
  if constexpr (std::is_same_v<T, float>) {
    paired_.resize(domains);
    for (std::size_t d = 0; d < domains; ++d)
      paired_[d].arrange(pattern, strip_begin_[2 * d], strip_begin_[2 * d + 1], strip_begin_[2 * d + 2]);
  }
}

template <class T>
void SweepDomains<T>::update(const LinearSystem<T>& system) {
  sort_rows(system);
  if constexpr (std::is_same_v<T, float>) {
    if (version_ == system.A().version()) return;  // passes of the active set change the rows only
    version_ = system.A().version();
    for (PairedRows& rows : paired_) rows.copy(system.A());
  }
}

template <class T>
void SweepDomains<T>::sort_rows(const LinearSystem<T>& system) {
  for (auto& ends : row_ends_) ends.clear();
  for (auto& held : held_) held.clear();
  const std::span<const ImplicitRow> rows = system.rows();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (rows[row].particle[k] >= 0)
        row_ends_[domain_of(rows[row].particle[k])].push_back({static_cast<std::int32_t>(row), static_cast<int>(k)});
    }
  }
  const std::span<const Index> constrained = system.constraints().constrained();
  for (std::size_t c = 0; c < constrained.size(); ++c) held_[domain_of(constrained[c])].push_back(c);
}

// (D + L) D^-1 (D + U) s = r with A' = L + D + U inside a strip: rows and other strips enter the sweeps through D only.
//   forward    y = (D + L)^-1 r        h = r - L y = D y
//   backward   D s + U s = h,          so that A' s = h + L s: L s is pushed while the row of U is at hand, and no product with A'
//              is made at all                                                                          [Eisenstat 1981]
template <class T>
void SweepDomains<T>::sweep(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> r,
                            std::span<Lane<T>> s, std::span<Lane<T>> As) const {
  if constexpr (std::is_same_v<T, float>) {
    sweep_strips(paired_[domain].strips(), &system.filtered_inverse_block(0), r.data(), s.data(), As.data());
  } else {  // the same as it is written in books, for tests and references
    const BlockPattern& pattern = *pattern_;
    const std::size_t first = at(begin(domain)), last = at(end(domain));
    std::copy(r.begin() + begin(domain), r.begin() + end(domain), As.begin() + begin(domain));
    for (std::size_t i = first; i < last; ++i) {
      s[i] = system.filtered_inverse_block(static_cast<Index>(i)).times(As[i]);
      for (Slot slot = pattern.first_slot(static_cast<Index>(i)); slot < inner_end_[i]; ++slot)
        As[at(pattern.column(slot))] -= system.A().below(slot).times(s[i]);
    }
    for (std::size_t i = last; i-- > first;) {
      Lane<T> sum{0, 0, 0, 0};
      for (Slot slot = pattern.first_slot(static_cast<Index>(i)); slot < inner_end_[i]; ++slot)
        sum += system.A().below(slot).transpose_times(s[at(pattern.column(slot))]);
      s[i] -= system.filtered_inverse_block(static_cast<Index>(i)).times(sum);
      for (Slot slot = pattern.first_slot(static_cast<Index>(i)); slot < inner_end_[i]; ++slot)
        As[at(pattern.column(slot))] += system.A().below(slot).times(s[i]);
    }
  }
}

template <class T>
void SweepDomains<T>::add_between(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> s,
                                  std::span<Lane<T>> As) const {
  for (const Between& between : between_[domain]) {
    const Block<T>& block = system.A().below(between.slot);
    const Lane<T>& x = s[at(between.other)];
    As[at(between.own)] += between.below ? block.times(x) : block.transpose_times(x);
  }
}

template <class T>
void SweepDomains<T>::add_rows(const LinearSystem<T>& system, std::size_t domain, RowPart part, std::span<const T> sums,
                               std::span<const Lane<T>> x, std::span<Lane<T>> y) const {
  for (const RowEnd& row_end : row_ends_[domain]) system.add_row(row_end, part, sums, x, y);
}

template <class T>
void SweepDomains<T>::filter(const LinearSystem<T>& system, std::size_t domain, std::span<Lane<T>> y) const {
  for (const std::size_t held : held_[domain]) system.filter_held(held, y);
}

template class SweepDomains<float>;
template class SweepDomains<double>;

}  // namespace toile
