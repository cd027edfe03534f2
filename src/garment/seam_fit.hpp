// garment/seam_fit.hpp: whether seams fit as the panels are placed, and which side of each panel is the right one.
//
//   as_sewn = |a0 - b0| + |a1 - b1|,   other_way = |a0 - b1| + |a1 - b0|       a0, a1: placed ends of one edge, b0, b1: the points sewn to them
#pragma once
#include "garment/pattern.hpp"

#include <optional>
#include <vector>

namespace toile::internal {

// A seam counts as twisted when sewing it the other way round would bring the placed edges this much nearer.  Two edges of the same panel
// edge-on to each other are no evidence; only a clear difference is.
constexpr double twist_ratio = 2;

struct SeamEnds {
  double as_sewn_m = 0, other_way_m = 0;
  bool twisted() const { return as_sewn_m > twist_ratio * other_way_m; }
};
// For existing edges; nothing for a dart.
std::optional<SeamEnds> seam_ends(const Pattern& pattern, const Stitch& stitch);

// Panels joined "right to wrong" are turned over for the surface to have one right side.
struct PanelSides {
  std::vector<int> side;  // [panel] 1: as drawn, -1: turned over
  Index conflict = -1;    // a stitch that disagrees with the others: the surface is one-sided; -1: none
};
PanelSides panel_sides(const Pattern& pattern);

}  // namespace toile::internal
