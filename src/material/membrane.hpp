// material/membrane.hpp: stretch and shear of one triangle, ready for assembly.                    [BW98 4.2, 4.3, 4.5]
//
//   stretch   C_u = s (|w_u| - b_u),  C_v = s (|w_v| - b_v)           E = k_u/2 C_u^2 + k_v/2 C_v^2
//   shear     C_s = s  w_u . w_v                                      E = k_s/2 C_s^2
//   s = sqrt(area): k is in N/m and does not depend on the mesh; s = area is the 1998 form (`paper_scaling`).
//
// All quantities depend on the six numbers F = [w_u w_v] (3x2) only; a corner i follows by
//   f_i = -(alpha_i P_u + beta_i P_v),
//   K_ij = alpha_i alpha_j K_uu + alpha_i beta_j K_uv + beta_i alpha_j K_uv^T + beta_i beta_j K_vv.
// K is the energy's Hessian projected to positive semidefinite in closed form (no eigen-solver); D its Gauss-Newton
// part times the relaxation time tau = k_d / k of each condition.  F has no unit, so P, Q, K are in J and D in J s.
//                                                              docs/theory/stretch-and-shear.md, docs/theory/damping.md
//
// A thread shorter than b may be softer, k times `compression`: the energy and the force stay continuous, and so does
// the damping, which keeps the k of tension.  The projected K only loses its part along the thread.  Cloth of a rigidity D is softer still where its
// triangles are so large that a sheet would buckle between their corners: pushed_stiffness_N_per_m.
//
// A thread may stiffen (off by default): with the excess e = |w| - b above zero and a doubling d, T = k (e + e^3 / d^2) pulls twice as hard
// at e = d as the straight line, and the energy has s^2 k e^4 / (4 d^2) more; of the cubic term a share may count.
//
// Strain limit (off by default): a thread may not be longer than L = (1 + limit) c, c = max(b, 1): worn elastic is
// stretched beyond its rest length, which is allowed.  From half of the limit on, e_0 = c + (L - c)/2, a barrier is
// added to the energy, with y = (|w| - e_0) / d, d = L - e_0:
//   E = k s^2 d^2 phi(y),   phi = y^3 / (1 - y)   up to y_1 = 0.95, and its second-order expansion about y_1 beyond it,
// so that every trial step has a finite force; the step control refuses steps beyond L.  phi begins with y^3, so the
// stiffness is continuous; 397 k s^2 d hold a thread at y_1, 1197 at L.
//
// A thread squeezed to |w| = 0 has no direction: its stretch force and stiffness are then zero, never NaN.
#pragma once
#include "core/types.hpp"

namespace toile::internal {

struct MembraneStiffness {
  double k_u = 0, k_v = 0, k_shear = 0;   // N/m (N/m^3 with paper scaling)
  double tau_stretch = 0, tau_shear = 0;  // s
  double compression = 1;                 // in (0, 1]: k of a thread shorter than b over k
  double strain_limit = 0;                // of |w| / limited_from(b) - 1; 0: none
  // Excess at which a thread pulls twice as hard as a straight line; 0: it is one.
  double doubling_u = 0, doubling_v = 0;
  double stiffened = 1;  // share of e^3 / d^2, in [0, 1]
  double bend = 0;       // N m; by which cloth buckles where it is pushed; 0: it does not
};

struct MembraneRest {
  Vec3 alpha, beta;         // 1/m, each summing to zero; see mesh/cloth_mesh.hpp
  double scale2 = 0;        // s^2: area (default) or area^2 (paper scaling)
  double b_u = 1, b_v = 1;  // rest stretch; < 1 pulls the cloth together (elastic)
};

// c, from which the strain limit of a thread of rest stretch b counts.
inline double limited_from(double b) { return b > 1 ? b : 1; }

// Of a sheet that is pushed until it has buckled by some percent, as force per width and shortening:  D (2 pi / l)^2 / e.
// l = 2 h is the shortest wave that triangles of this area (equilateral, edges h) show, and no longer than the wrinkles of garments.
constexpr double longest_wrinkle_m = 0.02, wrinkle_shortening = 0.05;
double pushed_stiffness_N_per_m(double rigidity_N_m, double area_m2);

// A symmetric 6x6 matrix over (w_u, w_v).
struct FMatrix {
  Mat3 uu, uv, vv;
};

struct MembraneResponse {
  double energy_J = 0;
  Vec3 w_u, w_v;  // columns of the deformation gradient
  Vec3 P_u, P_v;  // dE/dw_u, dE/dw_v: elastic
  Vec3 Q_u, Q_v;  // the same for damping, at the velocities given
  FMatrix K, D;   // stiffness (projected) and damping
};

// The part of dd/dx of damping that K contains (docs/theory/damping.md): none, or the symmetric part that the paper
// keeps.
enum class DampingJacobian { gauss_newton, paper };

// Projection of the energy's Hessian; `none` is the true Hessian, for tests.
enum class Projection { semidefinite, none };

// E at F = [w_u w_v], J, of one triangle.
double membrane_energy(const MembraneRest& rest, const MembraneStiffness& k, const Vec3& w_u, const Vec3& w_v);

// For one triangle, in diagnosis and tests; a cloth has its triangles in batches (membrane_batch.hpp).  x in m and v in
// m/s, per corner.
MembraneResponse membrane_response(const MembraneRest& rest, const MembraneStiffness& k, const std::array<Vec3, 3>& x,
                                   const std::array<Vec3, 3>& v,
                                   DampingJacobian damping_jacobian = DampingJacobian::gauss_newton,
                                   Projection projection = Projection::semidefinite);

}  // namespace toile::internal
