// body/upright.hpp: which way up a body stands in its file, and which way it faces.                               docs/scenes.md#axes
//
// Toile's bodies stand along +y and face +z.  What is seen of a person:
//   lying in y     its extent along y is the least, and less than half of that along z, which is then its height: z is up
//   upside down    sections at 80, 85 and 90 % of the height are two curves alike, legs, and one at 10 % is one, the head
//   its face       both feet reach nearly twice as far from the ankle that way as the other
// What is not clear is not said: a ball has no axes.
#pragma once
#include "core/types.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace toile::internal {

enum class UpAxis { automatic, y, z };  // of a file
inline constexpr std::array<std::pair<std::string_view, UpAxis>, 2> up_axes = {{{"y", UpAxis::y}, {"z", UpAxis::z}}};

struct Turned {
  Mat3 rotation = Mat3::Identity();  // to Toile's axes
  std::vector<std::string> notes;    // half sentences: what was found and done
};

// `positions` of a closed surface, in any unit.  With an axis given, nothing but that is turned.
Turned upright(std::span<const Vec3> positions, std::span<const Triangle> triangles, UpAxis up);

// (x, y, z) -> (x, z, -y)
Mat3 z_up_to_y_up();

}  // namespace toile::internal
