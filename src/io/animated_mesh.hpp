// io/animated_mesh.hpp: a mesh file with what moves it.
#pragma once
#include "io/surface_mesh.hpp"
#include "rig/clip.hpp"
#include "rig/figure.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct AnimatedMesh {
  SurfaceMesh surface;  // at rest
  Figure figure;        // of its vertices, in their order
  std::vector<Clip> clips;
};

// The clip of that name or number, counted from 0; of a file with a single one no choice is needed.  Throws InputError that lists them.
const Clip& chosen_clip(const std::vector<Clip>& clips, std::string_view choice, std::string_view file);

}  // namespace toile::internal
