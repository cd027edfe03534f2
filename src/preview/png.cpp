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

RgbaImage parse_png(std::string_view bytes, const std::string& place) {
  constexpr std::string_view expected = "a PNG picture of at most 16,777,216 pixels";
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  const auto refuse = [&] {
    const std::string reason = header.message;
    png_image_free(&header);
    throw InputError(place, "", expected, "libpng's \"" + printable(reason) + '"');
  };
  if (png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) == 0) refuse();
  const std::size_t pixels = std::size_t{header.width} * header.height;
  if (pixels == 0 || pixels > png_pixel_limit) {
    png_image_free(&header);
    throw InputError(place, "", expected, std::to_string(header.width) + " x " + std::to_string(header.height));
  }
  header.format = PNG_FORMAT_RGBA;
  RgbaImage image{static_cast<int>(header.width), static_cast<int>(header.height),
                  std::vector<std::uint8_t>(4 * pixels)};
  if (png_image_finish_read(&header, nullptr, image.rgba.data(), 0, nullptr) == 0) refuse();
  png_image_free(&header);
  return image;
}

void write_png(const std::string& path, const Image& image) {
  const std::string bytes = png_of(image, path);
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace toile::internal
