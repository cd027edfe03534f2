// toile/types.hpp: the types of input and output.  SI units, which are part of the names; y is up, right-handed.
//
// Arrays of them are read through std::span: a std::vector, a std::array, or any other contiguous memory.
#pragma once
#include <array>
#include <cstdint>

namespace toile {

using Point = std::array<double, 3>;       // m, or the unit in the name
using Uv = std::array<double, 2>;          // of the pattern, m: u along the warp, v along the weft
using Face = std::array<std::int32_t, 3>;  // counter-clockwise, seen from outside, or from the right side of cloth
using CornerUvs = std::array<Uv, 3>;       // of the corners of a face: the two sides of a seam differ

enum class LengthUnit {
  automatic,
  m,
  dm,
  cm,
  mm,
  inch
};                                      // automatic: metres, or an error that says which unit would fit
enum class UpAxis { automatic, y, z };  // of a file; automatic: as a person is seen to stand in it

}  // namespace toile
