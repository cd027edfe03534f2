// preview/png.hpp: a picture as the bytes of a PNG file.
#pragma once
#include "preview/preview.hpp"

#include <string>

namespace toile::internal {

// `place` is named by what is thrown: InputError for an image whose bytes do not fit its size, IoError.
std::string png_of(const Image& image, const std::string& place);

}  // namespace toile::internal
