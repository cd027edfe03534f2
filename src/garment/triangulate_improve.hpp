// garment/triangulate_improve.hpp: improves the triangles of a Delaunay mesh; the outline is unchanged.
#pragma once
#include "garment/delaunay.hpp"

namespace toile::internal {

// Moves every inner vertex to the area-weighted mean of the circumcentres around it (optimal Delaunay triangulation,
// Chen and Holst 2011), `sweeps` times, with flips after each sweep.  A regular lattice is a fixed point.
void smooth(Delaunay& mesh, int sweeps);

// Works off the triangles with an angle below about 35 degrees or an edge well over `edge` grid steps, worst first:
// moves, removes and inserts vertices near each, and keeps a change only when the triangles it touched have become
// better.
void improve(Delaunay& mesh, double edge);

}  // namespace toile::internal
