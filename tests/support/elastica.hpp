// tests/support/elastica.hpp: the heavy elastica: an inextensible strip, clamped level at one end, bent by its weight.
//
//   M' = (1 - s) cos theta,   theta' = kappa(M),   theta(0) = 0,   M(1) = 0        s in units of the length L, M in w L^2, kappa in 1/L
//
// w its weight per length and width.  An elastic strip has kappa = Gamma M, Gamma = w L^3 / D; threads that rub make it stiffer.
// Solved from the free end with delta = pi/2 - theta and t = 1 - s: M' = t sin delta, delta' = kappa(M), M(0) = 0.  A heavy strip hangs
// straight but for its last bending length, and there delta is exponentially small: the unknown is log delta(0), found by bisection.
#pragma once
#include <array>
#include <cmath>

namespace toile::internal::test {

struct Elastica {
  double H, W;     // drop and reach of the tip, in units of the length
  double tip_rad;  // slope at the tip
};

template <class Curvature>
Elastica elastica_of(const Curvature& kappa) {
  constexpr double pi = 3.14159265358979323846;
  constexpr int steps = 1000;
  // delta, M, H, W along t; delta at the clamp.
  const auto shoot = [&](double delta_0, Elastica& out) {
    std::array<double, 4> y = {delta_0, 0, 0, 0};
    const auto slope = [&](double t, const std::array<double, 4>& at) {
      return std::array<double, 4>{kappa(at[1]), t * std::sin(at[0]), std::cos(at[0]), std::sin(at[0])};
    };
    const double dt = 1.0 / steps;
    for (int n = 0; n < steps; ++n) {
      const double t = n * dt;
      const auto moved = [&](const std::array<double, 4>& k, double by) {
        std::array<double, 4> at = y;
        for (std::size_t i = 0; i < 4; ++i) at[i] += by * k[i];
        return at;
      };
      const auto k1 = slope(t, y), k2 = slope(t + dt / 2, moved(k1, dt / 2)), k3 = slope(t + dt / 2, moved(k2, dt / 2)),
                 k4 = slope(t + dt, moved(k3, dt));
      for (std::size_t i = 0; i < 4; ++i) y[i] += dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
      if (y[0] > pi) break;  // beyond any clamp
    }
    out = {y[2], y[3], pi / 2 - delta_0};
    return y[0];
  };
  Elastica found{};
  double low = -60, high = std::log(pi / 2);
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (shoot(std::exp(middle), found) < pi / 2 ? low : high) = middle;
  }
  return found;
}

inline Elastica elastica(double gamma) {
  return elastica_of([gamma](double M) { return gamma * M; });
}

// The Gamma at which the strip's chord falls by H/W: the inverse of the above, which rises with Gamma.
inline double gamma_of_chord(double H_over_W) {
  double low = -8, high = 9;
  for (int n = 0; n < 40; ++n) {
    const double middle = 0.5 * (low + high);
    const Elastica at = elastica(std::exp(middle));
    (at.H < H_over_W * at.W ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

}  // namespace toile::internal::test
