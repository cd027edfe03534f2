// garment/placement.hpp: where the flat panels hang before they are sewn.                       docs/theory/sewing.md#placement
//
// A seam closes cleanly when nothing of the body lies between its two sides.  Patterns are placed by eye, often a few centimetres off,
// so small shifts of the whole garment are tried and the one with the least of its seams behind the body is taken; shifts that
// would put a panel's edge into the body are not considered, unless seams would be lost without them and such panels can be moved out on their own.
// Rings are bent first (garment/flares.hpp).
#pragma once
#include "contact/proximity.hpp"
#include "garment/garment_mesh.hpp"

#include <string>
#include <vector>

namespace toile::internal {

inline constexpr double legacy_origin = 0.68;  // of the body's height: where y = 0 is in the frame of the 2021 tool

struct Placement {
  Vec3 shift_m{0, 0, 0};
  double raised_m = 0;                  // of the shift, from the frame of 2021 to the floor's
  int blocked_before = 0, blocked = 0;  // seam pairs whose straight line passes through the body, before and after
  int panel_crossings = 0;           // mesh edges of the placed panels that pass through the body: > 0 is a bad start
  std::vector<Index> blocked_seams;  // seams with such lines left, ascending
};

// Finds the shift and applies it to garment.x.  Patterns in the frame of the 2021 tool (GarmentMesh::legacy_frame) are first raised by
// legacy_origin: it is near the pelvis.  Of the body's vertices the first `person_vertices` are the person's; what comes
// behind them, solids, has no part in that height.
Placement place_garment(GarmentMesh& garment, const BodySurface& body, std::size_t person_vertices);
// The garment where it is: everything of `placement` but the shift and what was before it.
void find_blocked(const GarmentMesh& garment, const BodySurface& body, Placement& placement);
inline Placement place_garment(GarmentMesh& garment, const BodySurface& body) {
  return place_garment(garment, body, body.positions().size());
}

}  // namespace toile::internal
