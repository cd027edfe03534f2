// mesh/surface_parts.hpp: what of a surface hangs together, and what each part encloses.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct SurfacePart {
  double volume_m3 = 0;  // negative when it is turned inside out; means nothing unless closed
  bool closed = true;    // every side of a triangle has one neighbour, which walks it the other way
};

struct SurfaceParts {
  std::vector<SurfacePart> parts;  // by their smallest vertex
  std::vector<Index> of;           // [triangle] its part
};

// Through shared vertices.  Corners must be in range.
SurfaceParts surface_parts(std::span<const Triangle> triangles, std::span<const Vec3> positions);

}  // namespace toile::internal
