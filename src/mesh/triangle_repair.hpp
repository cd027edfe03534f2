// mesh/triangle_repair.hpp: makes a closed surface, seen from outside, of triangles as files of bodies hold them.     docs/scenes.md#mended
//
// Vertices keep their places and numbers, so that samples of a motion still fit: all that changes are triangles.
//   mend_corners   loose vertices at one place become one; what has no area or is there twice goes
//   swap_flat      (a, b, c) with c on its side ab, beyond which lies (b, a, d): they become (a, d, c) and (d, b, c)
//   mend_part      of one part: walls inside it go, all triangles face outwards, small holes are capped
#pragma once
#include "core/types.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace toile::internal {

// Triangles of a file while they are mended.
struct MendedTriangles {
  std::vector<Triangle> triangles;
  std::vector<Index> source;  // [triangle] its number in the file; -1: of a cap
};

struct MendedCorners {
  std::size_t welded = 0;      // vertices that are one with an earlier one
  std::size_t degenerate = 0;  // triangles with a corner twice
  std::size_t duplicate = 0;   // with the corners of an earlier one
  std::size_t flat = 0;        // that have got another diagonal
};

// Loose vertices, which lie on an edge that has not two triangles, are joined within `reach`, the rounding of a file's digits.
MendedCorners mend_corners(MendedTriangles& mesh, std::span<const Vec3> positions, double reach);

// No triangle of these corners encloses anything with a neighbour: its area is below 1e-9 of its longest side's square.
bool is_flat(const std::array<Vec3, 3>& corner);

// Gives the long side of each flat triangle to its neighbour, as long as that helps; returns how often.
std::size_t swap_flat(MendedTriangles& mesh, std::span<const Vec3> positions);

// A closed curve of sides that have one triangle each.
struct Hole {
  std::vector<Index> loop;  // as its triangles walk it
  double girth = 0;
  Vec3 middle{0, 0, 0};
};

struct MendedPart {
  std::size_t walls = 0;                 // triangles inside it that are gone
  std::size_t turned = 0;                // triangles that face the other way now
  std::vector<Hole> capped;              // small ones, which are closed now
  std::vector<Hole> open;                // all others
  std::array<Index, 2> crowded{-1, -1};  // ends of an edge of three triangles and more; -1: none
  std::array<Index, 2> one_sided{-1,
                                 -1};  // of an edge at which the surface meets its own back, as a Moebius strip does
  bool closed() const { return open.empty() && crowded[0] < 0 && one_sided[0] < 0; }
};

// All triangles of one part.  Holes are small when discs of their girths have at most a tenth of the part's area: a neck, a wrist, and the
// lower end of a dress form, but not the rim of a sheet or a bowl.
MendedPart mend_part(MendedTriangles& part, std::span<const Vec3> positions);

}  // namespace toile::internal
