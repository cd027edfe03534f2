// preview/crossing_overlay.hpp: crossings drawn over a finished picture as glowing red tubes, never hidden by cloth or body.
#pragma once
#include "preview/preview.hpp"

#include <span>

namespace toile::internal {

// Segments in world coordinates, m.  Parts behind the eye are cut off; segments that are not finite are left out.  A segment of
// no length is drawn as a dot.
void draw_crossings(Image& image, const Camera& camera, std::span<const std::array<Vec3, 2>> segments);

}  // namespace toile::internal
