// preview/png.cpp: pictures as PNG files, through libpng.
//
// Mind: libpng's simplified interface reports errors as values; the classic one jumps out of its callbacks, past destructors.
#include "preview/png.hpp"
#include "core/error.hpp"
#include "io/file.hpp"

#include <png.h>

namespace toile::internal {

std::string png_of(const Image& image, const std::string& path) {
  const auto pixels =
      static_cast<std::size_t>(std::max(image.width, 0)) * static_cast<std::size_t>(std::max(image.height, 0));
  if (pixels == 0 || image.rgb.size() != 3 * pixels) {
    throw InputError(path, "picture", "3 bytes for each of at least one pixel",
                     std::to_string(image.rgb.size()) + " bytes for " + std::to_string(image.width) + " x " +
                         std::to_string(image.height));
  }
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;  // 8-bit sRGB

  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  const int written = png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr);
  const std::string reason = header.message;
  png_image_free(&header);
  if (written == 0) throw IoError(path, "cannot encode the picture: " + reason);
  bytes.resize(size);
  return bytes;
}

void write_png(const std::string& path, const Image& image) {
  const std::string bytes = png_of(image, path);
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace toile::internal
