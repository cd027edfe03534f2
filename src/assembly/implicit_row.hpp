// assembly/implicit_row.hpp: a spring along one direction between up to four particles: a rank-one term of the system.
//
//   g_k = weight_k direction                       d = sum_k g_k . (displacement of particle k)  - travel of a body
//   force along g:   F(dv) = force - k (h g.(v+dv) + g.y - body_displacement) - c (g.(v+dv) - body_displacement/h)
//   A += a g g^T,  b += beta g,      a = h^2 k + h c,
//   beta = h (force - k (h g.v + g.y - body_displacement) - c (g.v - body_displacement/h))
//
// Contacts, sewing pulls and attachments are all such springs; they are applied without touching the pattern of A.
#pragma once
#include "core/types.hpp"

#include <span>

namespace toile::internal {

struct LinearSpring {
  std::array<Index, 4> particle{-1, -1, -1, -1};  // -1: unused
  std::array<double, 4> weight{0, 0, 0, 0};
  Vec3 direction{0, 0, 0};         // unit
  double force_N = 0;              // at the start of the step, along +g
  double stiffness_N_per_m = 0;    // >= 0
  double damping_N_s_per_m = 0;    // >= 0
  double body_displacement_m = 0;  // travel of the prescribed side (the body) along `direction` in this step
};

struct ImplicitRow {
  std::array<Index, 4> particle;
  std::array<double, 4> weight;
  Vec3 direction;
  double a = 0;     // kg
  double beta = 0;  // N s
};

// direction . sum_k weight_k u_k
inline double along(const LinearSpring& spring, std::span<const Vec3> u) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    if (spring.particle[k] >= 0) sum += spring.weight[k] * u[static_cast<std::size_t>(spring.particle[k])];
  }
  return spring.direction.dot(sum);
}

// `y`: the displacement of the particles besides h v'.  body_s: the time of the body's travel where it is not h (BDF2).
inline ImplicitRow implicit_row(const LinearSpring& s, double h_s, std::span<const Vec3> v, std::span<const Vec3> y,
                                double body_s) {
  const double speed = along(s, v);
  const double travel = h_s * speed + along(s, y) - s.body_displacement_m;
  const double force =
      s.force_N - s.stiffness_N_per_m * travel - s.damping_N_s_per_m * (speed - s.body_displacement_m / body_s);
  return {s.particle, s.weight, s.direction, h_s * h_s * s.stiffness_N_per_m + h_s * s.damping_N_s_per_m, h_s * force};
}
inline ImplicitRow implicit_row(const LinearSpring& s, double h_s, std::span<const Vec3> v, std::span<const Vec3> y) {
  return implicit_row(s, h_s, v, y, h_s);
}

}  // namespace toile::internal
