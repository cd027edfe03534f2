// solver/sweep_domains.hpp: the particles cut into ranges that are swept side by side.
//
// A Gauss-Seidel sweep is a chain: every row needs the ones before it.  The rows are therefore cut into domains, one thread's work,
// and each of them into four strips, the quarters of a vector register, which are swept side by side (strip_rows.hpp).  A domain is
// swept as if it stood alone:  M = SSOR of the blocks inside domains, in the order of the sweep; blocks between two of them, and the
// few between two rows that are swept at the same time, appear in A' only.  The cut depends on the number of particles and never on
// the number of threads or the width of registers, so that the result does not either.
#pragma once
#include "solver/linear_system.hpp"
#include "solver/strip_rows.hpp"

#include <vector>

namespace toile {

template <class T>
class SweepDomains {
 public:
  // The domains of a pattern; nothing is done when it is the one of the last call.
  void cut(const BlockPattern& pattern);
  // Call when the system has changed in any way.
  void update(const LinearSystem<T>& system);

  std::size_t count() const { return strip_begin_.size() / strips_at_once; }
  Index begin(std::size_t domain) const { return strip_begin_[strips_at_once * domain]; }
  Index end(std::size_t domain) const { return strip_begin_[strips_at_once * (domain + 1)]; }

  // s = M^-1 r and As = (A' less the blocks that M does not have and the rows off the diagonal) s, on one domain.
  void sweep(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> r, std::span<Lane<T>> s,
             std::span<Lane<T>> As) const;
  // As += (blocks that M does not have) s, on the rows of one domain.
  void add_between(std::size_t domain, std::span<const Lane<T>> s, std::span<Lane<T>> As) const;
  // y += R x on one domain, of an x that is complete.
  void add_rows(const LinearSystem<T>& system, std::size_t domain, RowPart part, std::span<const Lane<T>> x,
                std::span<Lane<T>> y) const;
  void add_rows(const LinearSystem<T>& system, std::size_t domain, std::span<const Vec3> x, std::span<Vec3> y) const;
  // y <- S y on one domain.
  void filter(const LinearSystem<T>& system, std::size_t domain, std::span<Lane<T>> y) const;

 private:
  struct Between {  // a block of A that M does not have
    Block<T> block;
    Index own, other;
    Slot slot;
    bool below;  // the diagonal
  };
  struct OwnEnds {  // of a row: those on particles of the domain, bit k
    std::int32_t row;
    unsigned ends;
  };
  std::size_t domain_of(Index particle) const;
  void sort_rows(const LinearSystem<T>& system);

  const BlockPattern* pattern_ = nullptr;
  Index particles_ = -1;
  std::uint64_t version_ = 0;                   // of the blocks that are copied
  std::vector<Index> strip_begin_{0};           // of all domains, and the end of the last
  std::vector<StripRows> inner_;                // [domain]
  std::vector<std::vector<Between>> between_;   // [domain]
  std::vector<std::vector<OwnEnds>> rows_;      // [domain] ascending
  std::vector<std::vector<std::size_t>> held_;  // [domain] positions in ParticleConstraints::constrained
};

extern template class SweepDomains<float>;
extern template class SweepDomains<double>;

}  // namespace toile
