// Stills in memory.
#include "arrays.hpp"
#include "io/scratch.hpp"
#include "preview/png.hpp"
#include "preview/preview.hpp"
#include "toile/run.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>

namespace toile {
namespace {

using Scratch = internal::Scratch;

// Of the header of a PNG.
std::array<std::uint32_t, 2> size_of(const std::string& png) {
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto number = [&](std::size_t at) {
    std::uint32_t n = 0;
    for (std::size_t k = 0; k < 4; ++k) n = n << 8 | static_cast<unsigned char>(png.at(at + k));
    return n;
  };
  return {number(16), number(20)};
}

Simulation sheet() {
  const test::Arrays cloth = test::level_sheet(6, 0.03, 0.16);
  return Simulation(Cloth::from_arrays({.vertices_m = cloth.vertices_m, .faces = cloth.faces}),
                    Body::cylinder({.radius_m = 0.1, .height_m = 0.1, .top_m = {0, 0.1, 0}}));
}

TEST(Picture, OfASimulationIsOfItsStateAndItsViewAlone) {
  if (!internal::can_draw()) GTEST_SKIP() << "built without pictures";
  const PictureOptions small{.width = 60, .height = 40, .samples = 2};
  Simulation sim = sheet();
  const std::string first = picture(sim, small);
  EXPECT_EQ(size_of(first), (std::array<std::uint32_t, 2>{60, 40}));
  EXPECT_EQ(picture(sim, small), first);
  EXPECT_NE(picture(sim, {.width = 60, .height = 40, .azimuth_deg = 115, .samples = 2}), first);
  sim.advance(0.2);
  EXPECT_NE(picture(sim, small), first);
  sim.reset();
  EXPECT_EQ(picture(sim, small), first);
  EXPECT_THROW(picture(sim, {.width = 0}), InputError);
  EXPECT_THROW(picture(sim, {.width = 100000}), InputError);
}

// What a file holds is float32: the pictures are of the same cloth, though not the same bits.
TEST(Picture, OfARunIsThatOfItsLastFrame) {
  if (!internal::can_draw()) GTEST_SKIP() << "built without pictures";
  const Scratch scratch;
  const PictureOptions small{.width = 60, .height = 40, .samples = 2};
  Simulation sim = sheet();
  RunWriter run(scratch / "run", sim, 30);
  const std::string first = picture(scratch / "run", small);
  EXPECT_EQ(size_of(first), (std::array<std::uint32_t, 2>{60, 40}));
  sim.advance(0.2);
  run.add(sim);
  const std::string last = picture(scratch / "run", small);
  EXPECT_NE(last, first) << "before it is finished";
  run.finish();
  EXPECT_EQ(picture(scratch / "run", small), last);
  EXPECT_THROW(picture(scratch / "none", small), IoError);
}

TEST(Picture, OfARunAsInAStudio) {
  if (!internal::can_draw()) GTEST_SKIP() << "built without pictures";
  const Scratch scratch;
  Simulation sim = sheet();
  RunWriter run(scratch / "run", sim, 30);
  sim.advance(1.0 / 30);
  run.add(sim);
  run.finish();
  EXPECT_THROW(preview(scratch / "run", {.style = "oil"}), InputError);
  EXPECT_FALSE(std::filesystem::exists(scratch / "run/preview.png"));
  preview(scratch / "run", {.style = "studio", .close_up_m = Point{0, 0.1, 0}, .film = false});
  EXPECT_EQ(size_of(scratch.get("run/close-up.png")), (std::array<std::uint32_t, 2>{1080, 1080}));
  EXPECT_EQ(size_of(scratch.get("run/preview.png")), (std::array<std::uint32_t, 2>{1918, 1080}));
  EXPECT_FALSE(std::filesystem::exists(scratch / "run/preview.mp4"));
}

TEST(Picture, OfARunInColours) {
  if (!internal::can_draw()) GTEST_SKIP() << "built without pictures";
  const Scratch scratch;
  Simulation sim = sheet();
  RunWriter run(scratch / "run", sim, 30);
  sim.advance(1.0 / 30);
  run.add(sim);
  run.finish();
  const std::string looks = scratch.put(
      "looks.json", R"({"looks": [{"garment": 0, "print": {"stripes": [["#c00000", 20], ["#000000", 20]]}}]})");
  std::string last;
  for (const char* style : {"technical", "studio"}) {
    preview(scratch / "run", {.style = style, .film = false, .looks = looks});
    last = scratch.get("run/preview.png");
    const internal::RgbaImage image = internal::parse_png(last, "preview.png");
    std::size_t red = 0;
    for (std::size_t p = 0; p < image.rgba.size(); p += 4) red += image.rgba[p] > 2 * image.rgba[p + 1] ? 1 : 0;
    EXPECT_GT(red, image.rgba.size() / 4 / 200) << style;  // the sheet is seen flat
  }
  scratch.put("looks.json", R"({"looks": [{"panel": "sleeve", "colour": "#c00000"}]})");
  EXPECT_THROW(preview(scratch / "run", {.film = false, .looks = looks}), InputError);
  EXPECT_THROW(preview(scratch / "run", {.film = false, .looks = scratch / "none.json"}), IoError);
  EXPECT_EQ(scratch.get("run/preview.png"), last);
}

}  // namespace
}  // namespace toile
