// body/collision_body.hpp: the body that cloth collides with: one closed mesh in metres, from any source.
//
// Files differ in unit (GarmentCode: m, MakeHuman: dm, others cm) and carry more than the body (MakeHuman's base
// mesh has clothes helpers and joint cubes).  The unit is never guessed: metres are assumed, and a height that is not
// possible for a body is an error that names the unit that would fit.
#pragma once
#include "body/mannequin.hpp"
#include "io/surface_mesh.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct CollisionBody {
  std::vector<Vec3> positions;      // m
  std::vector<Triangle> triangles;  // counter-clockwise from outside
  std::string name;                 // of the file without folder and extension, or "mannequin"
  std::vector<std::string> notes;   // sentences: parts taken despite their names, parts left out
  double height_m = 0;              // extent along y
  // Indices of vertices and triangles in the file, ascending, and the file's number of vertices: moving samples of the same
  // file are mapped by these (body_motion.hpp).
  std::vector<Index> source_vertex, source_triangle;
  std::size_t source_vertex_count = 0, source_triangle_count = 0;
};

enum class LengthUnit { automatic, m, dm, cm };  // automatic: metres, or an error
double metres_in(LengthUnit unit);

// Vertices that the file had to split along texture seams are joined (mesh/join_sides.hpp); the first of them is the source.
// Keeps the body and drops the rest: the group or object named `body` (in any case) if there is one, otherwise,
// of the closed connected components, the one that encloses most and those that enclose at least a tenth as much
// (a separate head stays, eyeballs go).  If the part named `body` is open, the closed components that it belongs to are taken (a head in a group
// of its own), with a note; another note names closed components of a tenth of its volume that are left out.  Unused vertices are dropped;
// the others keep their order.
//
// Throws InputError, with `file` as its place, when
//   there are no triangles, or the body is not closed: the first bad edge or vertex is named
//   [mesh/check.hpp]
//   the unit is `automatic` and the height lies outside 0.5 .. 2.5 m: asks for --body-unit and says which unit
//   would fit
// With a unit given, every height is accepted: dolls and giants may be dressed.
CollisionBody make_collision_body(const SurfaceMesh& read, std::string_view file, LengthUnit unit);

CollisionBody from_mannequin(const Mannequin& mannequin);

}  // namespace toile::internal
