// material/membrane_batch.hpp: stretch and shear of eight triangles at once, by the formulas of material/membrane.hpp.
//
// Of the state only the deformation gradient and its rate are kept.  Everything else is recomputed where it is needed:
// reading 3x3 matrices back takes longer than computing them.
//
// Every function works on batches [begin, end); arrays over triangles have `batch_size` entries per batch, so the last
// one may need padding.  Unused lanes of the last batch repeat its last triangle.
#pragma once
#include "material/batch.hpp"
#include "material/membrane.hpp"

namespace toile::internal {

struct alignas(64) MembraneRestBatch {
  Batched alpha[3], beta[3];  // [corner]
  Batched k_u, k_v, k_shear;  // times s^2, J
  Batched b_u, b_v;
  Batched tau_stretch, tau_shear, compression, strain_limit;
  Batched stiffening_u, stiffening_v;  // stiffened / doubling^2; 0: none
  Batched forward[3];  // [pair c, c + 1] 1: the first particle of the pair has the lower number; 0: the second
  Index corner[3][batch_size];
  bool curved;  // a lane has a strain limit, or stiffens

  void set(std::size_t lane, const MembraneRest& rest, const MembraneStiffness& k, const Triangle& corners);
};

struct alignas(64) MembraneStateBatch {
  Batched w_u[3], w_v[3], w_u_dot[3], w_v_dot[3];
  Batched energy_J;
};

// Options of the response; the same for all triangles.
struct MembraneForm {
  DampingJacobian damping_jacobian = DampingJacobian::gauss_newton;
  Projection projection = Projection::semidefinite;
};

// The kernels' arguments: batches of one mesh.
struct MembraneBatches {
  const MembraneRestBatch* rest;
  const MembraneStateBatch* state;
  std::size_t begin, end;
  MembraneForm form;
};

void evaluate_membranes(const MembraneRestBatch* rest, std::size_t begin, std::size_t end, const Vec3* x, const Vec3* v,
                        MembraneStateBatch* state);
// Elastic and damping force on each corner, a column each, with the opposite sign.
void membrane_forces(const MembraneBatches& of, Mat3* force);
// K displacement on each corner, a column each; with `velocity`, which may be null, K displacement + D velocity.
void membrane_stiffness_times(const MembraneBatches& of, const Vec3* displacement, const Vec3* velocity, Mat3* force);
// h D + h^2 K of the pairs of corners (0, 1), (1, 2), (2, 0), three per triangle: rows of the lower particle, columns
// of the higher one.
void membrane_blocks(const MembraneBatches& of, double h_s, Mat3* blocks);
// |w_u| and |w_v| at x.
void membrane_stretch(const MembraneRestBatch* rest, std::size_t begin, std::size_t end, const Vec3* x, Vec2* w);
// Energy at x beyond the second-order expansion about the evaluated state, J.
void membrane_energy_beyond(const MembraneBatches& of, const Vec3* x, double* energy_J);
// The full response of the first lane of one batch, for diagnosis and tests.
MembraneResponse membrane_response_of(const MembraneRestBatch& rest, const MembraneStateBatch& state, std::size_t lane,
                                      const MembraneForm& form);
// E at (w_u, w_v) of the state, J.
void membrane_energies(const MembraneRestBatch& rest, MembraneStateBatch& state);

}  // namespace toile::internal
