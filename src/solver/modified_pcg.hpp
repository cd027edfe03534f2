// solver/modified_pcg.hpp: the paper's modified conjugate gradient method, in its prefiltered form. [BW98 5.3, TJM15 8]
//
//   dv_0 = z + S w_0,   r = S (b - A dv_0),   then ordinary PCG on A' (solver/linear_system.hpp);
//   (I - S) dv = z exactly at every iteration count, and the constraint force is read from the residual:
//   force = (I - S)(A dv - b) / h                                                                        [BW98 5.4]
//
// Stop rule, the same for every preconditioner, norms in D^-1 (D: block diagonal of A'):
//   |r| <= max( min(tol |b'|, max(0.02 |reference|, 0.2 tol |b'|)), min(0.1 tol, 1e-4) |reference| ),
//   reference = S h m g
// A rule relative to b' alone is wrong twice: a garment at rest would be the most expensive frame, and where contact or
// seam forces dwarf gravity a relative 1e-3 would ignore gravity.  The target is never below 1e-5 |b'|: in a hit at 10
// m/s and a step of 0.1 ms that is more than h m g, and single precision gets no further.  The printed 1998 listing's
// rule: docs/deviations.md#pcg
#pragma once
#include "core/team.hpp"
#include "solver/coarse_space.hpp"
#include "solver/linear_system.hpp"
#include "solver/sweep_domains.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace toile::internal {

enum class Preconditioner { diagonal, block_jacobi, block_ssor, block_ssor_coarse };
std::string_view to_string(Preconditioner preconditioner);

// Our method, or the listing of 1998 in the reading that must have been run (solver/paper_pcg.hpp); for comparison.
enum class PcgProcedure { prefiltered, paper_1998 };
enum class PaperReading { inverse_everywhere, diagonal_of_A, as_printed };

// A tolerance that is fine enough with the coarse space brakes the motion without it
// (docs/theory/solver.md#what-the-tolerance-keeps); absent: the best one.
constexpr double usual_tolerance(std::optional<Preconditioner> preconditioner, PcgProcedure procedure) {
  const bool coarse = preconditioner.value_or(Preconditioner::block_ssor_coarse) == Preconditioner::block_ssor_coarse;
  return coarse && procedure == PcgProcedure::prefiltered ? 1e-2 : 1e-3;
}

struct PcgOptions {
  Preconditioner preconditioner = Preconditioner::block_ssor_coarse;
  double tolerance = usual_tolerance(Preconditioner::block_ssor_coarse, PcgProcedure::prefiltered);
  int max_iterations = 1000;
  double loosen = 1;  // factor on the target of the stop rule
  PcgProcedure procedure = PcgProcedure::prefiltered;
};

enum class PcgStatus { converged, iteration_limit, not_positive_definite, not_finite };

struct PcgReport {  // the outcome of a solve, in numbers
  PcgStatus status = PcgStatus::converged;
  int iterations = 0;
  double initial_residual = 0, residual = 0, target = 0;  // in the D^-1 norm
  double curvature = 0;  // c.A'c of the last direction: <= 0 means A' was not positive definite
  explicit operator bool() const { return status == PcgStatus::converged; }
  std::string explain() const;  // one sentence for a person
};

template <class T>
class ModifiedPcg {
 public:
  explicit ModifiedPcg(const ClothMesh& mesh) : coarse_(mesh) {}
  ModifiedPcg(const ModifiedPcg&) = delete;  // team_ may point at a member
  ModifiedPcg& operator=(const ModifiedPcg&) = delete;

  // Call when the system's A, rows or constraints have changed.
  void prepare(const LinearSystem<T>& system, const PcgOptions& options);

  // dv: in, a guess; out, the solution.  `reference` is h m g.  Sizes equal the system's.
  [[nodiscard]] PcgReport solve(const LinearSystem<T>& system, std::span<const Vec3> b, std::span<const Vec3> reference,
                                const PcgOptions& options, std::span<Vec3> dv);

 private:
  // The members of a team run the same iterations, each on its own domains.  Every scalar is the sum of the domains'
  // parts in their order, which each member adds for itself after a barrier.
  struct Share {
    int member, members;
    bool odd = false;  // which of the two sets of parts the next sum uses
  };
  double find_target(const LinearSystem<T>& system, std::span<const Vec3> b, std::span<const Vec3> reference,
                     const PcgOptions& options, const Share& share);
  void iterate(const LinearSystem<T>& system, std::span<const Vec3> b, const PcgOptions& options, Share& share,
               PcgReport& report);
  void precondition(const LinearSystem<T>& system, Preconditioner kind, Share& share);
  void deflate(const LinearSystem<T>& system, Share& share);
  void correct_coarse_modes(const LinearSystem<T>& system, Share& share);
  double residual_norm2(const LinearSystem<T>& system, Share& share);
  void true_residual(const LinearSystem<T>& system, std::span<const Vec3> b, const Share& share);
  template <class Work>
  void for_own_domains(const Share& share, const Work& work) const;
  template <class Work>
  void for_own_particles(const Share& share, const Work& work) const;
  void sweep(const LinearSystem<T>& system, Share& share);
  void multiply(const LinearSystem<T>& system, std::span<const Lane<T>> x, std::span<Lane<T>> y);
  template <class Part>
  double sum_over_domains(Share& share, const Part& part);

  CoarseSpace<T> coarse_;
  SweepDomains<T> domains_;
  // On a busy machine members wait for each other longer than they work; then one does all the work for a while.  This
  // changes the speed only: the bits do not depend on the division of work.
  Team& team_for(const PcgOptions& options);
  std::unique_ptr<Team> alone_ = std::make_unique<Team>(1);
  std::unique_ptr<Team> all_;
  Team* team_ = alone_.get();                                 // of this solve
  int solves_alone_ = 0;                                      // still to be done by one member
  std::vector<std::array<double, 2>> parts_;                  // [domain] of sums over particles
  std::vector<std::vector<double>> coarse_parts_;             // [domain] of Z^T r
  std::vector<typename CoarseSpace<T>::Solution> solutions_;  // [member]
  std::vector<Lane<T>> r_, c_, q_;                            // residual, direction, A' c
  std::vector<Lane<T>> s_, As_, w_;                           // M^-1 r, A' s, correction to the guess
  std::vector<Lane<T>> Zy_;                      // the coarse part of s; all of these in the order of places
  std::vector<Lane<T>> inverse_diagonal_;        // [place] of the diagonal preconditioner
  std::vector<Lane<T>> of_particles_, product_;  // for preconditioners without sweeps
  Vec3s start_, work_, work2_;
};

extern template class ModifiedPcg<float>;
extern template class ModifiedPcg<double>;

}  // namespace toile::internal
