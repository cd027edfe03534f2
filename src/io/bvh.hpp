// io/bvh.hpp: BVH, the text format of motion capture: a tree of joints (HIERARCHY) and their channels, frame by frame (MOTION).
//
// A joint's turn is the product of its rotation channels in their order, the first outermost, in degrees; position channels stand for its
// OFFSET.  Lengths have no unit.  An End Site is a node without a name.
//
// Keywords in any case; a name is the rest of its line.  Easily missed: the number of frames is taken from the file's data and must be what it says.
#pragma once
#include "rig/figure.hpp"
#include "rig/pose_track.hpp"

#include <string>
#include <string_view>

namespace toile::internal {

struct BvhMotion {
  Figure figure;  // nodes alone; at rest all channels are 0
  PoseTrack track;
};

// Throws InputError with line, expected and got.
BvhMotion parse_bvh(std::string_view text, std::string_view file);
BvhMotion load_bvh(const std::string& path, std::string& text);

// A file whose name ends in .bvh, in lower or upper case.
bool has_bvh_ending(std::string_view path);

}  // namespace toile::internal
