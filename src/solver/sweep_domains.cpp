#include "solver/sweep_domains.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <type_traits>

namespace toile::internal {
namespace {

// Two for up to 16,000 particles, then more; below a thousand particles waiting costs more than is gained.  Few enough that a band does not
// cover most of a strip: the rows that it couples would be in one epoch.
std::size_t wanted_domains(const BlockPattern& pattern) {
  const std::size_t particles = at(pattern.rows());
  std::size_t domains = particles < 2000 ? 1 : 2;
  while (domains < 16 && particles / domains > 8000) domains *= 2;
  while (domains > 2 && 4 * at(pattern.bandwidth()) > 3 * particles / (domains * strips_at_once)) domains /= 2;
  return domains;
}

// The ends of neighbouring domains meet at the end of one's time and the beginning of the other's.
std::size_t wanted_epochs(std::size_t domains, const BlockPattern& pattern) {
  if (domains == 1) return 1;
  return 2 * at(pattern.bandwidth()) <= at(pattern.rows()) / (domains * strips_at_once) ? 2 : 4;
}

constexpr Index times_between_stops = 8;

bool same_contact(const ImplicitRow& a, const ImplicitRow& b) {
  return a.particle == b.particle && a.weight == b.weight;
}

}  // namespace

template <class T>
void SweepDomains<T>::Couplings::clear() {
  earlier.clear();
  later.clear();
  together.clear();
}

template <class T>
void SweepDomains<T>::Couplings::sort() {
  const auto sooner = [](const Coupling& a, const Coupling& b) { return a.time < b.time; };
  std::stable_sort(earlier.begin(), earlier.end(), sooner);
  std::stable_sort(later.begin(), later.end(), sooner);
}

template <class T>
std::size_t SweepDomains<T>::domain_of(Index place) const {
  const auto strip = std::upper_bound(strip_begin_.begin(), strip_begin_.end(), place) - strip_begin_.begin() - 1;
  return static_cast<std::size_t>(strip) / strips_at_once;
}

template <class T>
std::size_t SweepDomains<T>::epoch_of(Index time) const {
  return static_cast<std::size_t>(std::upper_bound(epoch_begin_.begin(), epoch_begin_.end(), time) -
                                  epoch_begin_.begin()) -
         1;
}

template <class T>
void SweepDomains<T>::add(Coupling coupling, std::vector<Couplings>& to) const {
  const std::size_t domain = domain_of(coupling.own);
  const Index own = time_[at(coupling.own)], other = time_[at(coupling.other)];
  if (domain == domain_of(coupling.other)) {
    // The time of a coupling: grouped with others if possible, after the one row is known and before the other is needed, and in the epoch of
    // its own row: in another one, other domains read that row.
    const std::size_t epoch = epoch_of(own);
    const Index group = own - own % times_between_stops;
    if (other < own) {
      const Index first = std::max(group, epoch_begin_[epoch]);
      coupling.time = first > other ? first : own;
      to[domain].earlier.push_back(coupling);
    } else if (other > own) {
      const Index last = std::min(group + times_between_stops, epoch_begin_[epoch + 1]) - 1;
      coupling.time = last < other ? last : own;
      to[domain].later.push_back(coupling);
    } else {
      to[domain].together.push_back(coupling);
    }
    return;
  }
  const std::size_t own_epoch = epoch_of(own), other_epoch = epoch_of(other);
  if (other_epoch < own_epoch) {
    coupling.time = epoch_begin_[own_epoch];
    to[domain].earlier.push_back(coupling);
  } else if (other_epoch > own_epoch) {
    coupling.time = epoch_begin_[own_epoch + 1] - 1;
    to[domain].later.push_back(coupling);
  } else {
    to[domain].together.push_back(coupling);
  }
}

template <class T>
void SweepDomains<T>::cut(const BlockPattern& pattern) {
  if (pattern_ == &pattern && time_.size() == at(pattern.rows())) return;
  pattern_ = &pattern;
  const std::size_t n = at(pattern.rows()), domains = wanted_domains(pattern);
  strip_begin_.assign(1, 0);
  time_.clear();
  inner_.resize(domains);
  for (std::size_t d = 0; d < domains; ++d) {
    const std::size_t rows = n * (d + 1) / domains - n * d / domains;
    for (std::size_t strip = 0; strip < strips_at_once; ++strip) {
      const std::size_t length = rows / strips_at_once + (strip < rows % strips_at_once ? 1 : 0);
      strip_begin_.push_back(strip_begin_.back() + static_cast<Index>(length));
      for (std::size_t time = 0; time < length; ++time) time_.push_back(static_cast<Index>(time));
    }
    const std::span<const Index> begin = strip_begin_;
    inner_[d].arrange(pattern, begin.template last<strips_at_once + 1>());
  }
  const std::size_t epochs = wanted_epochs(domains, pattern), times = (n / domains + 1) / strips_at_once + 1;
  epoch_begin_.clear();
  for (std::size_t epoch = 0; epoch <= epochs; ++epoch)
    epoch_begin_.push_back(static_cast<Index>(times * epoch / epochs));
  of_A_.assign(domains, {});
  of_contacts_.assign(domains, {});
  rows_.assign(domains, {});
  held_.assign(domains, {});
  for (Index i = 0; i < pattern.rows(); ++i) {
    for (Slot slot = pattern.first_slot(i); slot < pattern.end_slot(i); ++slot) {
      const Index p = pattern.place(i), q = pattern.place(pattern.column(slot));
      if (domain_of(p) == domain_of(q) && time_[at(p)] != time_[at(q)]) continue;
      add({Block<T>{}, p, q, slot, false}, of_A_);
      add({Block<T>{}, q, p, slot, true}, of_A_);
    }
  }
  for (Couplings& couplings : of_A_) couplings.sort();
  version_ = 0;
}

template <class T>
void SweepDomains<T>::update(const LinearSystem<T>& system) {
  sort_rows(system);
  if (version_ == system.A().version()) return;  // passes of the active set change the rows only
  version_ = system.A().version();
  parallel_for(of_A_.size(), 1, [&](std::size_t d) {
    for (auto* couplings : {&of_A_[d].earlier, &of_A_[d].later, &of_A_[d].together}) {
      for (Coupling& coupling : *couplings) {
        const Block<T>& below = system.A().below(coupling.slot);
        coupling.block = coupling.below ? below : below.transpose();
      }
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
  for (Couplings& couplings : of_contacts_) couplings.clear();
  const std::span<const ImplicitRow> rows = system.rows();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (unsigned k = 0; k < 4; ++k) {
      if (rows[row].particle[k] < 0) continue;
      std::vector<OwnEnds>& own = rows_[domain_of(pattern_->place(rows[row].particle[k]))];
      if (own.empty() || own.back().row != static_cast<std::int32_t>(row))
        own.push_back({static_cast<std::int32_t>(row), 0});
      own.back().ends |= 1u << k;
    }
  }
  for (std::size_t first = 0, end = 0; first < rows.size(); first = end) {
    while (end < rows.size() && same_contact(rows[first], rows[end])) ++end;
    couple(rows.subspan(first, end - first));
  }
  for (Couplings& couplings : of_contacts_) couplings.sort();
  const std::span<const Index> constrained = system.constraints().constrained();
  for (std::size_t c = 0; c < constrained.size(); ++c) {
    const Index place = pattern_->place(constrained[c]);
    held_[domain_of(place)].push_back({c, place});
  }
}

// The blocks off the diagonal of rows along several directions between the same particles.
template <class T>
void SweepDomains<T>::couple(std::span<const ImplicitRow> rows) {
  const ImplicitRow& first = rows.front();
  if (std::count_if(first.particle.begin(), first.particle.end(), [](Index i) { return i >= 0; }) < 2) return;
  Mat3 K = Mat3::Zero();
  for (const ImplicitRow& row : rows) K += row.a * row.direction * row.direction.transpose();
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t l = 0; l < 4; ++l) {
      if (k == l || first.particle[k] < 0 || first.particle[l] < 0) continue;
      const Index own = pattern_->place(first.particle[k]), other = pattern_->place(first.particle[l]);
      add({Block<T>::from(first.weight[k] * first.weight[l] * K), own, other, -1, false}, of_contacts_);
    }
  }
}

// (D + L) D^-1 (D + U) s = r with A' = L + D + U in the order of the sweep.
//   forward    y = (D + L)^-1 r        h = r - L y = D y
//   backward   D s + U s = h,          so that A' s = h + L s: L s is pushed while the row of U is at hand, and no product with A'
//              is made at all                                                                          [Eisenstat 1981]
template <class T>
void SweepDomains<T>::forward(const LinearSystem<T>& system, std::size_t domain, std::size_t epoch,
                              std::span<Lane<T>> s, std::span<Lane<T>> As) const {
  const Index begin = epoch_begin_[epoch], end = epoch_begin_[epoch + 1];
  const auto from_begin = [begin](const std::vector<Coupling>& couplings) {
    const auto before = [](const Coupling& coupling, Index time) { return coupling.time < time; };
    return std::lower_bound(couplings.begin(), couplings.end(), begin, before);
  };
  const std::array lists{&of_A_[domain].earlier, &of_contacts_[domain].earlier};
  std::array next{from_begin(*lists[0]), from_begin(*lists[1])};
  for (Index time = begin; time < end;) {
    Index stop = end;
    for (std::size_t list = 0; list < lists.size(); ++list) {
      for (; next[list] != lists[list]->end() && next[list]->time == time; ++next[list])
        As[at(next[list]->own)] -= next[list]->block.times(s[at(next[list]->other)]);
      if (next[list] != lists[list]->end()) stop = std::min(stop, next[list]->time);
    }
    inner_[domain].forward(system.A(), time, stop, system.filtered_inverses_by_place(), s, As);
    time = stop;
  }
}

template <class T>
void SweepDomains<T>::backward(const LinearSystem<T>& system, std::size_t domain, std::size_t epoch,
                               std::span<Lane<T>> s, std::span<Lane<T>> As) const {
  const Index begin = epoch_begin_[epoch], end = epoch_begin_[epoch + 1];
  const auto from_end = [end](const std::vector<Coupling>& couplings) {
    const auto before = [](const Coupling& coupling, Index time) { return coupling.time < time; };
    return std::make_reverse_iterator(std::lower_bound(couplings.begin(), couplings.end(), end, before));
  };
  const std::span<const Block<T>> G = system.filtered_inverses_by_place();
  const std::array lists{&of_A_[domain].later, &of_contacts_[domain].later};
  std::array next{from_end(*lists[0]), from_end(*lists[1])};
  for (Index time = end; time > begin;) {  // times from `time` on are done
    Index stop = begin;
    for (std::size_t list = 0; list < lists.size(); ++list) {
      for (; next[list] != lists[list]->rend() && next[list]->time == time - 1; ++next[list]) {
        const std::size_t own = at(next[list]->own);
        s[own] -= G[own].times(next[list]->block.times(s[at(next[list]->other)]));
      }
      if (next[list] != lists[list]->rend()) stop = std::max(stop, next[list]->time + 1);
    }
    inner_[domain].backward(system.A(), stop, time, G, s, As);
    time = stop;
  }
}

// L s of the blocks outside the strips, and L s and U s of the blocks in no sweep.
template <class T>
void SweepDomains<T>::finish(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> s,
                             std::span<Lane<T>> As) const {
  for (const Couplings* couplings : {&of_A_[domain], &of_contacts_[domain]}) {
    for (const auto* list : {&couplings->earlier, &couplings->together}) {
      for (const Coupling& coupling : *list) As[at(coupling.own)] += coupling.block.times(s[at(coupling.other)]);
    }
  }
  filter(system, domain, As);
}

template <class T>
void SweepDomains<T>::add_rows(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> x,
                               std::span<Lane<T>> y) const {
  for (const OwnEnds& own : rows_[domain]) system.add_row_by_place(static_cast<std::size_t>(own.row), own.ends, x, y);
}

template <class T>
void SweepDomains<T>::add_rows(const LinearSystem<T>& system, std::size_t domain, std::span<const Vec3> x,
                               std::span<Vec3> y) const {
  for (const OwnEnds& own : rows_[domain]) system.add_row(static_cast<std::size_t>(own.row), own.ends, x, y);
}

template <class T>
void SweepDomains<T>::filter(const LinearSystem<T>& system, std::size_t domain, std::span<Lane<T>> y) const {
  for (const Held& held : held_[domain]) y[at(held.place)] = system.filtered(held.held, y[at(held.place)]);
}

template class SweepDomains<float>;
template class SweepDomains<double>;

}  // namespace toile::internal
