// assembly/pressure.hpp: pressure on panels, towards the right side of the cloth: balloons, cushions, puffed sleeves.
//
//   F_i = sum of p/6 (x_j - x_i) x (x_k - x_i)     over the triangles (i, j, k) around i: p times a third of their areas, along their normals
//       = p dV/dx_i                                of a closed cloth: F is minus the gradient of -p V;  its sum and its moment are zero
//   K   = -dF/dx:  p/6 [x_k - x_i]                 of a triangle, by x_j, on its three corners alike;  [a]: the matrix of a x
//
// Nothing of K is in A.  A closed cloth has K_ii = 0 and K_ij = p/6 [x_k - x_l] across the edge (i, j) of the triangles with k and l: symmetric, but
// its trace is zero, so that it has eigenvalues of both signs wherever it is not zero.  At the rim of an open cloth it is not even symmetric.  F is
// taken where the step is linearised.  For a mode of mass m to which the fabric gives the stiffness k in A and K the stiffness q, that is stable for
// -k < q < k + 4 m/h^2: below, the cloth itself would burst or buckle; above is out of reach, as |q| is about p times an edge, 20 N/m for 1 kPa and
// 2 cm, and threads have a stiffness of thousands of N/m.
//
// p does not depend on the volume, as with a pump or an open valve.  A closed amount of gas, p_abs V = const, would add (p_abs/V) g g^T
// with g = dV/dx: semidefinite, but a block for every two particles; and it cannot be left out: of a ball of 0.2 m, 0.15 kg/m^2 and steps of 1/60 s
// its q is 2800 m/h^2.
//
// Easily got wrong: the right side is where triangles are seen counter-clockwise, of a garment its outside.  Layers do not shield each other.
#pragma once
#include "assembly/force.hpp"

#include <functional>
#include <vector>

namespace toile::internal {

class Pressure final : public Force {
 public:
  // Writes the pressure of panels in a step that ends at end_s, Pa; zero before; < 0 pushes towards the wrong side.
  using OfPanels = std::function<void(double end_s, std::span<double> panel_Pa)>;
  Pressure(OfPanels of_panels, std::size_t panels) : of_panels_(std::move(of_panels)), panel_Pa_(panels, 0) {}

  bool acts(double end_s) override;
  void prepare(const ClothModel& model, const BlockPattern& pattern) override;
  void evaluate(const ClothState& state, double end_s) override;
  void add_forces(std::span<Vec3> f) const override;

 private:
  OfPanels of_panels_;
  std::vector<double> panel_Pa_;  // [panel]
  std::vector<Triangle> triangles_;
  std::vector<Index> panel_;     // [triangle]
  std::vector<Vec3> at_corner_;  // [triangle] on each of its corners
};

}  // namespace toile::internal
