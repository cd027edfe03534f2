// material/laboratory_units.hpp: the units of textile laboratories in SI.                      docs/howto/fit-fabric.md
#pragma once

namespace toile::internal::laboratory {

constexpr double gf_N = 9.80665e-3;    // gram-force
constexpr double gravity_m_s2 = 9.81;  // as in D = w g c^3 of docs/theory/fabrics.md
constexpr double rad_per_degree = 3.14159265358979323846 / 180;

// KES-F: per centimetre of width.
constexpr double bending_N_m = gf_N * 1e-2;                     // B, gf cm^2/cm: moment per width and curvature
constexpr double bending_friction_N = gf_N;                     // 2HB, gf cm/cm: moment per width
constexpr double shear_N_per_m = gf_N / 1e-2 / rad_per_degree;  // G, gf/(cm deg)
constexpr double force_N_per_m = gf_N / 1e-2;                   // gf/cm
constexpr double work_N_per_m = gf_N * 1e-2 / 1e-4;             // WT, gf cm/cm^2: work per area
constexpr double kes_tensile_N_per_m = 500 * force_N_per_m;     // at which EMT is read

// FAST-2 and FAST-3.
constexpr double fast_loads_N_per_m[3] = {5 * force_N_per_m, 20 * force_N_per_m, 100 * force_N_per_m};  // E5, E20, E100

// A strip cut on the bias and pulled with the force F per width has the shear angle 2 e at the extension e.  F e / 2 = G (2 e)^2 / 2 is the work
// per area, so that G = F / (4 e): 123 N/m over the extension in percent.
constexpr double bias_shear_N_per_m(double extension) { return fast_loads_N_per_m[0] / (4 * extension); }

// A strip bent under its own weight until its chord is 41.5 degrees below the level is twice its bending length long.  ASTM D1388, ISO 9073-7
constexpr double bending_length_per_overhang = 0.5;

// D = w g c^3
constexpr double rigidity_N_m(double weight_kg_per_m2, double bending_length_m) {
  return weight_kg_per_m2 * gravity_m_s2 * bending_length_m * bending_length_m * bending_length_m;
}

}  // namespace toile::internal::laboratory
