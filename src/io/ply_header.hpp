// io/ply_header.hpp: the header of a PLY file: its elements, their properties, and where the data begin.
#pragma once
#include "io/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

enum class PlyNumber { i8, u8, i16, u16, i32, u32, f32, f64 };
inline std::size_t bytes_of(PlyNumber n) {
  constexpr std::array<std::size_t, 8> bytes{1, 1, 2, 2, 4, 4, 4, 8};
  return bytes[static_cast<std::size_t>(n)];
}

struct PlyProperty {
  std::string name;
  PlyNumber type = PlyNumber::f32;
  std::optional<PlyNumber> count;  // of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  int line = 0;
  std::vector<PlyProperty> properties;

  // The first property of one of these names; -1: none.
  Index find(std::initializer_list<std::string_view> names) const {
    for (std::size_t k = 0; k < properties.size(); ++k)
      if (std::find(names.begin(), names.end(), properties[k].name) != names.end()) return static_cast<Index>(k);
    return -1;
  }
};

struct PlyHeader {
  enum class Format { ascii, little, big } format = Format::ascii;
  std::vector<PlyElement> elements;
  // From comments "panel 0 front": "panel" -> its numbers.
  std::map<std::string, std::map<Index, std::string>, std::less<>> names;
  std::size_t end = 0;  // where the data begin
  int lines = 0;
};

// Throws InputError with file and line.  Element counts are as declared, not checked against the file's size.
PlyHeader parse_ply_header(const MeshSource& source);

// "nothing", or the text in quotes.
std::string quoted(std::string_view text);

}  // namespace toile::internal
