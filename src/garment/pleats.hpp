// garment/pleats.hpp: three layers in one seam.                                                          docs/theory/sewing.md
//
//        band  ------k-----------k+1------        a  lies in front, b goes back under it, c forwards again.  The pattern sews all three to
//                    |     a     |                the piece of band between k and k+1; b is "right_wrong", as it shows its inner side.
//                    |  <----b---|
//                    |---c--->   |                Four triangles at an edge are none of a surface.  So a is welded to the band, b to c, and
//                                                 the corner between b and c to k: both lines end at k and k + 1, and are as long.
#pragma once
#include "garment/pattern.hpp"
#include "mesh/cloth_mesh.hpp"

#include <optional>
#include <span>
#include <vector>

namespace toile::internal {

struct Pleat {
  std::size_t over = 0, under = 0, inner = 0;  // stitches: of a, b, c
  StitchSide band, b, c;
  Index tip = 0;       // corner between b and c, of their panel
  Index band_end = 0;  // the corner of the band that it is sewn to
};

// The pleat that three stitches of one edge form, given by their numbers in the pattern's order; none if they do not.
std::optional<Pleat> pleat_of(const Pattern& pattern, const std::vector<std::size_t>& stitches);

// The pleats of a pattern whose stitches all name existing edges, by band.
std::vector<Pleat> pleats_of(const Pattern& pattern);

struct CornerJoin {  // two corners that become one particle
  Index panel_a = 0, corner_a = 0, panel_b = 0, corner_b = 0;
};

struct PleatedPattern {
  Pattern pattern;                // b sewn to c, as a dart, in place of the stitches of b and c to the band
  std::vector<CornerJoin> joins;  // of tips
  std::vector<StitchSide> edges;  // of the layers and the band: at least two pieces each
};
PleatedPattern resolve_pleats(const Pattern& pattern);

// Lays a panel, as it is placed, along its folds until layers are 10 degrees apart, ridges and valleys as they are; its mean stays where it is.  A flat one
// would have to find the order of its layers while its seams close.  Only straight folds are laid.
void lay_pleats(const ClothMesh& mesh, Index panel, std::span<Vec3> x);

}  // namespace toile::internal
