// io/obj.hpp: Wavefront OBJ.  Ours, because vertex order, panels and per-corner uv must survive, and hostile files must
// not.
//
// Read: v, vt, f (v, v/vt, v//vn, v/vt/vn; negative indices count back from the last), g, o, "\" at the end of a line.
// Checked and then ignored: normals, colours and weights, materials, smoothing, lines and points.  Refused: free-form
// surfaces and whatever else the format does not have.
//
// Easily missed: `g` and `o` are independent and each holds until the next of its kind; one group name in two objects
// is one group.
#pragma once
#include "core/types.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct ObjMesh {
  std::vector<Vec3> positions;  // as in the file, no unit conversion
  std::vector<Vec2> texcoords;
  std::vector<Triangle> triangles;             // polygons are split into fans
  std::vector<std::array<Index, 3>> texcoord;  // [triangle][corner], -1 where the face has none; empty when no face has
  std::vector<Index> group;                    // [triangle] index into group_names
  std::vector<std::string> group_names;        // `g` names that have faces, in order of appearance ("" before any)
  std::vector<Index> object;                   // [triangle] index into object_names
  std::vector<std::string> object_names;       // `o` names that have faces, likewise
};

// More than this in one file is an InputError.
constexpr std::size_t obj_vertex_limit = 20'000'000;
constexpr std::size_t obj_triangle_limit = 40'000'000;

// Throws IoError or InputError ("body.obj:88213: face: expected an index in 1..12736, got 4000000000").  Lines are
// counted from 1, as in the file.  A degenerate or duplicate face is no error here: mesh/check.hpp judges the surface.
ObjMesh parse_obj(std::string_view text, std::string_view file);
ObjMesh load_obj(const std::string& path);

// `texcoord`, `group` and `object` may be empty.  Faces are grouped by (object, group) in order of first appearance;
// triangles keep their order within.  Numbers are rounded to float and written so that they read back to the same float
// (9 digits).  Control characters in names become "_".
// Throws IoError, and InputError for arrays that do not fit together or a number that is not finite.
void write_obj(const std::string& path, const ObjMesh& mesh);

}  // namespace toile::internal
