// material/edge_finish.hpp: how the edge of a garment is finished, and what that adds along it.            docs/theory/sewing.md
//
//   hem         the edge is folded in twice: two more layers, on the grain as cut
//   tape        a straight strip of the same cloth, folded once: two more layers, the warp along the edge
//   allowance   cloth beyond a seam, pressed back on its own side: one more layer, on the grain as cut; it may be stitched down
//
// All are narrow, so they are lines on the mesh: a mass, a thread that resists stretch, and bending along the line.  An allowance that is stitched
// down also bends across it.
#pragma once
#include "core/types.hpp"
#include "material/fabric.hpp"

namespace toile::internal {

struct EdgeFinish {
  double hem_m = 0, tape_m = 0, allowance_m = 0;  // widths; 0: none
  bool topstitched = false;                       // the allowance
  bool none() const { return hem_m <= 0 && tape_m <= 0 && allowance_m <= 0; }
  bool operator==(const EdgeFinish&) const = default;
};

struct LineStiffness {  // of a line, added to the cloth's own
  double mass_kg_per_m = 0;
  double stretch_N = 0;  // force per strain
  double bend_N_m2 = 0;  // moment per curvature along the line, out of the cloth
};

// `along`: the line's direction in the pattern, (u, v), of any length above zero.  Layers slide on each other: n bend n times as hard as one.
//   stretch of a narrow strip in the direction (c, s):   1/E = c^4/k_u + s^4/k_v + c^2 s^2/k_shear
//   bending:                                             1/D = m.C^-1 m,   m = (c^2, s^2, c s),   C of material/plate.hpp
// An allowance that is stitched down: in addition layer_coupling_N_m along the line.
LineStiffness line_stiffness(const Fabric& fabric, const Vec2& along, const EdgeFinish& finish);

// Two layers stitched to each other at lines can neither slide along a line nor, in the mean, between two of them: bent, one is stretched and the other
// pushed together, as in a sandwich (fused() of fabric.hpp).  Between stitches the latter buckles, with c = compression_ratio of its stiffness:
//   V k t^2,   V = c/(1 + c)        along `direction`, per width
// t, the distance of the layers' middles, is the thickness of one, from its mass: woven cloth has some 500 kg/m^3, a shirting of 0.15 kg/m^2 0.3 mm
// (fused_apart_m), a denim of 0.4 kg/m^2 0.8 mm.
constexpr double cloth_kg_per_m3 = 500;
double layer_coupling_N_m(const Fabric& fabric, const Vec2& direction);

// C of the cloth where an allowance is stitched to it, which resists bending `across` the line with the layer's own rigidity and the coupling.
// Loose, it hangs on the seam alone, and stays straight when the cloth below it bends across.
Mat3 topstitched_rigidity(const Fabric& fabric, const Vec2& across);

}  // namespace toile::internal
