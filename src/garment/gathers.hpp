// garment/gathers.hpp: the rest shape of cloth along a gathered seam.                                     docs/theory/sewing.md
//
// Both sides of a seam share every particle, so the seam has one length.  Of two rest lengths that differ by more than ease the triangles on
// either side would only pull each other to a length in between.  A gathering thread decides in favour of the short side:
//
//   along the seam   rest length = drawn length x s(d),     s(d) = 1/r + (1 - 1/r) min(1, d / reach)
//   across           as drawn
//
// with r the ratio of both sides and d the distance from the seam in the drawing.  An edge of the mesh takes s from its middle, an edge on the
// seam the length of the edge that it is sewn to, so that triangles agree on the edges they share.  A triangle takes the shape that has these
// three lengths, by the symmetric stretch of its drawn shape: its threads keep their directions.
#pragma once
#include "garment/pattern.hpp"
#include "mesh/cloth_mesh.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// Longer / shorter side, above which a seam is gathered and not eased.  Ease of 1.10 stretches the short side by 1.4 %, in proportion.
constexpr double gathered_ratio = 1.15;
// How far from the seam cloth is gathered, m, and at least so many edges.  The folds fit in there: at 5:1 and 1 cm, p99 of stretch is
// 3.3 % with 3 cm, 2.6 % with 3.5; with 4 cm a step collapsed.
constexpr double gather_reach_m = 0.035;
constexpr double gather_reach_edges = 2;

// Edge length of the mesh within reach of a gathered seam: 1 cm for an edge length of 1 to 2 cm, else half of it.  A fold is
// two edges at least, and then it is skew: at 5:1 and 2 cm throughout, p99 of stretch is 5.8 %; with 1 cm near the seam 2.1 %.
double gather_edge_m(double resolution_m);

struct GatheredSeam {
  StitchSide longer, shorter;
  double length_m = 0;  // of the longer
};
// In the order of the stitches.
std::vector<GatheredSeam> gathered_seams(const Pattern& pattern);

struct Gather {                  // the longer side of a seam
  std::vector<Index> particles;  // in order
  std::vector<double> piece_m;   // [particles - 1] rest lengths: those of the shorter side
  double ratio = 1;              // longer / shorter
};

// Sets mesh.gathered_uv, if there are gathers.  The mesh is not welded yet.
void gather(ClothMesh& mesh, std::span<const Gather> gathers);

}  // namespace toile::internal
