// toile/picture.hpp: stills in memory, of a simulation as it is now and of a run.
#pragma once
#include "toile/export.hpp"
#include "toile/simulation.hpp"

#include <string>

namespace toile {

struct PictureOptions {
  int width = 480, height = 480;  // pixels
  double azimuth_deg = 25,
         elevation_deg =
             10;    // where it is seen from: 0 is the front (+z), 90 its left side (+x), 180 the back; from above
  int samples = 8;  // paths per pixel: 8 do, 24 are smooth
};

// The bytes of a PNG: cloth, body and solids on the ground, the cloth filling the picture.  The same bits for any number of threads.  Throws
// Error(usage) when the library was built without pictures, InputError for a size that cannot be drawn.
TOILE_EXPORT std::string picture(const Simulation& simulation, const PictureOptions& options = {});
// The same of the last frame in a run's folder, finished or not.  Throws IoError where there is no run.
TOILE_EXPORT std::string picture(const std::string& folder, const PictureOptions& options = {});

}  // namespace toile
