// material/tensile_chord.hpp: the stretch stiffness of a cloth from its force-extension curve.        docs/theory/fabrics.md
//
// Curves bend upwards: the chord from zero to a small force is much softer than that to a large one.  What counts is the chord at the
// middle of the range of forces; half the way between the chords at its ends, as of a value that may lie anywhere
// between them, is its uncertainty: |k_2 - k_1| / sqrt(12).
#pragma once
#include <array>
#include <functional>
#include <span>

namespace toile::internal {

struct Chord {
  double stiffness_N_per_m = 0, relative = 0;  // relative: by the range of forces only
  bool inside = true;  // the curve has points in or beside the range; otherwise the nearest chord
};

// Points (strain, force per width), ascending strictly from above zero; at least one.
Chord chord_of(std::span<const std::array<double, 2>> curve, const std::array<double, 2>& range_N_per_m);

// KES-F gives the end of the curve, `extension` at 490 N/m, and its linearity LT: the work of the curve over that of the straight line.
// A curve of that work, with s = strain / extension:
//   LT from 1/2 to 1      F / F_m = a s + (1 - a) s^3        a = 2 LT - 1
//   LT from 1/3 to 1/2    F / F_m = b s^3 + (1 - b) s^5      b = 6 LT - 2
Chord kes_chord(double extension, double linearity, const std::array<double, 2>& range_N_per_m);
constexpr double least_linearity = 1.0 / 3;
constexpr double kes_shape_relative = 0.25;  // uncertainty of a chord that comes from such a guess of the curve

// T = k (e + e^3 / d^2) with the chord K at `middle` and F over its extension, `end_chord`, at the end F: with E = F / end_chord and e = middle / K
//   q = (F/E - K) / (E^2 - e^2),  k = K - q e^2,  d^2 = k / q.       end_chord > K
// A curve that begins flatter than this one can, or two methods' that do not fit together (E <= e), keeps a tenth of K for k: threads that do not pull at all have no place.
struct StiffeningCurve {
  double stiffness_N_per_m = 0, doubling_strain = 0;
};
StiffeningCurve curve_through(double chord_N_per_m, double middle_N_per_m, double end_N_per_m,
                              double end_chord_N_per_m);

}  // namespace toile::internal
