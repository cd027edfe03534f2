// material/fabric.hpp: the material parameters of a cloth, in SI, and presets.  Sources: docs/theory/fabrics.md
//
// A member has the name of its key in a scene.  Stiffness is force per width (stretch, shear) and moment per width per
// curvature (bend), so none of them depends on the mesh.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace toile::internal {

// Stiffer than anything, and what steps still solve: a sheet of cotton hangs with 1e-5, and steps collapse with 1e-6.
constexpr double least_doubling_strain = 1e-5;

struct Fabric {
  std::string name = "cotton";
  double density_kg_per_m2 = 0.15;
  double stretch_u_N_per_m = 3000, stretch_v_N_per_m = 2000;  // warp, weft
  // Extension at which a thread pulls twice as hard as a straight line of that stiffness: T = k (e + e^3 / doubling^2).  0: a straight line; else
  // at least least_doubling_strain.
  double doubling_strain_u = 0, doubling_strain_v = 0;
  double shear_N_per_m = 60;
  // Of the stretch stiffness, in threads that are shorter than at rest; in (0, 1].  Less where triangles are so large that the sheet buckles between their
  // corners; 1: it does not.
  double compression_ratio = 0.1;
  double strain_limit = 0;  // no thread gets longer than 1 + this of its length as cut; 0: no limit
  double bend_u_N_m = 7.3e-6, bend_v_N_m = 7.3e-6;
  double bend_poisson = 0.3;  // how much bending along one thread bends the other way along the other; in [0, 0.5]
  double bend_uv_N_m = 0;     // rigidity against twist; 0: (1 - bend_poisson)/2 times the mean of the other two
  // Bending that stays (material/bend_hysteresis.hpp).  Rubbing threads hold a moment per width of up to bend_friction_N, half of KES-F's
  // 2HB, which they reach within bend_friction_curvature_per_m; bend_set of the rigidity follows the bend over bend_set_s.
  double bend_friction_N = 3.85e-4, bend_friction_curvature_per_m = 20;
  double bend_set = 0, bend_set_s = 60;
  double stretch_damping_s = 2e-3, shear_damping_s = 2e-3, bend_damping_s = 2e-3;  // k_d / k
  double friction = 0.35;
  double thickness_m = 2.5e-3;  // rest distance of two layers in contact, and of cloth from a body
};

// For two fabrics in contact, by name, in either order.
struct PairFriction {
  std::string first, second;
  double friction = 0;
};

std::span<const Fabric> fabric_presets();  // silk, cotton, wool, denim, knit, chiffon ...: fabric_presets.cpp

// Throws InputError(where, place, ...) with the nearest preset when there is none of that name.
const Fabric& fabric_preset(std::string_view name, std::string_view where, std::string_view place);

// The cloth with another fused to it all over, the middles of the two `apart_m` from each other: collars, cuffs, fronts of coats.  Layers that cannot
// slide on each other bend as a sandwich, along each thread and for twist:
//   D = D_1 + D_2 + d^2 k_1 k_2 / (k_1 + k_2)          k: stretch of the thread; of the twist D_uv, shear
// Mass, stretch and shear add up; glue keeps threads from buckling, so compression_ratio does not count.  All else is the cloth's.
constexpr double fused_apart_m = 0.3e-3;  // of two shirtings
Fabric fused(const Fabric& cloth, const Fabric& interfacing, double apart_m);

// Throws InputError naming the key (place + "/" + key) of a value that is not finite, negative, or zero where it may
// not be: density, stretch and thickness.
void check_fabric(const Fabric& fabric, std::string_view where, std::string_view place);

}  // namespace toile::internal
