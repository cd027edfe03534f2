// solver/coarse_space.hpp: deflation by a coarse space, a small system that moves whole patches of cloth at once.
//
// The cloth is cut into aggregates of neighbouring particles.  On each, the correction may be any affine function of
// the pattern coordinates, 9 numbers:   z_i = S_i (a + u' b + v' c),   u', v' relative to it and scaled to [-1, 1].
//
//   E = Z^T A' Z          Q = Z E^-1 Z^T                       (contact rows included)
//   deflated form (A-DEF2):   s = t + Q (r - A' t),   t = SSOR(r)
//
// so no residual is left in the coarse modes, whatever t did to them.  A' s costs no product: A' t is known from the
// sweeps, and A' Z, from which E is made, is kept.
//
// Without the coarse space a loosely solved step leaves the low modes at their old velocity: an artificial brake that
// makes draping cloth look viscous (docs/theory/solver.md#coarse-space has the measurement).
//                                                                                   [Nicolaides 1987; Tang et al. 2009]
#pragma once
#include "mesh/cloth_mesh.hpp"
#include "solver/block_cholesky.hpp"
#include "solver/linear_system.hpp"

#include <vector>

namespace toile::internal {

template <class T>
class CoarseSpace {
 public:
  // Cuts each piece of each panel by recursive bisection of its particles' pattern coordinates.  A particle of two
  // panels belongs to the first.
  explicit CoarseSpace(const ClothMesh& mesh);

  int aggregates() const { return aggregate_count_; }
  int dimension() const { return 9 * aggregate_count_; }
  // The number of entries of A' Z: aggregates per row, summed over all particles.  Known after factorise().
  std::size_t entries() const { return entry_aggregate_.size(); }
  std::size_t factor_blocks() const { return E_.stored_blocks(); }

  // Computes A' Z and the factor of E.  Call when A, the rows or the constraints have changed.
  void factorise(const LinearSystem<T>& system);
  // t += Q (r - At) and At += A' Q (r - At), divided among threads; r and At in the range of S, all vectors in the
  // order of places.
  //   restrict   sum = Z^T (r - At) of places [begin, end): their part of `dimension()` numbers
  //   solve      y = E^-1 of all parts, added in their order; cheaper for each to repeat than to wait for
  //   prolong    Zy = Z y without S, which the caller applies,
  //   add        t += Zy, and At += A' Z y without the rows, which the caller adds
  struct Solution {
    std::vector<double> rhs;
    std::vector<Lane<T>> y;       // [coarse direction] each in all lanes
    std::vector<Lane<T>> affine;  // [3 aggregate + l]: the same, the three directions of function l in one
  };
  void restrict(Index begin, Index end, std::span<const Lane<T>> r, std::span<const Lane<T>> At,
                std::span<double> sum) const;
  void solve(std::span<const std::vector<double>> parts, Solution& solution) const;
  void prolong(const Solution& solution, Index begin, Index end, std::span<Lane<T>> Zy) const;
  void add(const Solution& solution, Index begin, Index end, std::span<const Lane<T>> Zy, std::span<Lane<T>> t,
           std::span<Lane<T>> At) const;
  // dv += Q r in double, by particles; r must lie in the range of S.
  void correct(const LinearSystem<T>& system, std::span<const Vec3> r, std::span<Vec3> dv);

 private:
  void find_entries(const BlockPattern& pattern);
  void find_blocks();
  void find_stale_rows(const LinearSystem<T>& system);
  void multiply_basis(const LinearSystem<T>& system);  // A' Z without the rows, where it has changed
  void sum_coarse_matrix(const LinearSystem<T>& system);
  void sum_columns(std::size_t aggregate);
  std::size_t aggregates_of(const ImplicitRow& row, std::array<Index, 4>& aggregates) const;
  void add_row(const ImplicitRow& row, const ParticleConstraints& constraints);

  // A' Z is sparse: particle i has an entry, nine columns, for its own aggregate and for each of its neighbours'.
  using Columns = std::array<Lane<T>, 9>;  // [3 l + c]: basis function l, direction c

  int aggregate_count_ = 0;
  std::vector<Index> aggregate_;             // [particle]
  std::vector<std::vector<Index>> members_;  // [aggregate] particles, their places ascending
  std::vector<Vec3> basis_;                  // [particle] (1, u', v')
  std::vector<Index> aggregate_at_;          // both [place]
  std::vector<Vec3> basis_at_;
  const BlockPattern* pattern_ = nullptr;
  std::vector<std::int32_t> entry_begin_;                // [place] the first entry is that of its own aggregate
  std::vector<Index> entry_aggregate_;                   // [entry]
  std::vector<std::array<std::int32_t, 2>> slot_entry_;  // [slot (i, j)] entry of i for j's aggregate, of j for i's
  std::vector<Columns> AZ_;                              // [entry]
  // The inputs of A' Z: between passes of the active set few particles change, and no block.
  std::uint64_t version_ = 0;  // of A
  std::vector<Index> held_;    // constrained particles, and their S
  std::vector<Mat3> S_of_held_;
  std::vector<std::uint8_t> was_held_;  // [particle]
  std::vector<std::uint8_t> stale_;     // [particle] its row of A' Z is out of date
  // The upper triangle of Z^T A' Z without the rows.
  std::vector<std::pair<Index, Index>> couples_of_A_;  // [couple] (p, q), p <= q, ascending in q
  std::vector<std::int32_t> couple_begin_;             // [q]
  std::vector<std::int32_t> entry_couple_;             // [entry]; -1 below the diagonal
  std::vector<std::array<double, 81>> E_of_A_;         // [couple] rows of p, columns of q
  std::vector<std::pair<Index, Index>> couples_;       // the same with those of the rows
  BlockCholesky E_;
  std::vector<double> rhs_;
};

extern template class CoarseSpace<float>;
extern template class CoarseSpace<double>;

}  // namespace toile::internal
