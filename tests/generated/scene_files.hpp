// tests/generated/scene_files.hpp: the files that generated scenes name: a body and how it moves, a solid, patterns.
#pragma once
#include "generated/draw.hpp"
#include "generated/scene_generator.hpp"

#include <string_view>
#include <vector>

namespace toile::internal::generated {

// A closed egg of 50 vertices, 1.2 m high from y = 0; coordinates in metres, or a hundred times that.
TextFile body_file(const Draw& draw, bool in_cm);
// Samples in which it sways: a .pc2, or a folder of .obj.
inline constexpr int motion_samples = 4;
std::vector<TextFile> motion_files(const Draw& draw, bool in_cm, bool as_obj);

// `scale`: how many times 0.5 m it is wide.
TextFile solid_file(double scale);

// Two panels sewn at both sides, 70 cm wide, around the y axis.  `drawing` is of the axis of that name; `outer`: to be worn over the other;
// `counted`: of a form that can be cut into counted_vertices.
inline constexpr int counted_vertices = 80;
TextFile pattern_file(const Draw& draw, std::string_view drawing, bool outer, bool counted);

}  // namespace toile::internal::generated
