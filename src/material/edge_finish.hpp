// material/edge_finish.hpp: how the edge of a garment is finished, and what that adds along it.            docs/theory/sewing.md
//
//   hem    the edge is folded in twice: two more layers, on the grain as cut
//   tape   a straight strip of the same cloth, folded once: two more layers, the warp along the edge
//
// Both are narrower than triangles, so they are lines on the mesh: a mass, a thread that resists stretch, and bending along the line.
#pragma once
#include "core/types.hpp"
#include "material/fabric.hpp"

namespace toile::internal {

struct EdgeFinish {
  double hem_m = 0, tape_m = 0;  // widths; 0: none
  bool none() const { return hem_m <= 0 && tape_m <= 0; }
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
LineStiffness line_stiffness(const Fabric& fabric, const Vec2& along, const EdgeFinish& finish);

}  // namespace toile::internal
