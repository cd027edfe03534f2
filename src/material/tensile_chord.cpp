#include "material/tensile_chord.hpp"

#include "material/laboratory_units.hpp"
#include "material/monotone_curve.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace toile::internal {
namespace {

// `strain_at` knows forces up to `top`.
Chord chord_in(const std::array<double, 2>& range, double top, const std::function<double(double)>& strain_at) {
  const auto stiffness = [&](double force) { return force / strain_at(force); };
  const double high = std::min(range[1], top), low = std::min(range[0], top);
  Chord chord;
  chord.stiffness_N_per_m = stiffness(std::min(0.5 * (range[0] + range[1]), top));
  chord.relative = std::abs(stiffness(high) - stiffness(low)) / std::sqrt(12.0) / chord.stiffness_N_per_m;
  chord.inside = top >= range[0];
  return chord;
}

double kes_force(double linearity, double s) {
  const double s3 = s * s * s;
  if (linearity >= 0.5) {
    const double a = 2 * linearity - 1;
    return a * s + (1 - a) * s3;
  }
  const double b = 6 * linearity - 2;
  return b * s3 + (1 - b) * s3 * s * s;
}

}  // namespace

Chord chord_of(std::span<const std::array<double, 2>> curve, const std::array<double, 2>& range_N_per_m) {
  std::vector<std::array<double, 2>> points = {{0, 0}};
  points.insert(points.end(), curve.begin(), curve.end());
  const MonotoneCurve force(points);
  Chord chord = chord_in(range_N_per_m, curve.back()[1], [&](double f) { return force.inverse(f); });
  if (curve.front()[1] > range_N_per_m[1]) chord.inside = false;
  return chord;
}

StiffeningCurve curve_through(double chord_N_per_m, double middle_N_per_m, double end_N_per_m,
                              double end_chord_N_per_m) {
  constexpr double least_share = 0.1;
  const double K = chord_N_per_m, e2 = (middle_N_per_m / K) * (middle_N_per_m / K);
  const double E = end_N_per_m / end_chord_N_per_m;
  const double steepest = (1 - least_share) * K / e2, room = E * E - e2;
  const double q = room > 0 ? std::min((end_chord_N_per_m - K) / room, steepest) : steepest;
  const double k = K - q * e2;
  return {k, std::sqrt(k / q)};
}

Chord kes_chord(double extension, double linearity, const std::array<double, 2>& range_N_per_m) {
  const auto strain = [&](double force) {
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (kes_force(linearity, middle) * laboratory::kes_tensile_N_per_m < force ? low : high) = middle;
    }
    return extension * 0.5 * (low + high);
  };
  return chord_in(range_N_per_m, laboratory::kes_tensile_N_per_m, strain);
}

}  // namespace toile::internal
