// garment/placement.hpp: places the flat panels before they are sewn.                           docs/theory/sewing.md#placement
//
// A seam closes cleanly when no part of the body lies between its two sides.  Patterns are placed by eye, often a few centimetres off,
// so small shifts of the whole garment are tried and the one with the fewest blocked seams is taken; shifts that would put a panel's
// edge into the body are excluded, unless seams would be lost without them and such panels can be moved out by themselves.
// Rings are bent first (garment/flares.hpp).
#pragma once
#include "contact/proximity.hpp"
#include "garment/garment_mesh.hpp"

#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

inline constexpr double legacy_origin = 0.68;  // of the body's height: the origin of the frame of the 2021 tool

struct Placement {
  Vec3 shift_m{0, 0, 0};
  double raised_m = 0;                  // of the shift: from the frame of 2021 to the floor
  int blocked_before = 0, blocked = 0;  // seam pairs whose straight line passes through the body, before and after
  int panel_crossings = 0;           // mesh edges of the placed panels that pass through the body: > 0 is a bad start
  std::vector<Index> blocked_seams;  // seams with such lines left, ascending
};

// Finds the shift and applies it to garment.x.  Patterns in the frame of the 2021 tool (GarmentMesh::legacy_frame) are first raised by
// legacy_origin: it is near the pelvis.  The first `person_vertices` of the body's vertices are the person's; the others,
// solids, do not count for that height.  Of shifts that block as little the shortest is taken; with `waist_m`, the height where edges
// labelled for the waist are held, the one that brings them nearest to it.
Placement place_garment(GarmentMesh& garment, const BodySurface& body, std::size_t person_vertices,
                        std::optional<double> waist_m = std::nullopt);
// For the garment where it is: all members of `placement` but the shift and `blocked_before`.
void find_blocked(const GarmentMesh& garment, const BodySurface& body, Placement& placement);
inline Placement place_garment(GarmentMesh& garment, const BodySurface& body) {
  return place_garment(garment, body, body.positions().size());
}

}  // namespace toile::internal
