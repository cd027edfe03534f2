// assembly/finished_edges.hpp: what the finished edges of a mesh add to its model.                       material/edge_finish.hpp
//
//   mass and a thread    on the edge itself (edge_threads.hpp)
//   bending along it     at every particle between two edges of a line, from the fold angles of the hinges there (line_moments.hpp)
//
// Seen from its own side, two edges of a line meet at a particle with a fan of triangles between them.  Laid flat it opens by Phi; its hinges lie at the
// angles phi_h from the first edge.  Across hinge h the slope changes by theta_h n_h, so along the line by
//
//   kink = sum over the fan's hinges of a_h theta_h,    a_h = n_h.t = cos(Phi/2 - phi_h),      E = K kink^2/2,   K = 1/(L_1/(2 EI_1) + L_2/(2 EI_2))
//
// with t between the directions of both edges.  Heights of particles alone are in it: on a straight line it is exact for constant curvature,
// on any triangles, and whatever the cloth beside it is.                                              docs/theory/sewing.md#finished-edges
//
//   bending across it    where an allowance is stitched down, in the plates: of the triangles of its own panel within its width of the edge
//
// A triangle has one moment, and the two cloths in it, covered for a share s of its area, bend by as much each as their own rigidity says:
//
//   C^-1 = (1 - s) C_cloth^-1 + s C_topstitched^-1
//
// which is exact for a moment across the seam, wherever the allowance ends in the triangles.  A triangle that several edges' bands cover shares them by
// area.  Hinges by themselves do without.
#pragma once
#include "assembly/cloth_model.hpp"

#include <span>

namespace toile::internal {

// `fabric_of_panel` as in build_model.  Edges that no triangle has are left out.  An edge of two triangles counts as that which walks it from a to b:
// each side of a seam has its own finish.
void finish_edges(ClothModel& model, std::span<const Fabric> fabric_of_panel, bool plates);

}  // namespace toile::internal
