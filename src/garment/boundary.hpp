// garment/boundary.hpp: the openings of a garment, from its pattern alone.
//
// In the sewn garment the edges without a stitch form closed curves.  From the end of one the walk goes on with the next edge of the panel;
// if that is sewn, it crosses the seam and goes on from the edge there, and so around the corner to the next open edge.
//
// Easily got wrong: a seam "right to wrong" joins start with start, and the walk then passes the other panel backwards.
#pragma once
#include "garment/pattern.hpp"

#include <vector>

namespace toile::internal {

struct Opening {
  std::vector<StitchSide> edges;  // in order
  double girth_m = 0;
  Vec3 middle_m{0, 0, 0}, low_m{0, 0, 0}, high_m{0, 0, 0};  // as placed
  Index piece = -1;
};

struct GarmentPiece {  // panels connected by seams
  std::vector<Index> panels;
  double area_m2 = 0;
  Vec3 middle_m{0, 0, 0};  // weighted by area
  Vec3 low_m{0, 0, 0}, high_m{0, 0, 0};
};

struct Boundary {
  std::vector<GarmentPiece> pieces;  // in the order of their first panels
  std::vector<Opening> openings;     // in the order of their first edges
};

// All outlines must be loops, and every stitch must name two edges that no other stitch names.
Boundary find_boundary(const Pattern& pattern);

}  // namespace toile::internal
