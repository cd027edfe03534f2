// preview/bitmap_font.hpp: a 5 x 7 font of our own for captions.
#pragma once
#include "preview/preview.hpp"

#include <string_view>

namespace toile::internal {

constexpr int glyph_width = 5, glyph_height = 7, glyph_advance = 6;  // dots

// Seven rows from the top, bit 4 = leftmost dot.  Small letters are drawn as capitals, unknown characters as a box.
const std::array<std::uint8_t, 7>& glyph(char character);

// Draws from the top left corner (x, y) in pixels; a dot is `scale` x `scale` pixels.  Parts outside the image are clipped.
void draw_text(Image& image, int x, int y, int scale, std::string_view text, const std::array<std::uint8_t, 3>& colour);

}  // namespace toile::internal
