// io/obj.hpp: Wavefront OBJ.  Ours, because vertex order, panels and per-corner uv must survive, and hostile files must
// not.
//
// Read: v, vt, f (v, v/vt, v//vn, v/vt/vn; negative indices count back from the last), g, o, "\" at the end of a line.
// Checked and then ignored: normals, colours and weights, materials, smoothing, lines and points.  Refused: free-form
// surfaces and all statements that the format does not have.
//
// Easily missed: `g` and `o` are independent and each holds until the next of its kind; one group name in two objects
// is one group.
#pragma once
#include "io/surface_mesh.hpp"

#include <string>
#include <string_view>

namespace toile::internal {

// Throws IoError or InputError ("body.obj:88213: face: expected an index in 1..12736, got 4000000000").  Lines are
// counted from 1, as in the file.  A degenerate or duplicate face is no error here: mesh/check.hpp judges the surface.
SurfaceMesh parse_obj(std::string_view text, std::string_view file);
SurfaceMesh load_obj(const std::string& path);

// `texcoord`, `group` and `object` may be empty.  Faces are grouped by (object, group) in order of first appearance;
// triangles keep their order within.  Numbers are rounded to float and written so that they read back to the same float
// (9 digits).  Control characters in names become "_".
// Throws IoError, and InputError for arrays that do not fit together or a number that is not finite.
void write_obj(const std::string& path, const SurfaceMesh& mesh);

}  // namespace toile::internal
