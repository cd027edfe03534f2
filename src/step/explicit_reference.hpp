// step/explicit_reference.hpp: explicit integration of the same forces, which the paper sets out to replace.   [BW98 1]
//
//   symplectic Euler   v <- v + h M^-1 f(x, v),   x <- x + h v          stable while  h^2 K + 2 h D < 4 M
//   Runge-Kutta 4      fourth order; the reference for tests that need a true solution of the equations of motion
//
//   h_max = (sqrt(gamma^2 + 4 omega^2) - gamma) / omega^2,   omega^2, gamma: largest eigenvalues of M^-1 K and M^-1 D
//           2/omega without damping;  1/gamma where damping dominates, as in any cloth that does not ring
//
// No contact, no air.  For comparisons and tests; nothing in a run uses it.
#pragma once
#include "assembly/elements.hpp"

#include <vector>

namespace toile::internal {

enum class ExplicitScheme { symplectic_euler, runge_kutta_4 };

struct ExplicitLimit {
  double omega_per_s = 0, gamma_per_s = 0;
  double h_s = 0;  // infinity for a cloth without stiffness and damping
};

class ExplicitReference {
 public:
  // `held` particles keep their velocity.  The model must outlive this object.
  ExplicitReference(const ClothModel& model, std::vector<Index> held);

  void step(ClothState& state, double h_s, ExplicitScheme scheme);

  // The stability limit of symplectic Euler about a state, by power iteration: within a few per cent, from above.
  ExplicitLimit limit(const ClothState& state);

  // Whether the cloth is intact after `steps` of h_s: finite, and no thread longer than twice its rest length.
  bool stands(ClothState state, double h_s, int steps, ExplicitScheme scheme);

  double energy_J(const ClothState& state);  // kinetic, elastic and of gravity

 private:
  void accelerations(const ClothState& state, Vec3s& a);

  const ClothModel* model_;
  Elements elements_;
  std::vector<char> held_;  // [particle]
  Vec3s a_[4];
  ClothState stage_;
};

}  // namespace toile::internal
