// mesh/surface_parts.hpp: connected components of a surface, and the volume that each encloses.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct SurfacePart {
  double volume_m3 = 0;  // negative when it is inside out; meaningless unless closed
  bool closed = true;    // every side of a triangle has one neighbour, which walks it the other way
};

struct SurfaceParts {
  std::vector<SurfacePart> parts;  // by their smallest vertex
  std::vector<Index> of;           // [triangle] its part
};

// Components are connected by shared vertices.  Corners must be in range.
SurfaceParts surface_parts(std::span<const Triangle> triangles, std::span<const Vec3> positions);

}  // namespace toile::internal
