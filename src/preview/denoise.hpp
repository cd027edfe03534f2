// preview/denoise.hpp: smooths the light of a picture with few paths per pixel.   [Dammertz et al. 2010; Schied et al. 2017]
//
// An edge-avoiding a-trous filter: passes of a 3 x 3 kernel with steps of 1, 2, 4 ... pixels, whose weights fall where the
// normal turns, the neighbour lies off the pixel's tangent plane, or the light differs by more than its noise explains.
//
// Mind: differences are measured against the noise: a picture with many samples hardly changes, and pixels without variance do not.
#pragma once
#include "preview/path_tracer.hpp"

#include <vector>

namespace toile::internal {

// The radiance of every pixel, changed by the smoothed light of its larger layer.
// `metre_per_pixel` is a pixel's size at the subject.
std::vector<Vec3f> denoised_radiance(const std::vector<PixelLight>& pixels, int width, int height,
                                     float metre_per_pixel);

}  // namespace toile::internal
