// garment/svg_text.hpp: the few elements of SVG that a pattern needs.  Numbers have a point in every locale.
#pragma once
#include "core/types.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

std::string svg_number(double value);      // at most three digits behind the point
std::string svg_point(const Vec2& point);  // "x,y"
// Lines of at most so many letters, broken at spaces.
std::vector<std::string> svg_wrapped(std::string_view text, std::size_t letters);

struct SvgLine {
  std::string_view stroke, fill;
  double width = 0, dash = 0;
};

struct SvgFont {
  double size = 1;
  std::string_view colour;
  bool bold = false, from_left = false;  // else about its middle
};

class SvgText {
 public:
  // `unit` is the size of a small letter's line, for the margin.
  void open(double width, double height, double unit);
  void open_group(std::string_view title);
  void close_group() { text_ += "</g>\n"; }
  void path(std::string_view d, const SvgLine& line);
  void rectangle(const Vec2& corner, const Vec2& size, const SvgLine& line);
  void circle(const Vec2& middle, double radius, std::string_view fill, std::string_view stroke, double width);
  void text(const Vec2& place, std::string_view words, const SvgFont& font);
  const std::string& str() const { return text_; }

 private:
  std::string text_;
};

}  // namespace toile::internal
