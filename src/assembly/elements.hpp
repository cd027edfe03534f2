// assembly/elements.hpp: all internal forces of a cloth and their derivatives, gathered without races.    [BW98 2.3, 3]
//
//   evaluate(x, v)      one response per triangle and hinge, in parallel
//   forces(...)         f_i = sum over elements in element order
//   assemble(h, A)      A = M + h D + h^2 K: every block gathers its elements in a fixed order, so the bits
//                       are the same at any thread count; a halved step evaluates no element again
//   subtract_stiffness  K y element by element in double, for the right-hand side (momentum is kept to rounding)
#pragma once
#include "assembly/bend_memory.hpp"
#include "assembly/block_kernels.hpp"
#include "assembly/cloth_model.hpp"
#include "assembly/edge_threads.hpp"
#include "assembly/plate_moments.hpp"
#include "material/membrane_batch.hpp"

#include <optional>

namespace toile::internal {

class Elements {
 public:
  // The model must outlive this object.
  explicit Elements(const ClothModel& model);
  explicit Elements(ClothModel&&) = delete;

  std::shared_ptr<const BlockPattern> pattern() const { return pattern_; }

  void evaluate(const ClothModel& model, const ClothState& state);
  double energy_J();  // elastic, of the last evaluate()
  int degenerate_hinges() const;

  // f_i: elastic and damping forces at the evaluated state.
  void forces(std::span<Vec3> f) const;
  // f_i -= (K displacement)_i with the projected K of the evaluated state.
  void subtract_stiffness(std::span<const Vec3> displacement, std::span<Vec3> f) const {
    subtract_stiffness(displacement, {}, f);
  }
  // f_i -= (K displacement + D velocity)_i, with D likewise; an empty velocity is none.
  void subtract_stiffness(std::span<const Vec3> displacement, std::span<const Vec3> velocity, std::span<Vec3> f) const;

  // Bends that stay follow those at x, where a step of h_s has ended (bend_memory.hpp).  Costs nothing where fabrics have none.
  void follow_bends(const ClothModel& model, std::span<const Vec3> x, double h_s);
  const BendMemory* bend_memory() const { return memory_ ? &*memory_ : nullptr; }

  // Off-diagonal blocks of h D + h^2 K.  A.grounded() must hold the mass; the diagonal is updated here.
  template <class T>
  void assemble(double h_s, BlockMatrix<T>& A);

  // |w_u| and |w_v| of every triangle at x.
  void stretch(std::span<const Vec3> x, std::span<Vec2> w) const;

  // The energy of stretch and shear beyond the linearisation at the end F' of a linear step:
  // E(F') - (E + P.d + d.K d / 2), d = F' - F, about the last evaluate(), in J.  A piece that turns by the angle a
  // along tangents has |w'| = sqrt(1 + a^2): k s^2 (|w'| - 1)^2 / 2 per thread, created out of nothing.
  struct BeyondLinear {
    double made = 0, net = 0;  // sums over the triangles where it is positive; over all
  };
  BeyondLinear energy_beyond_linear(std::span<const Vec3> x);

  // Per-element access for diagnosis and tests.
  MembraneResponse membrane(Index triangle) const;
  const BendResponse& bend(Index hinge) const { return bend_[static_cast<std::size_t>(hinge)]; }

  // State that outlives a step (core/state_archive.hpp).
  template <class Archive>
  void remember(Archive& archive) {
    if (memory_) archive(*memory_);
  }

 private:
  void add_incidence(const ClothModel& model);
  void pack_rest(const ClothModel& model);
  void find_moments(std::span<double> moment);
  MembraneBatches batches(std::size_t begin, std::size_t end) const {
    return {rest_.data(), state_.data(), begin, end, form_};
  }

  const ClothModel* model_;
  std::shared_ptr<const BlockPattern> pattern_;
  std::span<const Triangle> triangles_;  // of the model
  std::span<const Hinge> hinges_;
  std::span<const BendRest> bend_rest_;
  // Triangles, eight per batch; arrays over triangles are as long as all batches.
  int rest_version_ = -1;  // of the model, when the batches were packed
  std::vector<MembraneRestBatch> rest_;
  std::vector<MembraneStateBatch> state_;
  MembraneForm form_;
  std::vector<std::int32_t> triangle_begin_, hinge_begin_;  // per slot
  std::vector<BlockParts::OfTriangle> triangle_parts_;
  std::vector<BlockParts::OfHinge> hinge_parts_;
  std::vector<std::int32_t> particle_triangle_begin_, particle_hinge_begin_;  // per particle
  std::vector<std::pair<Index, std::uint8_t>> particle_triangles_, particle_hinges_;
  std::vector<BendResponse> bend_;
  // Scratch of the gathers.  Triangles: three blocks each, and one more that is never used; or one matrix each, the
  // forces on the corners.  Hinges: the factor of g, which is (h^2 + h tau) kappa in blocks, or the moment.
  mutable std::vector<Mat3> of_triangles_;
  mutable std::vector<double> of_hinges_;
  std::optional<EdgeThreads> threads_;  // none without finished edges
  std::optional<PlateMoments> plates_;
  std::optional<BendMemory> memory_;           // none where no fabric remembers its bends
  std::vector<double> turned_, plate_moment_;  // [hinge], of plates and lines; empty without both
  std::vector<double> beyond_linear_;          // [triangle]
  void gather(std::span<Vec3> f, double sign) const;
};

extern template void Elements::assemble(double, BlockMatrix<float>&);
extern template void Elements::assemble(double, BlockMatrix<double>&);

}  // namespace toile::internal
