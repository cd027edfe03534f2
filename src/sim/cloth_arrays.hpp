// sim/cloth_arrays.hpp: cloth from arrays: any surface of triangles, with or without the drawing that it was cut from.
#pragma once
#include "sim/cloth.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace toile::internal {

struct ClothSurface {
  Vec3s x;  // where it starts, m
  std::vector<Triangle> triangles;
  std::vector<std::array<Vec2, 3>> uv;   // [triangle][corner] the rest shape, m; empty: that of the start
  std::vector<Index> panel;              // [triangle]; empty: one panel
  std::vector<std::string> panel_names;  // empty: the cloth's name
};

// The surface, placed; particles keep their order.  Throws InputError naming array and element for sizes that do not agree, numbers that
// are not finite, non-manifold meshes (mesh/check.hpp), and triangles without area.
//
// Without uv a triangle is at rest as it starts: it is laid into the plane with its warp along the vertical, as far as its plane allows, and
// along its first side where it lies level.  Its weft is to the left of the warp, seen from the right side, as in panels.
GarmentMesh cloth_of_surface(const ClothSurface& surface, const SceneCloth& whole);

std::uint64_t hash_of(const ClothSurface& surface);

// Only given in memory: a scene file has no key for it.
struct SceneClothArrays {
  static constexpr bool sewn = false;
  std::shared_ptr<const ClothSurface> surface;
};
inline std::string_view usual_name(const SceneClothArrays&) { return "cloth"; }
MeshedCloth load(const SceneClothArrays& arrays, const SceneCloth& whole, const TextSource& read);
ClothCost cost(const SceneClothArrays& arrays, const SceneCloth& whole, const TextSource& read);

}  // namespace toile::internal
