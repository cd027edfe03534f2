// sim/cloth_of_mesh.hpp: a garment that somebody has modelled: a mesh file as cloth.                       docs/scenes.md#meshes
//
// Panels are the file's groups (or its objects, if it has no groups).  Vertices that the file had to split, because the drawing (`vt`) has a seam there,
// are one particle (mesh/join_sides.hpp).  Those that no face uses are left out; the others keep their order.
//
// A drawing in metres says how the cloth was cut: u of the warp is the second number of a vt, v of the weft the first one, leftwards.  One in other
// units (0 ... 1, of a texture) says only where the warp runs: then the cloth is at rest as it starts.
#pragma once
#include "io/surface_mesh.hpp"
#include "sim/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// Says in `warnings` what was not taken as it stands.  Throws InputError, with `file` as its place, for a mesh without faces, and with
// RestShape::drawing for a face without vt or without area in the drawing.
SceneClothArrays arrays_of_mesh(const SurfaceMesh& mesh, std::string_view file, double unit_m, RestShape rest,
                                std::vector<std::string>& warnings);

}  // namespace toile::internal
