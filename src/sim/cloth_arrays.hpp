// sim/cloth_arrays.hpp: cloth that is given as arrays: any surface of triangles, with or without the drawing that it was cut from.
#pragma once
#include "garment/garment_mesh.hpp"
#include "sim/scene.hpp"

#include <cstdint>

namespace toile::internal {

// The cloth's arrays, placed; particles keep their order.  Throws InputError naming array and element for sizes that do not agree, numbers that
// are not finite, what is no surface (mesh/check.hpp), and triangles without area.
//
// Without uv a triangle is at rest as it starts: it is laid into the plane with its warp along the vertical, as far as its plane allows, and
// along its first side where it lies level.  Its weft is to the left of the warp, seen from the right side, as in panels.
GarmentMesh cloth_of_arrays(const SceneCloth& cloth);

std::uint64_t hash_of(const SceneClothArrays& arrays);

}  // namespace toile::internal
