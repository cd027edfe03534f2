// toile/types.hpp: numbers as they go in and out.  SI units, which are part of the names; y is up, right-handed.
//
// Arrays of them are read through std::span: a std::vector, a std::array, or memory of somebody else.
#pragma once
#include <array>
#include <cstdint>

namespace toile {

using Point = std::array<double, 3>;       // m, or what the name says
using Uv = std::array<double, 2>;          // of the pattern, m: u along the warp, v along the weft
using Face = std::array<std::int32_t, 3>;  // counter-clockwise, seen from outside, or from the right side of cloth
using CornerUvs = std::array<Uv, 3>;       // of the corners of a face: on both sides of a seam they differ

}  // namespace toile
