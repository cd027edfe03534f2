// garment/triangulate_outline.hpp: a polygon in metres checked and brought onto the integer grid, and the lattice
// that fills it.
#pragma once
#include "core/types.hpp"
#include "garment/exact_predicates.hpp"

#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct GridOutline {
  std::vector<GridPoint> points;  // as many as the outline has, in its order
  Vec2 origin_m{0, 0};            // on the grid; metres = origin_m + grid_step_m * point

  Vec2 to_metres(const GridPoint& p) const { return origin_m + grid_step_m * Vec2(p.x, p.y); }
};

// Throws InputError as `triangulate` says.  O(n log n) plus the pairs of edges whose extents overlap in x.
GridOutline snap_outline(std::span<const Vec2> outline);

// The points of a triangular lattice of spacing `edge` (in grid steps) that lie inside the polygon, at least `margin`
// from its edges, row by row.  Rows are parallel to x; the spacings are stretched by less than half a cell in all, so
// that whole cells fit the polygon's extent: on a rectangle whose sides are cut at `edge` the rows at the top and
// bottom match the outline.
std::vector<GridPoint> lattice_inside(std::span<const GridPoint> outline, double edge, double margin);

// The shortest decimal number that reads back as `value`, for error messages.
std::string shortest_text(double value);

}  // namespace toile::internal
