#include "solver/step_solver.hpp"

#include <utility>

namespace toile::internal {
namespace {

constexpr double rounding = 0x1p-24;
constexpr double largest_share = 0.2;  // of the part of A_ii without threads
constexpr std::size_t one_of = 10;     // particles may exceed it: a corner has little mass for its threads

}  // namespace

StepSolver::StepSolver(std::shared_ptr<const BlockPattern> pattern, const ClothMesh& mesh)
    : pattern_(std::move(pattern)), mesh_(&mesh), single_(pattern_, mesh) {}

bool StepSolver::single_bears() const {
  const std::span<const Mat3> diagonals = single_.A.diagonals();
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < diagonals.size(); ++i)
    beyond +=
        rounding * diagonals[i].trace() > largest_share * single_.A.grounded(static_cast<Index>(i)).trace() ? 1 : 0;
  return one_of * beyond <= diagonals.size();
}

StepSolver::Precision<double>& StepSolver::in_double() {
  if (!double_) double_ = std::make_unique<Precision<double>>(pattern_, *mesh_);
  return *double_;
}

void StepSolver::prepare(std::span<const ImplicitRow> rows, const ParticleConstraints& constraints,
                         const PcgOptions& options) {
  const auto in = [&](auto& precision) {
    precision.system.update(rows, constraints);
    precision.pcg.prepare(precision.system, options);
  };
  in_double_ ? in(*double_) : in(single_);
}

PcgReport StepSolver::solve(std::span<const Vec3> b, std::span<const Vec3> reference, const PcgOptions& options,
                            std::span<Vec3> dv) {
  if (in_double_) return double_->pcg.solve(double_->system, b, reference, options, dv);
  return single_.pcg.solve(single_.system, b, reference, options, dv);
}

void StepSolver::multiply_unfiltered(std::span<const Vec3> x, std::span<Vec3> y) const {
  in_double_ ? double_->system.multiply_unfiltered(x, y) : single_.system.multiply_unfiltered(x, y);
}

void StepSolver::held_residual(std::span<const Vec3> x, std::span<const Vec3> b, std::span<Vec3> e) const {
  in_double_ ? double_->system.held_residual(x, b, e) : single_.system.held_residual(x, b, e);
}

}  // namespace toile::internal
