// garment/flares.hpp: bends ring-shaped panels so that they hang from their seams.                   docs/theory/sewing.md#flares
//
// A circle skirt or a flounce is a sector of a ring.  Drawn flat, the sides of a sector of more than half a turn stand up beside the trunk, for three
// quarters of a turn above the head, and seams up there end over the shoulders.  Such a panel is a cone without its tip, and a cone can be bent without
// stretch: straight lines from the centre stay straight, and their directions may form any curve on the unit sphere as long as the ring's angle.
#pragma once
#include "garment/garment_mesh.hpp"

namespace toile::internal {

// Bends every ring of more than 200 degrees that is drawn in an upright plane and open above: outwards, before its plane, in waves.  A ring that is sewn to
// the outside of another gets the same centre, so that both are one cone, or hangs below it if they cannot be.  `middle`: of the body; away from it is
// outwards.  Returns the number of bent panels.
int hang_flares(GarmentMesh& garment, const Vec3& middle);

}  // namespace toile::internal
