// garment/flares.hpp: rings of cloth, drawn flat, hang down from where they are sewn.                docs/theory/sewing.md#flares
//
// A circle skirt, a flounce: a piece of a ring about a centre.  Of more than half a turn its sides, drawn flat, stand up beside the trunk, over
// the head for three quarters of a turn, and what is sewn up there hangs over the shoulders.  Such a panel is a cone without its tip, and a cone can be bent without
// stretch: straight lines from the centre stay straight, and their directions may be any line on the unit sphere that is as long as the ring's angle.
#pragma once
#include "garment/garment_mesh.hpp"

namespace toile::internal {

// Bends what is a ring of more than 200 degrees, drawn in an upright plane and open above: outwards, before its plane, in waves.  A ring that is sewn to
// the outside of another comes to its centre, so that both are one cone, or hangs below it where they cannot be.  `middle`: of the body; away from it is
// outwards.  Returns the number of panels.
int hang_flares(GarmentMesh& garment, const Vec3& middle);

}  // namespace toile::internal
