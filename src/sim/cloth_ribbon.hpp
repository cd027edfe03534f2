// sim/cloth_ribbon.hpp: a ribbon along a curve.
//
// The curve runs through the points of its path (centripetal Catmull-Rom [Yuksel 2011], by arc length), and the ribbon turns as little as it can
// [Wang 2008]; u runs along it.  A closed one is also twisted evenly, by less than half a turn, so that its ends meet.  Lengths in the drawing are
// those of the curve, so that only bending is strained at the start.
#pragma once
#include "sim/cloth_drawing.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace toile::internal {

struct SceneRibbon {
  static constexpr std::string_view key = "ribbon";
  static constexpr bool sewn = false;
  double width_m = 0.1, edge_m = 0.02;
  std::vector<Vec3> path_m;  // its middle line goes through these points
  bool closed = false;       // from the last point back to the first
  Vec3 across{0, 0, 1};      // its breadth at the first point, made perpendicular to the line
};
template <class V>
void describe(V& v, SceneRibbon& ribbon) {
  v.number({"width_m", "its breadth"}, length_of_a_shape, ribbon.width_m);
  v.number({"edge_m", "edge length of its triangles"}, edge_of_a_shape, ribbon.edge_m);
  v.flag({"closed", "from the last point back to the first"}, ribbon.closed);
  v.rows(Setting{"path_m", "points that its middle runs through, smoothly"}.needs(), Rows{}, ribbon.path_m,
         [](auto& row, Vec3& p) {
           row.column("x", anywhere, p.x());
           row.column("y", anywhere, p.y());
           row.column("z", anywhere, p.z());
         });
  v.vector({"across", "direction of its breadth at the first point; it turns as little as it can from there"}, anywhere,
           ribbon.across);
}
template <class V>
void describe_choice(V& v, std::optional<SceneRibbon>& ribbon) {
  v.object({"ribbon", "along a curve", "no"}, ribbon);
}
void settle(const Json& value, SceneRibbon& ribbon);

inline std::string_view usual_name(const SceneRibbon&) { return "ribbon"; }
ClothSize size_of(const SceneRibbon& ribbon);
// Throws InputError("", "path_m", ...).
MeshedCloth load(const SceneRibbon& ribbon, const SceneCloth& whole, const TextSource& read);
ClothCost cost(const SceneRibbon& ribbon, const SceneCloth& whole, const TextSource& read);

}  // namespace toile::internal
