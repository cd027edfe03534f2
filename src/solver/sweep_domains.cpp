#include "solver/sweep_domains.hpp"

#include <algorithm>

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
  return static_cast<std::size_t>(std::upper_bound(begin_.begin(), begin_.end(), particle) - begin_.begin()) - 1;
}

template <class T>
void SweepDomains<T>::cut(const BlockPattern& pattern) {
  if (pattern_ == &pattern && particles_ == pattern.rows()) return;
  pattern_ = &pattern;
  particles_ = pattern.rows();
  const std::size_t n = at(particles_), domains = wanted_domains(n);
  begin_.clear();
  for (std::size_t d = 0; d <= domains; ++d) begin_.push_back(static_cast<Index>(n * d / domains));
  inner_end_.resize(n);
  between_.assign(domains, {});
  row_ends_.assign(domains, {});
  held_.assign(domains, {});
  for (Index i = 0; i < particles_; ++i) {
    const std::size_t d = domain_of(i);
    Slot slot = pattern.first_slot(i);
    while (slot < pattern.end_slot(i) && pattern.column(slot) < end(d)) ++slot;  // columns ascend
    inner_end_[at(i)] = slot;
    for (; slot < pattern.end_slot(i); ++slot) {
      const Index j = pattern.column(slot);
      between_[d].push_back({i, j, slot, false});
      between_[domain_of(j)].push_back({j, i, slot, true});
    }
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

// (D + L) D^-1 (D + U) s = r with A' = L + D + U inside the domain: rows and other domains enter the sweeps through D only.
//   forward    y = (D + L)^-1 r        h = r - L y = D y
//   backward   D s + U s = h,          so that A' s = h + L s: L s is pushed while the row of U is at hand, and no product with A'
//              is made at all                                                                          [Eisenstat 1981]
template <class T>
void SweepDomains<T>::sweep(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> r,
                            std::span<Lane<T>> s, std::span<Lane<T>> As) const {
  const BlockPattern& pattern = *pattern_;
  const std::size_t first = at(begin(domain)), last = at(end(domain));
  std::copy(r.begin() + begin(domain), r.begin() + end(domain), As.begin() + begin(domain));
  for (std::size_t i = first; i < last; ++i) {
    const Lane<T> y = system.filtered_inverse_block(static_cast<Index>(i)).times(As[i]);
    s[i] = y;
    for (Slot slot = pattern.first_slot(static_cast<Index>(i)), stop = inner_end_[i]; slot < stop; ++slot)
      As[at(pattern.column(slot))] -= system.A().below(slot).times(y);
  }
  for (std::size_t i = last; i-- > first;) {
    Lane<T> sum{0, 0, 0, 0};
    const Slot start = pattern.first_slot(static_cast<Index>(i)), stop = inner_end_[i];
    for (Slot slot = start; slot < stop; ++slot)
      sum += system.A().below(slot).transpose_times(s[at(pattern.column(slot))]);
    const Lane<T> s_i = s[i] - system.filtered_inverse_block(static_cast<Index>(i)).times(sum);
    s[i] = s_i;
    for (Slot slot = start; slot < stop; ++slot) As[at(pattern.column(slot))] += system.A().below(slot).times(s_i);
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
