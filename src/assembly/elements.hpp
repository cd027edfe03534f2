// assembly/elements.hpp: all internal forces of a cloth and their derivatives, gathered without races.     [BW98 2.3, 3]
//
//   evaluate(x, v)      one response per triangle and hinge, in parallel
//   forces(...)         f_i = sum over elements in element order
//   assemble(h, A)      A = M + h D + h^2 K: every block gathers its elements in a fixed order, so that the same bits come out at
//                       any thread count, and a halved step needs no element evaluated again
//   subtract_stiffness  K y element by element in double: what the right-hand side needs (momentum is kept to rounding)
#pragma once
#include "assembly/block_matrix.hpp"
#include "assembly/cloth_model.hpp"

namespace toile {

class Elements {
 public:
  explicit Elements(const ClothModel& model);

  std::shared_ptr<const BlockPattern> pattern() const { return pattern_; }

  void evaluate(const ClothModel& model, const ClothState& state);
  double energy_J() const;  // elastic, of the last evaluate()
  int degenerate_hinges() const;

  // f_i: elastic and damping forces at the evaluated state.
  void forces(std::span<Vec3> f) const;
  // f_i -= (K displacement)_i with the projected K of the evaluated state.
  void subtract_stiffness(std::span<const Vec3> displacement, std::span<Vec3> f) const;

  // Off-diagonal blocks of h D + h^2 K.  A.grounded() must hold the mass; the diagonal is updated here.
  template <class T>
  void assemble(double h_s, BlockMatrix<T>& A);

  // |w_u| and |w_v| of every triangle at x.
  void stretch(std::span<const Vec3> x, std::span<Vec2> w) const;

  // Energy of stretch and shear at x that the linearisation of the last evaluate() does not know of (material/membrane.hpp): the sum over
  // the triangles that have more than they were thought to, J.
  double energy_beyond_linear(const ClothModel& model, std::span<const Vec3> x);

  // Per-element access for diagnosis and tests.
  const MembraneResponse& membrane(Index triangle) const { return membrane_[static_cast<std::size_t>(triangle)]; }
  const BendResponse& bend(Index hinge) const { return bend_[static_cast<std::size_t>(hinge)]; }

 private:
  struct TrianglePart {
    Index triangle;
    std::uint8_t a, b;
  };  // corners: block (a, b) of the triangle
  struct HingePart {
    Index hinge;
    std::uint8_t a, b;
  };
  void add_incidence(const ClothModel& model);

  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<Triangle> triangles_;
  std::vector<Hinge> hinges_;
  std::vector<Vec3> alpha_, beta_;
  std::vector<double> kappa_, tau_;
  std::vector<Index> row_of_slot_;
  std::vector<std::int32_t> triangle_begin_, hinge_begin_;  // per slot
  std::vector<TrianglePart> triangle_parts_;
  std::vector<HingePart> hinge_parts_;
  std::vector<std::int32_t> particle_triangle_begin_, particle_hinge_begin_;  // per particle
  std::vector<std::pair<Index, std::uint8_t>> particle_triangles_, particle_hinges_;
  std::vector<MembraneResponse> membrane_;
  std::vector<BendResponse> bend_;
  std::vector<FMatrix> combined_;                            // h D + h^2 K per triangle
  mutable std::vector<std::array<Vec3, 3>> triangle_force_;  // scratch of the gathers
  mutable std::vector<std::array<Vec3, 4>> hinge_force_;
  std::vector<double> beyond_linear_;  // [triangle]
  void gather(std::span<Vec3> f, double sign) const;
};

extern template void Elements::assemble(double, BlockMatrix<float>&);
extern template void Elements::assemble(double, BlockMatrix<double>&);

}  // namespace toile
