// rig/same_names.hpp: a clip of one figure for another with nodes of the same names, as programs write a character and its animations in files
// of their own.
#pragma once
#include "rig/clip.hpp"

#include <string_view>

namespace toile::internal {

// Channels of nodes that `to` does not have are left out, and counted; so are those of morph weights unless their number agrees.  Throws
// InputError, with `file` as its place, when nothing is left.
Clip clip_for(const Figure& to, const Clip& clip, const Figure& from, std::string_view file, std::size_t& left_out);

}  // namespace toile::internal
