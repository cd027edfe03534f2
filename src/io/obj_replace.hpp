// io/obj_replace.hpp: a Wavefront OBJ with other positions and everything else as it is: quads, names, uv, materials,
// comments, line ends.
//
// Easily missed: `vn` lines stay too, and then belong to the old shape.
#pragma once
#include "core/types.hpp"

#include <span>
#include <string>
#include <string_view>

namespace toile::internal {

// The text with the k-th `v` line holding positions[k], written so that it reads back to the same double; the rest of
// such a line (weight, colour) stays.  A position equal to the file's leaves its line as it is.
// `text` must be valid for parse_obj (io/obj.hpp).  Throws InputError, naming `file`, when the number of `v` lines is
// not that of the positions.
std::string with_positions(std::string_view text, std::span<const Vec3> positions, std::string_view file);

}  // namespace toile::internal
