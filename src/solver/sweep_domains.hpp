// solver/sweep_domains.hpp: the particles cut into ranges that are swept side by side.
//
// A Gauss-Seidel sweep is a chain: every row needs the ones before it.  The rows are therefore cut into domains, one thread's work,
// and each of them into two strips, the two halves of a vector register.  A strip is swept as if it stood alone:  M = SSOR of the
// blocks inside strips; the blocks between two of them appear in A' only.  The cut depends on the number of particles and never on
// the number of threads or the width of registers, so that the result does not either.
#pragma once
#include "solver/linear_system.hpp"
#include "solver/paired_rows.hpp"

#include <vector>

namespace toile {

template <class T>
class SweepDomains {
 public:
  // The domains of a pattern; nothing is done when it is the one of the last call.
  void cut(const BlockPattern& pattern);
  // Call when the system has changed in any way.
  void update(const LinearSystem<T>& system);

  std::size_t count() const { return strip_begin_.size() / 2; }
  Index begin(std::size_t domain) const { return strip_begin_[2 * domain]; }
  Index end(std::size_t domain) const { return strip_begin_[2 * domain + 2]; }

  // s = M^-1 r and As = (A' less the blocks between strips and the rows off the diagonal) s, on one domain.
  void sweep(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> r, std::span<Lane<T>> s,
             std::span<Lane<T>> As) const;
  // As += (blocks between strips) s, on the rows of one domain.
  void add_between(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> s,
                   std::span<Lane<T>> As) const;
  // y += R x on one domain, of the sums that LinearSystem::sum_rows made.
  void add_rows(const LinearSystem<T>& system, std::size_t domain, RowPart part, std::span<const T> sums,
                std::span<const Lane<T>> x, std::span<Lane<T>> y) const;
  // y <- S y on one domain.
  void filter(const LinearSystem<T>& system, std::size_t domain, std::span<Lane<T>> y) const;

 private:
  struct Between {  // a block of A with its row and column in different strips
    Index own, other;
    Slot slot;
    bool below;  // the diagonal
  };
  std::size_t strip_of(Index particle) const;
  std::size_t domain_of(Index particle) const { return strip_of(particle) / 2; }
  void sort_rows(const LinearSystem<T>& system);

  const BlockPattern* pattern_ = nullptr;
  Index particles_ = -1;
  std::uint64_t version_ = 0;                   // of the blocks in paired_
  std::vector<Index> strip_begin_{0, 0, 0};     // two per domain, and the end of the last
  std::vector<Slot> inner_end_;                 // [row] the row's blocks inside its strip end here
  std::vector<PairedRows> paired_;              // [domain] in float only
  std::vector<std::vector<Between>> between_;   // [domain]
  std::vector<std::vector<RowEnd>> row_ends_;   // [domain] ends of rows on its particles, rows ascending
  std::vector<std::vector<std::size_t>> held_;  // [domain] positions in ParticleConstraints::constrained
};

extern template class SweepDomains<float>;
extern template class SweepDomains<double>;

}  // namespace toile
