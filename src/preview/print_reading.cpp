// preview/print_reading.cpp: prints as JSON.
#include "preview/print_reading.hpp"

#include "io/file.hpp"
#include "preview/png.hpp"
#include "preview/srgb.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string_view>

namespace toile::internal {
namespace {

constexpr double mm = 1e-3, degree = std::numbers::pi / 180;
constexpr double most_mm = 10000, least_mm = 0.1, farthest_mm = 1e6;
constexpr std::size_t most_bands = 1000, most_picture_bytes = std::size_t{1} << 28;
constexpr double printed_through = 0.25;  // of ink, by eye
constexpr std::array<std::string_view, 4> kinds{"stripes", "check", "dots", "image"};

std::string brief(double x) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

std::vector<Band> bands_in(const Json& value) {
  constexpr std::string_view expected = "bands [colour, width in mm], side by side";
  if (!value.is_array() || value.array().empty()) value.fail(expected, value.describe());
  if (value.array().size() > most_bands)
    value.fail("at most " + std::to_string(most_bands) + " bands", std::to_string(value.array().size()));
  std::vector<Band> bands;
  for (const Json& band : value.array()) {
    if (!band.is_array() || band.array().size() != 2) band.fail("a band [colour, width in mm]", band.describe());
    bands.push_back({colour_in(band.array()[0]), mm * number_between(band.array()[1], least_mm, most_mm)});
  }
  return bands;
}

Dots dots_in(const Json& value) {
  value.allow_only({"colour", "diameter_mm", "spacing_mm"});
  Dots dots;
  dots.colour = colour_in(value.at("colour"));
  dots.diameter_m = mm * number_between(value.at("diameter_mm"), least_mm, most_mm);
  dots.spacing_m = mm * number_between(value.at("spacing_mm"), least_mm, most_mm);
  if (dots.diameter_m > dots.spacing_m)
    value.at("diameter_mm").fail("at most spacing_mm, " + brief(dots.spacing_m / mm), brief(dots.diameter_m / mm));
  return dots;
}

Picture picture_in(const Json& print, const std::string& file, std::vector<std::string>& files) {
  const Json& name = print.at("image");
  if (name.string().empty() || name.string().find('\0') != std::string::npos) name.fail("a path", name.describe());
  const std::string path =
      (std::filesystem::path(file).parent_path() / std::filesystem::path(name.string())).lexically_normal().string();
  RgbaImage image;
  try {
    image = parse_png(read_file(path, most_picture_bytes), printable(path));
  } catch (const InputError& error) {
    name.fail(error.expected(), error.got() + " of " + printable(path));
  } catch (const IoError& error) {
    name.fail("a PNG picture, its path from the folder of this file", error.what());
  }
  files.push_back(path);
  const double width_m = mm * number_between(print.at("width_mm"), least_mm, most_mm);
  const Json* const height = print.find("height_mm");
  const double height_m =
      height ? mm * number_between(*height, least_mm, most_mm) : width_m * image.height / image.width;
  return {Texture(image.width, image.height, image.rgba), Vec2(width_m, height_m)};
}

std::variant<Stripes, Check, Dots, Picture> pattern_in(const Json& print, const std::string& file,
                                                       std::vector<std::string>& files) {
  if (const Json* const bands = print.find("stripes")) return Stripes{Sett(bands_in(*bands))};
  if (const Json* const bands = print.find("check")) return Check{Sett(bands_in(*bands))};
  if (const Json* const dots = print.find("dots")) return dots_in(*dots);
  return picture_in(print, file, files);
}

}  // namespace

double number_between(const Json& value, double least, double most, bool above) {
  const double x = value.number();
  if (!(x >= least && x <= most) || (above && x == least))
    value.fail((above ? "a number above " : "a number of at least ") + brief(least) + " and at most " + brief(most),
               value.describe());
  return x;
}

Vec3f colour_in(const Json& value) {
  constexpr std::string_view expected = "a colour, \"#rrggbb\" or three whole numbers [r, g, b] from 0 to 255, sRGB";
  std::array<int, 3> rgb{};
  if (value.is_string()) {
    const std::string& text = value.string();
    if (text.size() != 7 || text[0] != '#') value.fail(expected, value.describe());
    for (std::size_t k = 0; k < 3; ++k) {
      const char *const begin = text.data() + 1 + 2 * k, *const end = begin + 2;
      const auto [stopped, error] = std::from_chars(begin, end, rgb[k], 16);
      if (error != std::errc() || stopped != end || rgb[k] < 0) value.fail(expected, value.describe());
    }
  } else {
    if (!value.is_array() || value.array().size() != 3) value.fail(expected, value.describe());
    for (std::size_t k = 0; k < 3; ++k) {
      const Json& one = value.array()[k];
      if (!one.is_number()) one.fail("a whole number from 0 to 255", one.describe());
      const double x = one.number();
      if (!(x >= 0 && x <= 255) || x != std::floor(x)) one.fail("a whole number from 0 to 255", one.describe());
      rgb[k] = static_cast<int>(x);
    }
  }
  Vec3f colour;
  for (std::size_t k = 0; k < 3; ++k)
    colour[static_cast<Eigen::Index>(k)] = srgb_decoded(static_cast<float>(rgb[k]) / 255.0f);
  return colour.cwiseMin(whitest);
}

Print print_in(const Json& value, const std::string& file, std::vector<std::string>& files) {
  value.allow_only({"stripes", "check", "dots", "image", "width_mm", "height_mm", "offset_mm", "turn_deg", "through"});
  int given = 0;
  for (const std::string_view kind : kinds) given += value.find(kind) ? 1 : 0;
  if (given != 1)
    value.fail("one of \"stripes\", \"check\", \"dots\", \"image\"",
               given == 0 ? "none of them" : std::to_string(given) + " of them");
  const bool is_image = value.find("image") != nullptr;
  for (const std::string_view key : {"width_mm", "height_mm"})
    if (const Json* const size = value.find(key); size && !is_image)
      size->fail("no size of a picture without \"image\"", size->describe());

  Print print{pattern_in(value, file, files)};
  if (const Json* const offset = value.find("offset_mm")) {
    if (!offset->is_array() || offset->array().size() != 2)
      offset->fail("two numbers [x, y] in mm", offset->describe());
    for (std::size_t k = 0; k < 2; ++k)
      print.offset_m[static_cast<Eigen::Index>(k)] = mm * number_between(offset->array()[k], -farthest_mm, farthest_mm);
  }
  if (const Json* const turn = value.find("turn_deg")) print.turn_rad = degree * number_between(*turn, -360, 360);
  const bool dyed = value.find("stripes") != nullptr || value.find("check") != nullptr;
  const Json* const through = value.find("through");
  print.through = static_cast<float>(through ? number_between(*through, 0, 1) : dyed ? 1 : printed_through);
  return print;
}

}  // namespace toile::internal
