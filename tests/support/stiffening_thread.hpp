// tests/support/stiffening_thread.hpp: T = k (e + e^3 / d^2) the other way round, by Newton's method.
#pragma once

namespace toile::internal::test {

// e at a force per width; d = 0: a straight line.
inline double extension_at(double tension_N_per_m, double k, double d) {
  const double cube = d > 0 ? k / (d * d) : 0;
  double e = tension_N_per_m / k;
  for (int n = 0; n < 100; ++n) e -= (k * e + cube * e * e * e - tension_N_per_m) / (k + 3 * cube * e * e);
  return e;
}

}  // namespace toile::internal::test
