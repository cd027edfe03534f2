// assembly/force.hpp: an external force on the cloth, and its terms in the implicit step.                    [BW98 4.4]
//
//   F(x, v)       a force on every particle, N
//   B             minus its derivative by velocity, or the part of it that is fit for A;  in A: h B
//
// The step walks through a list of forces in their order and knows none of them.  One call serves the whole cloth, and from the second step on
// none takes memory.  Adding one: docs/howto/add-a-force.md.
//
// The term in A must be symmetric, positive semidefinite (or conjugate gradients fail), and on blocks of the pattern, those of the edges of
// triangles.  The rest of the derivative is left out; the force's header says which part, and why the step stays stable: F is then taken at the state
// about which the step is linearised, its start or the last iterate of its end.  For cloth at rest this makes no difference.
//
// Easily got wrong: parallel sums.  Bits must not depend on the number of threads: gather by particle and by block, or add in the order of triangles.
#pragma once
#include "assembly/block_matrix.hpp"
#include "assembly/cloth_model.hpp"

#include <span>

namespace toile::internal {

class Force {
 public:
  Force() = default;
  virtual ~Force() = default;
  Force(const Force&) = delete;  // a list holds it by its base
  Force& operator=(const Force&) = delete;

  // Whether it acts in a step that ends at end_s.  If not, nothing else is called.
  virtual bool acts(double end_s) = 0;
  // Before the first step in which it acts.  The model's mesh stays as it is.
  virtual void prepare(const ClothModel& model, const BlockPattern& pattern) = 0;
  // F and B at this state, for a step that ends at end_s.
  virtual void evaluate(const ClothState& state, double end_s) = 0;

  // f_i += F_i.
  virtual void add_forces(std::span<Vec3> f) const = 0;
  // f_i += sum_j B_ij u_j: the linearised force at v less that at v + u.  A force without B adds nothing.
  virtual void add_damping(std::span<const Vec3> /*u*/, std::span<Vec3> /*f*/) const {}
  // A += h B.  The diagonal is updated.
  virtual void assemble(double /*h_s*/, BlockMatrix<float>& /*A*/) const {}
  virtual void assemble(double /*h_s*/, BlockMatrix<double>& /*A*/) const {}
};

}  // namespace toile::internal
