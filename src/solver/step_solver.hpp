// solver/step_solver.hpp: a step's linear system and solver, in single precision where that suffices, else in double.
//
// Every block of A is rounded by 2^-24 of its size.  The fastest modes across the cloth, in which neighbours move
// against each other and no thread gets longer, are resisted by little more than the mass.  So A in single precision
// stays positive definite only while
//
//   2^-24 trace(A_ii) <= 0.2 trace(G_i)            G_i: the part of A_ii without threads, m_i I and drag
//
// for nine particles in ten.  That is about 2^-24 of a few h^2 k / (rho L^2): a step of 1/30 s of cotton with edges of
// 21 mm is at 0.004, of 3.4 mm at 0.15.  A drape with edges of 21 mm that is 50 times as stiff (0.17) takes 90 steps in
// single precision and 74 in double, 70 times (0.24) 282 and 75.
#pragma once
#include "solver/modified_pcg.hpp"

#include <memory>
#include <span>
#include <utility>

namespace toile::internal {

class StepSolver {
 public:
  StepSolver(std::shared_ptr<const BlockPattern> pattern, const ClothMesh& mesh);
  StepSolver(const StepSolver&) = delete;  // the systems point at their matrices
  StepSolver& operator=(const StepSolver&) = delete;

  // fill(A) writes grounded parts and blocks of a BlockMatrix, and calls its update_diagonal.
  template <class Fill>
  void assemble(const Fill& fill) {
    fill(single_.A);
    in_double_ = !single_bears();
    if (in_double_) fill(in_double().A);
  }
  // A_ii of the last assembly.
  std::span<const Mat3> diagonals() const { return single_.A.diagonals(); }
  bool is_in_double() const { return in_double_; }

  // Call when A, the rows or the constraints have changed.  The spans must outlive the solve.
  void prepare(std::span<const ImplicitRow> rows, const ParticleConstraints& constraints, const PcgOptions& options);
  // Like ModifiedPcg::solve and the functions of LinearSystem, for the prepared system.
  [[nodiscard]] PcgReport solve(std::span<const Vec3> b, std::span<const Vec3> reference, const PcgOptions& options,
                                std::span<Vec3> dv);
  void multiply_unfiltered(std::span<const Vec3> x, std::span<Vec3> y) const;
  void held_residual(std::span<const Vec3> x, std::span<const Vec3> b, std::span<Vec3> e) const;

 private:
  template <class T>
  struct Precision {
    Precision(std::shared_ptr<const BlockPattern> pattern, const ClothMesh& mesh)
        : A(std::move(pattern)), system(A), pcg(mesh) {}
    Precision(const Precision&) = delete;
    Precision& operator=(const Precision&) = delete;
    BlockMatrix<T> A;
    LinearSystem<T> system;
    ModifiedPcg<T> pcg;
  };
  bool single_bears() const;
  Precision<double>& in_double();

  std::shared_ptr<const BlockPattern> pattern_;
  const ClothMesh* mesh_;
  Precision<float> single_;
  std::unique_ptr<Precision<double>> double_;  // from its first use on
  bool in_double_ = false;
};

}  // namespace toile::internal
