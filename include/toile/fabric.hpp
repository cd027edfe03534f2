// toile/fabric.hpp: material parameters.                                                sources of the presets: docs/theory/fabrics.md
#pragma once
#include "toile/export.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile {

// Stiffness is force per width, and bending moment per width per curvature: none of it depends on the mesh.
struct Fabric {
  std::string name = "cotton";
  double density_kg_per_m2 = 0.15;
  double stretch_u_N_per_m = 3000, stretch_v_N_per_m = 2000;  // warp, weft
  // Extension at which it pulls twice as hard as a straight line; 0: a straight line; else at least 1e-5.
  double doubling_strain_u = 0, doubling_strain_v = 0;
  double shear_N_per_m = 60;
  // Of the stretch stiffness, in threads that are shorter than at rest; in (0, 1].  Less where triangles are so large that the sheet buckles between their
  // corners; 1: it does not.
  double compression_ratio = 0.1;
  double strain_limit = 0;  // no thread gets longer than 1 + this of its length as cut; 0: no limit
  double bend_u_N_m = 7.3e-6, bend_v_N_m = 7.3e-6;
  double bend_poisson = 0.3;  // how much bending along one thread bends the other way along the other; in [0, 0.5]
  double bend_uv_N_m = 0;     // against twist; 0: (1 - bend_poisson)/2 times the mean of the other two
  double bend_friction_N = 3.85e-4;           // moment per width held by rubbing threads: half of KES-F's 2HB
  double bend_friction_curvature_per_m = 20;  // at which it is reached
  double bend_set = 0;                        // share of the rigidity that follows a bend, in [0, 1]
  double bend_set_s = 60;                     // over this time
  double stretch_damping_s = 2e-3, shear_damping_s = 2e-3, bend_damping_s = 2e-3;  // damping / stiffness
  double friction = 0.35;
  double thickness_m = 2.5e-3;  // between two layers that touch
};

// The preset of that name: silk, cotton, wool, denim, knit, chiffon, satin, jersey, rib, poplin, linen, flannel, suiting, canvas, leather or
// neoprene.  Throws InputError with the nearest name for any other.
TOILE_EXPORT Fabric fabric(std::string_view name);
TOILE_EXPORT std::vector<std::string> fabric_names();

}  // namespace toile
