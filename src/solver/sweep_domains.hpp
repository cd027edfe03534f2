// solver/sweep_domains.hpp: SSOR sweeps (symmetric Gauss-Seidel) in ranges of particles that run in parallel.
//
// A Gauss-Seidel sweep is a chain: every row needs the ones before it.  The rows, in the order of the pattern's places,
// are therefore cut into domains, one thread's work.  Each domain is cut into four strips, the quarters of a vector
// register, which are swept in parallel (strip_rows.hpp): row k of each strip of each domain at the same time k.  A
// block, of A or of a contact, belongs to the earlier of its rows.  Values of other domains are read once they are
// finished: a sweep has epochs, with a barrier between them.
//   M = SSOR of all blocks in this order, except those of two rows of one time, or of one epoch in two domains; those
//   are in A' only.
// Neighbours along the cloth have no such block as long as a strip is longer than the band is wide.  The cut depends on
// the pattern and never on the number of threads or the width of registers, so the result does not either.  All vectors
// are in the order of places.
#pragma once
#include "solver/linear_system.hpp"
#include "solver/strip_rows.hpp"

#include <array>
#include <vector>

namespace toile::internal {

template <class T>
class SweepDomains {
 public:
  // Sets the domains of a pattern; nothing is done if it is that of the last call.
  void cut(const BlockPattern& pattern);
  // Call when the system has changed in any way.
  void update(const LinearSystem<T>& system);

  std::size_t count() const { return strip_begin_.size() / strips_at_once; }
  Index begin(std::size_t domain) const { return strip_begin_[strips_at_once * domain]; }
  Index end(std::size_t domain) const { return strip_begin_[strips_at_once * (domain + 1)]; }
  Index particle_at(Index place) const { return pattern_->row_at(place); }
  std::size_t epochs() const { return epoch_begin_.size() - 1; }

  // s = M^-1 r and As = A' s, one epoch of one domain at a time: forward through the epochs, each when all domains have
  // done the one before, then backward likewise; then, when all are done, `finish`.  As is r before.
  void forward(const LinearSystem<T>& system, std::size_t domain, std::size_t epoch, std::span<Lane<T>> s,
               std::span<Lane<T>> As) const;
  void backward(const LinearSystem<T>& system, std::size_t domain, std::size_t epoch, std::span<Lane<T>> s,
                std::span<Lane<T>> As) const;
  void finish(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> s,
              std::span<Lane<T>> As) const;
  // y += R x on one domain, R = sum a g g^T, with x complete; in double by particles, those whose places are the
  // domain's.
  void add_rows(const LinearSystem<T>& system, std::size_t domain, std::span<const Lane<T>> x,
                std::span<Lane<T>> y) const;
  void add_rows(const LinearSystem<T>& system, std::size_t domain, std::span<const Vec3> x, std::span<Vec3> y) const;
  // y <- S y on one domain.
  void filter(const LinearSystem<T>& system, std::size_t domain, std::span<Lane<T>> y) const;

 private:
  struct Coupling {  // a block of a row that is not in the strips
    Block<T> block;
    Index own, other;  // places
    Slot slot;         // of A; -1: a contact's
    bool below;        // the block is below the diagonal
    Index time = 0;    // of the sweep, when it is applied: not after own's, and when other is known
  };
  // The couplings of one domain's rows: with rows swept earlier, with rows swept later, and with rows at the same time,
  // neither of which can wait for the other.  The first two ascend in time.
  struct Couplings {
    std::vector<Coupling> earlier, later, together;
    void clear();
    void sort();
  };
  struct OwnEnds {  // the ends of a row on particles of the domain, bit k
    std::int32_t row;
    unsigned ends;
  };
  struct Held {
    std::size_t held;  // position in ParticleConstraints::constrained
    Index place;
  };
  std::size_t domain_of(Index place) const;
  std::size_t epoch_of(Index time) const;
  void add(Coupling coupling, std::vector<Couplings>& to) const;
  void sort_rows(const LinearSystem<T>& system);
  void couple(std::span<const ImplicitRow> of_one_contact);

  const BlockPattern* pattern_ = nullptr;
  std::uint64_t version_ = 0;               // of the copied blocks
  std::vector<Index> strip_begin_{0};       // of all domains, and the end of the last
  std::vector<Index> time_;                 // [place] when its row is swept
  std::vector<Index> epoch_begin_;          // first time of each, and the end of the last
  std::vector<StripRows> inner_;            // [domain]
  std::vector<Couplings> of_A_;             // [domain]
  std::vector<Couplings> of_contacts_;      // [domain]
  std::vector<std::vector<OwnEnds>> rows_;  // [domain] ascending
  std::vector<std::vector<Held>> held_;     // [domain]
};

extern template class SweepDomains<float>;
extern template class SweepDomains<double>;

}  // namespace toile::internal
