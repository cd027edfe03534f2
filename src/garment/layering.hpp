// garment/layering.hpp: separates panels that are drawn on top of each other.                        docs/theory/sewing.md#placement
//
// The tiers of a skirt, and a bodice within the circle of its skirt, are often drawn in one plane.  Then the order of the layers is undefined, and cloth
// starts through cloth.  Of two panels that cover each other nearer than `layer_gap_m` the lower one is moved outwards: tiers over the panel that
// they are sewn to, skirts over bodices.  Panels that are drawn in an order keep it.
#pragma once
#include "garment/garment_mesh.hpp"

namespace toile::internal {

inline constexpr double layer_gap_m = 0.01;  // thrice the distance at which layers touch while they are sewn

// `middle`: of the body; away from it is outwards.
void separate_layers(GarmentMesh& garment, const Vec3& middle);

}  // namespace toile::internal
