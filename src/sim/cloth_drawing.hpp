// sim/cloth_drawing.hpp: shared by the kinds of cloth of one panel with a rectangular rest shape; the panel has the cloth's name.
#pragma once
#include "sim/cloth.hpp"

#include <functional>
#include <string_view>

namespace toile::internal {

inline constexpr Range length_of_a_shape{1e-3, 10}, edge_of_a_shape{5e-4, 1};

// The size of a shape, for the number of its triangles.
struct ClothSize {
  double area_m2 = 0, outline_m = 0;
};

// One limit and one message for every kind: the triangulation counts in 2^-20 m, with 25 bits.
inline constexpr double longest_drawn_m = 32;
// Throws InputError("", key, ...).
void check_length(std::string_view key, std::string_view what, double length_m);

struct ClothRectangle {
  double width_m, height_m, edge_m;
  bool joined = false;  // the side at the largest x is the one at x = 0
};
// Grain up, as in panels.
Vec2 warp_upright(const Vec2& p);
// The rectangle in triangles: `where` places a point of it, and `grain` is its (u, v).  Throws InputError if it has no area once placed.
MeshedCloth drawn(const ClothRectangle& rectangle, const SceneCloth& whole,
                  const std::function<Vec2(const Vec2&)>& grain, const std::function<Vec3(const Vec2&)>& where);

ClothCost cost_of_drawing(std::string_view key, const ClothSize& size, double edge_m, const SceneCloth& whole);

}  // namespace toile::internal
