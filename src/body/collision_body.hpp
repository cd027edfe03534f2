// body/collision_body.hpp: the body that cloth collides with: one closed mesh in metres, from any source.
//
// Files differ in unit (GarmentCode: m, MakeHuman: dm, others cm), carry more than the body (MakeHuman's base mesh has clothes helpers and joint
// cubes), and are not always closed, upright or seen from outside: what is mended, turned and left out is said.  The unit is never guessed: metres
// are assumed, and a height that is not possible for a body is an error that names the units that would fit.
#pragma once
#include "body/mannequin.hpp"
#include "body/upright.hpp"
#include "io/surface_mesh.hpp"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace toile::internal {

struct CollisionBody {
  std::vector<Vec3> positions;      // m
  std::vector<Triangle> triangles;  // counter-clockwise from outside
  std::string name;                 // of the file without folder and extension, or "mannequin"
  std::vector<std::string> notes;   // sentences: parts taken despite their names, parts left out
  double height_m = 0;              // extent along y
  // The file's vertex of each, ascending, and what the file had: moving samples of the same file are mapped by these (body_motion.hpp).
  std::vector<Index> source_vertex;
  std::size_t source_vertex_count = 0;
  std::vector<Triangle> source_triangles;
  Mat3 rotation = Mat3::Identity();  // from the file's axes
};

enum class LengthUnit { automatic, m, dm, cm, mm, inch };  // automatic: metres, or an error
inline constexpr std::array<std::pair<std::string_view, LengthUnit>, 5> length_units = {{{"m", LengthUnit::m},
                                                                                         {"dm", LengthUnit::dm},
                                                                                         {"cm", LengthUnit::cm},
                                                                                         {"mm", LengthUnit::mm},
                                                                                         {"in", LengthUnit::inch}}};
double metres_in(LengthUnit unit);
std::string_view to_string(LengthUnit unit);

// Takes and mends the parts that are the body (body_parts.hpp), and turns them to y up and z in front (upright.hpp).  Unused vertices are dropped;
// the others keep their order; of those that are joined, as the sides of a seam, the first stays.
//
// Throws InputError, with `file` as its place, when
//   there are no triangles, an index or a coordinate is none
//   what would be the body cannot be closed: its holes, or the edge at which it is no surface, are named
//   the unit is `automatic` and the height lies outside 0.5 .. 2.5 m: asks for --body-unit and says which units
//   would fit
// With a unit given, every height is accepted: dolls and giants may be dressed.
CollisionBody make_collision_body(const SurfaceMesh& mesh, std::string_view file, LengthUnit unit,
                                  UpAxis up = UpAxis::automatic);

CollisionBody from_mannequin(const Mannequin& mannequin);

}  // namespace toile::internal
