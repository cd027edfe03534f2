// garment/layering.hpp: panels that are drawn on top of each other get room between them.            docs/theory/sewing.md#placement
//
// The tiers of a skirt, and a bodice within the circle of its skirt, are often drawn in one plane.  Sewn from there, nothing says which lies outside, and
// cloth starts through cloth.  Of panels that cover each other nearer than `layer_gap_m`, that which hangs lower is moved outwards: tiers
// come over what they are sewn to, skirts over bodices.  What is drawn in an order keeps it.
#pragma once
#include "garment/garment_mesh.hpp"

namespace toile::internal {

inline constexpr double layer_gap_m = 0.01;  // thrice the distance at which layers touch while they are sewn

// `middle`: of the body; away from it is outwards.
void separate_layers(GarmentMesh& garment, const Vec3& middle);

}  // namespace toile::internal
