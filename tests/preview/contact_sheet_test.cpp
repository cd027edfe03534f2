#include <gtest/gtest.h>

#include <set>

#include "core/error.hpp"
#include "preview/bitmap_font.hpp"
#include "preview/pictures.hpp"

namespace toile::internal {
namespace {

Image plain(int width, int height, std::uint8_t value) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), value)};
}

TEST(ContactSheet, PlacesPicturesRowByRowWithoutChangingThem) {
  std::vector<Image> images;
  for (int i = 0; i < 5; ++i) images.push_back(plain(50, 30, static_cast<std::uint8_t>(10 + 20 * i)));
  const std::vector<std::string> captions(5, "");
  const Image sheet = contact_sheet(images, captions, 2);
  // Every picture's value is there 50 x 30 times, the first at the top left, the second right of it, the last at the bottom.
  std::vector<int> first_x(5, -1), first_y(5, -1), count(5, 0);
  for (int y = 0; y < sheet.height; ++y) {
    for (int x = 0; x < sheet.width; ++x) {
      for (std::size_t i = 0; i < 5; ++i) {
        if (pixel(sheet, x, y)[0] != images[i].rgb[0]) continue;
        if (count[i]++ == 0) first_x[i] = x, first_y[i] = y;
      }
    }
  }
  for (const int c : count) EXPECT_EQ(c, 50 * 30);
  EXPECT_EQ(first_y[0], first_y[1]);
  EXPECT_GE(first_x[1], first_x[0] + 50);
  EXPECT_EQ(first_x[4], first_x[0]);
  EXPECT_GE(first_y[2], first_y[0] + 30 + glyph_height);  // room for the caption
  EXPECT_GE(first_y[4], first_y[2] + 30 + glyph_height);
}

TEST(ContactSheet, WritesTheCaptionBelowItsPictureAndCutsOneThatIsTooLong) {
  const std::vector<Image> images{plain(60, 30, 200), plain(60, 30, 200)};
  const auto ink = [&](const std::string& left, const std::string& right, bool in_right_half) {
    const Image sheet = contact_sheet(images, std::vector<std::string>{left, right}, 2);
    int count = 0;
    for (int y = 38; y < sheet.height; ++y) {
      for (int x = 0; x < sheet.width; ++x) {
        if ((2 * x > sheet.width) == in_right_half && pixel(sheet, x, y)[0] < 100) ++count;
      }
    }
    return count;
  };
  EXPECT_EQ(ink("", "", false), 0);
  EXPECT_GT(ink("FRONT", "", false), 40);
  EXPECT_EQ(ink("FRONT", "", true), 0);
  EXPECT_EQ(ink("A CAPTION THAT IS MUCH TOO LONG FOR SIXTY PIXELS", "", true), 0);
}

TEST(ContactSheet, RefusesWhatDoesNotFit) {
  const std::vector<Image> images{plain(4, 4, 1), plain(4, 5, 1)};
  const std::vector<std::string> two(2), one(1);
  EXPECT_THROW(contact_sheet(images, two, 2), InputError);
  EXPECT_THROW(contact_sheet(std::span(images).first(1), two, 2), InputError);
  EXPECT_THROW(contact_sheet(std::span(images).first(1), one, 0), InputError);
  EXPECT_THROW(contact_sheet({}, {}, 1), InputError);
}

TEST(BitmapFont, HasADifferentGlyphForEveryPrintableCharacter) {
  std::set<std::array<std::uint8_t, 7>> seen;
  int characters = 0;
  for (char c = ' '; c < 'a'; ++c, ++characters) {
    EXPECT_NE(glyph(c), glyph('\x01')) << c;
    seen.insert(glyph(c));
  }
  EXPECT_EQ(static_cast<int>(seen.size()), characters);
  EXPECT_EQ(glyph('q'), glyph('Q'));
  for (char c = ' '; c < 'a'; ++c) {
    for (const std::uint8_t row : glyph(c)) EXPECT_LT(row, 32);
  }
}

TEST(BitmapFont, CutsTextAtTheEdgesOfTheImage) {
  Image image = plain(10, 6, 0);
  draw_text(image, -3, -2, 2, "W#", {255, 255, 255});
  EXPECT_EQ(image.rgb.size(), 180u);
  EXPECT_GT(std::count(image.rgb.begin(), image.rgb.end(), 255), 0);
}

}  // namespace
}  // namespace toile::internal
