// body/body_parts.hpp: which parts of a file are the body, mended where they need it.                             docs/scenes.md#mended
//
// Parts hang together by vertices.  Of the closed ones the body is the one that encloses most and those that enclose at least 0.3 % as much (a
// hand stays, eyeballs go), without those inside another.  A group or object named `body` (in any case) stands for the parts that it lies
// in, and others are left out, if these are about as long as everything.
//
// A part with a twentieth of the largest one's area or of all triangles is mended (mesh/triangle_repair.hpp).  What is still open is left out if the rest is about as
// long without it, as a cloak is; else the body is refused.  All that is done and all that is left out is said.
#pragma once
#include "io/surface_mesh.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// Of a solid that is an open sheet: four times cloth's offset of 2.5 mm, so that what is pressed into its front stays nearer to it than to the back.
inline constexpr double sheet_thickness_m = 0.01;

struct BodyParts {
  std::vector<Triangle> triangles;  // of the file's vertices; facing outwards
  std::vector<Triangle> sheets;     // of a solid's parts that are open: their front, to be thickened
  std::vector<std::string> notes;   // sentences
};

// `unit_m` scales lengths in messages.  Corners must be in range, positions finite.
// Throws InputError, with `file` as its place, for what cannot be closed: the holes of the largest part, or an edge.
BodyParts body_parts(const SurfaceMesh& mesh, std::string_view file, double unit_m);

// All parts of a solid, mended likewise, none left out; with holes too large for a cap a part is a sheet.  Throws InputError as above, for the first
// that is no surface.
BodyParts solid_parts(const SurfaceMesh& mesh, std::string_view file, double unit_m);

}  // namespace toile::internal
