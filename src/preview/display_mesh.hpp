// preview/display_mesh.hpp: the surface that a studio picture shows, from the simulated one.            [Loop 1987]
//
//   smooth   Loop's subdivision of the positions, the border and pressed folds as cubic B-splines; coordinates of the drawing are halved straight
//   thick    two sheets, joined along open edges; on the wrong side two layers more where a hem is folded
//   lines    open edges and seams in the drawing, listed at the triangles near them: pixels measure their distance from hem and seam
#pragma once
#include "preview/preview.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct ClothLook;

// Of the angle between two sides from which on a fold counts as pressed: 110 degrees.
constexpr double pressed_cosine = -0.34;

struct EdgeLine {  // in the drawing, m
  Vec2 a, b;
  double from_m = 0;  // along the open edge, at a
  bool sewn = false;
};

struct DisplayMesh {
  std::vector<Triangle> triangles;
  std::vector<std::array<Vec2, 3>> uv;
  std::vector<Vec3> positions;
  std::vector<Index> source;  // [triangle] of the simulated mesh
  std::vector<EdgeLine> lines;
  std::vector<std::vector<Index>> lines_near;  // [simulated triangle]
};

// `cloth` has coordinates; `look` [simulated triangle].  Halved until edges are `edge_m` long on average, twice at most; not at all where a position is not
// finite.
DisplayMesh display_mesh(const PreviewCloth& cloth, std::span<const ClothLook* const> look, double edge_m);

// Distances in the drawing from (u, v) to the nearest open edge and seam; `along` the open edge.  Infinite where none is near.
struct EdgeDistance {
  double open_m, along_m, sewn_m;
};
EdgeDistance edge_distance(const DisplayMesh& mesh, Index source, const Vec2& uv);

}  // namespace toile::internal
