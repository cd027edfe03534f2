// tests/garment/garments.hpp: small patterns made in memory, for tests of meshing, placing and sewing.
#pragma once
#include "garment/garment_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace toile::internal::test {

// A panel with straight edges; edge k runs from corner k to corner k + 1.
inline Panel straight_panel(std::string name, std::vector<Vec2> corners, const Vec3& translation) {
  Panel panel;
  panel.name = std::move(name);
  panel.translation_m = translation;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    PanelEdge edge;
    edge.start = static_cast<Index>(k);
    edge.end = static_cast<Index>((k + 1) % corners.size());
    panel.edges.push_back(edge);
  }
  panel.corners = std::move(corners);
  return panel;
}

// Counter-clockwise from the lower left: edges 0 bottom, 1 right, 2 top, 3 left.  Faces +z.
inline Panel front_rectangle(double width, double height, const Vec3& centre) {
  const double w = width / 2, h = height / 2;
  return straight_panel("front", {{-w, -h}, {w, -h}, {w, h}, {-w, h}}, centre);
}

// Clockwise from the lower right: edges 0 bottom, 1 left, 2 top, 3 right.  Faces -z.
inline Panel back_rectangle(double width, double height, const Vec3& centre) {
  const double w = width / 2, h = height / 2;
  return straight_panel("back", {{w, -h}, {-w, -h}, {-w, h}, {w, h}}, centre);
}

inline Stitch stitch(Index panel_a, Index edge_a, Index panel_b, Index edge_b, bool right_wrong = false) {
  Stitch stitch;
  stitch.a = {panel_a, edge_a};
  stitch.b = {panel_b, edge_b};
  stitch.right_wrong = right_wrong;
  return stitch;
}

// Two rectangles `apart` metres from each other in z, sewn along both sides: seams 0 at +x and 1 at -x.
inline Pattern tube_pattern(double width, double height, double apart, const Vec3& centre = Vec3::Zero()) {
  Pattern pattern;
  pattern.name = "tube";
  pattern.panels = {front_rectangle(width, height, centre + Vec3(0, 0, apart / 2)),
                    back_rectangle(width, height, centre - Vec3(0, 0, apart / 2))};
  pattern.stitches = {stitch(0, 1, 1, 3), stitch(0, 3, 1, 1)};
  return pattern;
}

inline double uv_area(const std::array<Vec2, 3>& uv) {
  const Vec2 e = uv[1] - uv[0], f = uv[2] - uv[0];
  return 0.5 * (e.x() * f.y() - e.y() * f.x());
}

inline Vec3 normal_of(const Vec3s& x, const Triangle& t) {
  return (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]);
}

}  // namespace toile::internal::test
