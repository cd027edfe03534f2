// preview/contact_sheet.cpp: several pictures on one sheet, with captions below.
#include "core/error.hpp"
#include "preview/bitmap_font.hpp"

#include <algorithm>

namespace toile::internal {
namespace {

constexpr std::array<std::uint8_t, 3> paper{246, 246, 245}, ink{52, 54, 58};

}  // namespace

Image contact_sheet(std::span<const Image> images, std::span<const std::string> captions, int columns) {
  if (images.empty()) throw InputError("", "contact sheet", "at least one picture", "none");
  if (columns < 1) throw InputError("", "contact sheet: columns", "at least 1", std::to_string(columns));
  if (captions.size() != images.size()) {
    throw InputError("", "contact sheet", "one caption for each of " + std::to_string(images.size()) + " pictures",
                     std::to_string(captions.size()));
  }
  const int width = images[0].width, height = images[0].height;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Image& image = images[i];
    const auto size_of = [](int w, int h) { return std::to_string(w) + " x " + std::to_string(h); };
    const bool fits = image.width == width && image.height == height && width > 0 && height > 0 &&
                      image.rgb.size() == 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (!fits) {
      throw InputError("", "contact sheet: picture " + std::to_string(i),
                       size_of(width, height) + " pixels with all bytes",
                       size_of(image.width, image.height) + " with " + std::to_string(image.rgb.size()) + " bytes");
    }
  }

  // Sizes follow the pictures: letters of about a 30th of the width, and a margin of one letter.
  const int scale = std::clamp(width / 240, 1, 6);
  const int margin = 8 * scale, strip = (glyph_height + 9) * scale;
  const int used_columns = std::min<int>(columns, static_cast<int>(std::min<std::size_t>(images.size(), 1u << 20)));
  const int rows = (static_cast<int>(images.size()) + used_columns - 1) / used_columns;

  Image sheet;
  sheet.width = used_columns * (width + margin) + margin;
  sheet.height = rows * (height + strip) + margin;
  const auto sheet_width = static_cast<std::size_t>(sheet.width);
  sheet.rgb.resize(3 * sheet_width * static_cast<std::size_t>(sheet.height));
  for (std::size_t i = 0; i < sheet.rgb.size(); ++i) sheet.rgb[i] = paper[i % 3];

  const auto letters = static_cast<std::size_t>(std::max(0, (width + scale) / (glyph_advance * scale)));
  for (std::size_t i = 0; i < images.size(); ++i) {
    const int column = static_cast<int>(i) % used_columns, row = static_cast<int>(i) / used_columns;
    const int left = margin + column * (width + margin), top = margin + row * (height + strip);
    for (int y = 0; y < height; ++y) {
      const auto from = images[i].rgb.begin() + std::ptrdiff_t{3} * y * width;
      const std::size_t to = 3 * (static_cast<std::size_t>(top + y) * sheet_width + static_cast<std::size_t>(left));
      std::copy(from, from + std::ptrdiff_t{3} * width, sheet.rgb.begin() + static_cast<std::ptrdiff_t>(to));
    }
    std::string caption = captions[i];
    if (caption.size() > letters) caption = letters > 2 ? caption.substr(0, letters - 2) + ".." : "";
    const int text_width = static_cast<int>(caption.size()) * glyph_advance * scale - scale;
    draw_text(sheet, left + (width - text_width) / 2, top + height + 4 * scale, scale, caption, ink);
  }
  return sheet;
}

}  // namespace toile::internal
