// sim/cloth_shapes.hpp: plain shapes of one panel whose rest shape is a rectangle.
//   grid    in the plane z = 0, facing +z
//   tube    around the y axis, facing outwards; u runs up
#pragma once
#include "sim/cloth_drawing.hpp"

#include <optional>
#include <string_view>

namespace toile::internal {

struct SceneGrid {
  static constexpr std::string_view key = "grid";
  static constexpr bool sewn = false;
  double width_m = 1, height_m = 1, edge_m = 0.02;
};
template <class V>
void describe(V& v, SceneGrid& grid) {
  v.number({"width_m", "along x"}, length_of_a_shape, grid.width_m);
  v.number({"height_m", "along y"}, length_of_a_shape, grid.height_m);
  v.number({"edge_m", "edge length of its triangles"}, edge_of_a_shape, grid.edge_m);
}
template <class V>
void describe_choice(V& v, std::optional<SceneGrid>& grid) {
  v.object({"grid", "near-equilateral triangles, drawn upright around the origin, facing +z", "no"}, grid);
}

struct SceneTube {
  static constexpr std::string_view key = "tube";
  static constexpr bool sewn = false;
  double radius_m = 0.2, length_m = 1, edge_m = 0.02;
};
template <class V>
void describe(V& v, SceneTube& tube) {
  v.number({"radius_m", "about the y axis"}, length_of_a_shape, tube.radius_m);
  v.number({"length_m", "along the y axis"}, length_of_a_shape, tube.length_m);
  v.number({"edge_m", "edge length of its triangles, at most the radius"}, edge_of_a_shape, tube.edge_m);
}
template <class V>
void describe_choice(V& v, std::optional<SceneTube>& tube) {
  v.object({"tube", "around the y axis, open above and below", "no"}, tube);
}
void settle(const Json& value, SceneTube& tube);

inline std::string_view usual_name(const SceneGrid&) { return "sheet"; }
inline std::string_view usual_name(const SceneTube&) { return "tube"; }
ClothSize size_of(const SceneGrid& grid);
ClothSize size_of(const SceneTube& tube);
// Throw InputError("", key, ...).
MeshedCloth load(const SceneGrid& grid, const SceneCloth& whole, const TextSource& read);
MeshedCloth load(const SceneTube& tube, const SceneCloth& whole, const TextSource& read);
ClothCost cost(const SceneGrid& grid, const SceneCloth& whole, const TextSource& read);
ClothCost cost(const SceneTube& tube, const SceneCloth& whole, const TextSource& read);

}  // namespace toile::internal
