// preview/png.hpp: pictures as the bytes of PNG files.
#pragma once
#include "preview/preview.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// Throws InputError for an image whose bytes do not fit its size, and IoError; messages name `place`.
std::string png_of(const Image& image, const std::string& place);

struct RgbaImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // 8-bit sRGB and opacity, row by row from the top
};
constexpr std::size_t png_pixel_limit = std::size_t{1} << 24;  // 4096 x 4096

// Of any kind of PNG; one that says how its colours are to be shown is converted.  Throws InputError about `place`.
RgbaImage parse_png(std::string_view bytes, const std::string& place);

}  // namespace toile::internal
