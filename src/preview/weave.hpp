// preview/weave.hpp: the grid drawn on cloth along its threads, so that stretch and shear can be judged by eye.
//
// Lines lie where u or v is a multiple of the grid's width g, each line_share * g wide, every fifth wider and darker.  A
// pixel shows their exact average over its extent in u and in v: a line thinner than a pixel fades, it does not
// flicker.
//
// Mind: extents are in metres of cloth, not of space: under stretch a pixel covers less cloth, and lines grow apart and wider.
#pragma once
namespace toile::internal {

// The share, in [0, 1], of the interval [x - extent/2, x + extent/2] covered by bands of width `band` centred on the multiples
// of `period`.  All in the same unit; period > 0, 0 <= band <= period, extent >= 0.
float band_cover(float x, float extent, float period, float band);

// The factor in (0, 1] on the cloth's colour at (u, v), for a pixel that spans `extent_u` and `extent_v` m of cloth.
// grid_m <= 0: no lines, 1.
float weave_shade(float u, float v, float extent_u, float extent_v, float grid_m);

// Its mean over the cloth: for bounced light, where the pixel's extent is not known.
float weave_mean(float grid_m);

}  // namespace toile::internal
