#include <gtest/gtest.h>
#include <png.h>

#include "core/error.hpp"
#include "io/scratch.hpp"
#include "preview/preview.hpp"

namespace toile::internal {
namespace {

Image pattern(int width, int height) {
  Image image{width, height, {}};
  for (int i = 0; i < 3 * width * height; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * i / 7 + 13 * i));
  return image;
}

TEST(Png, ComesBackAsItWasWritten) {
  const Scratch scratch;
  const Image image = pattern(37, 23);
  write_png(scratch / "a.png", image);
  EXPECT_EQ(scratch.file_count(), 1u);

  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&header, (scratch / "a.png").c_str()), 0) << header.message;
  EXPECT_EQ(header.width, 37u);
  EXPECT_EQ(header.height, 23u);
  EXPECT_EQ(header.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr), 0) << header.message;
  EXPECT_EQ(rgb, image.rgb);
}

TEST(Png, ReplacesAnOlderPicture) {
  const Scratch scratch;
  write_png(scratch / "a.png", pattern(9, 9));
  const std::string first = scratch.get("a.png");
  write_png(scratch / "a.png", pattern(8, 9));
  EXPECT_NE(scratch.get("a.png"), first);
  EXPECT_EQ(scratch.file_count(), 1u);
}

TEST(Png, AFailureNamesThePathAndLeavesNoFile) {
  const Scratch scratch;
  try {
    write_png(scratch / "missing/a.png", pattern(4, 4));
    FAIL();
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("missing/a.png"), std::string::npos) << e.what();
  }
  std::filesystem::create_directories(scratch / "folder.png/inside");  // cannot be replaced by a file
  EXPECT_THROW(write_png(scratch / "folder.png", pattern(4, 4)), IoError);
  EXPECT_EQ(scratch.file_count(), 1u);
}

TEST(Png, RefusesAnImageWhoseBytesDoNotFitItsSize) {
  const Scratch scratch;
  Image image = pattern(4, 4);
  image.rgb.pop_back();
  EXPECT_THROW(write_png(scratch / "a.png", image), InputError);
  EXPECT_THROW(write_png(scratch / "a.png", {}), InputError);
  EXPECT_THROW(write_png(scratch / "a.png", {-4, -4, std::vector<std::uint8_t>(48)}), InputError);
  EXPECT_EQ(scratch.file_count(), 0u);
}

}  // namespace
}  // namespace toile::internal
