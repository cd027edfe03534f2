// body/collision_body.hpp: the body that cloth collides with: one closed mesh in metres, whoever made it.
//
// Files differ in unit (GarmentCode: m, MakeHuman: dm, others cm) and carry more than the body (MakeHuman's base
// mesh has clothes helpers and joint cubes).  The unit is never guessed: metres are taken, and a height that no
// body has is an error that names the unit that would fit.
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
  std::string name;                 // of the file without folder and ending, or "mannequin"
  std::vector<std::string> notes;   // sentences: what was taken beyond what its name says, what was left out
  double height_m = 0;              // extent along y
  // Where vertices and triangles stood in the file, ascending, and how many it has: moving samples of the same file
  // are mapped by these (body_motion.hpp).
  std::vector<Index> source_vertex, source_triangle;
  std::size_t source_vertex_count = 0, source_triangle_count = 0;
};

enum class LengthUnit { automatic, m, dm, cm };  // automatic: metres, or an error
double metres_in(LengthUnit unit);

// Vertices that the file had to split along seams of its drawing are one (mesh/join_sides.hpp); the first of them is the source.
// Keeps the body and drops what is not: the group or object named `body` (in any case) if there is one, otherwise,
// of the connected parts that are closed, the one that encloses most and those that enclose at least a tenth as
// much (a separate head stays, eyeballs go). Where what is named so is open, the closed parts that it belongs to are taken (a head in a group
// of its own), and a note says so; another says what closed part of a tenth of its volume is left beside it. Vertices that nobody uses go
// too; the others keep their order.
//
// Throws InputError, with `file` as its place, when
//   there are no triangles, or the body is not closed: the first bad edge or vertex is named
//   [mesh/check.hpp]
//   the unit is `automatic` and the height lies outside 0.5 .. 2.5 m: asks for --body-unit and says which unit
//   would fit
// With a unit given, every height is taken: dolls and giants may be dressed.
CollisionBody make_collision_body(const SurfaceMesh& read, std::string_view file, LengthUnit unit);

CollisionBody from_mannequin(const Mannequin& mannequin);

}  // namespace toile::internal
