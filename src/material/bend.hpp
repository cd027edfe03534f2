// material/bend.hpp: resistance to bending across the edge shared by two triangles.             [BW98 4.3, 4.5]
//
//   C = theta - theta_0,   E = kappa/2 C^2,   kappa = D L^2/(A_1+A_2)   (kappa = k of 1998 with paper scaling)
//   theta = atan2((N_A x N_B) . e/|e|, N_A . N_B)         numbering as drawn in mesh/topology.hpp
//
// K = kappa g g^T and D = tau kappa g g^T with g = dtheta/dx: rank one, semidefinite by construction.
// The part (theta - theta_0) d2theta is left out, because it is indefinite at every fold.     docs/theory/bend.md
//
// g grows as one over the height of a triangle that is crushed in its plane, and with it the force and the matrix, without end.  From an area of
// smallest_height of the smaller triangle's at rest on, g is scaled down by f = (N / (smallest_height N_0))^2, N being the flatter one's normal:
// |g| then falls to zero with the height.  One f for both triangles keeps the angular momentum; g g^T stays semidefinite.
//
// theta jumps from pi to -pi where the two triangles pass through each other.  theta - theta_0 is never wrapped:
// without such a passage it is the angle turned since rest.
#pragma once
#include "core/types.hpp"

namespace toile::internal {

inline constexpr double smallest_height = 0.05;

struct BendRest {
  double kappa_N_m = 0;  // stiffness of this hinge by itself
  // What the matrix of a step takes for the plates beside it (assembly/plate_moments.hpp) and for lines that it is part of; 0: a hinge alone.
  double plate_N_m = 0;
  double tau_s = 0;    // relaxation time k_d / k
  double theta_0 = 0;  // rest angle, rad
  double least_normal2 =
      0;  // (smallest_height N_0)^2, m^4, N_0 being twice the smaller triangle's area at rest; 0: g is never scaled down
};

inline double least_normal2(double area_a_m2, double area_b_m2) {
  const double least = 2 * smallest_height * (area_a_m2 < area_b_m2 ? area_a_m2 : area_b_m2);
  return least * least;
}

struct BendResponse {  // one per hinge of a cloth: what follows from the rest is not stored
  double theta = 0, theta_dot = 0;
  std::array<Vec3, 4> g;  // dtheta/dx_i, 1/m
  double moment = 0;      // kappa (theta - theta_0): elastic force on i is -moment g_i
  double damping = 0;     // tau kappa theta_dot:     damping force on i is -damping g_i
  // A triangle too thin for an angle: g, moment, damping are zero.
  bool degenerate() const { return g[2].isZero(0) || g[3].isZero(0); }
  double energy_J(const BendRest& rest) const { return 0.5 * moment * (theta - rest.theta_0); }
};

// x in m, v in m/s.  A hinge is degenerate when one of its four angles at the edge has a sine below 1e-4.
BendResponse bend_response(const BendRest& rest, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& v);

// theta alone, and its derivatives (not for degenerate hinges); tests check forces with the Hessian.
double hinge_angle(const std::array<Vec3, 4>& x);
std::array<Vec3, 4> hinge_angle_gradient(const std::array<Vec3, 4>& x);
std::array<std::array<Mat3, 4>, 4> hinge_angle_hessian(const std::array<Vec3, 4>& x);

// kappa per unit of bending rigidity: L^2 / (A_1 + A_2) from the rest state, capped at 20 (slivers).
double bend_weight(double edge_length_m, double area_a_m2, double area_b_m2);

// D of a hinge with which a near-equilateral sheet bends with D_u along the warp and D_v along the weft, for every
// orientation of its triangles.  b is the angle from the warp to `across` (across the edge: the fibres that bend; need
// not be normalised):
//   D = sqrt(D_u D_v) (1 + z)/(1 - z),   z = 3/2 (sqrt D_u - sqrt D_v)/(sqrt D_u + sqrt D_v) (cos 2b - cos(6b)/4)
// Derived in docs/theory/bend.md#warp-and-weft.  Above largest_bend_ratio the softer is raised, because z must stay
// below 1.  For a zero vector z = 0.
inline constexpr double largest_bend_ratio = 12;
double hinge_rigidity(const Vec2& across, double bend_u_N_m, double bend_v_N_m);

// The weight of 1998, `along` being the edge: (k_u du^2 + k_v dv^2)/(du^2 + dv^2); the mean of both for a zero vector.
double paper_bend_stiffness(const Vec2& along, double k_u, double k_v);

}  // namespace toile::internal
