// preview/png.hpp: a picture as the bytes of a PNG file.
#pragma once
#include "preview/preview.hpp"

#include <string>

namespace toile::internal {

// Throws InputError for an image whose bytes do not fit its size, and IoError; messages name `place`.
std::string png_of(const Image& image, const std::string& place);

}  // namespace toile::internal
