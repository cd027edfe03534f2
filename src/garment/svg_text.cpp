#include "garment/svg_text.hpp"

#include <charconv>
#include <cmath>

namespace toile::internal {
namespace {

// Text between tags: XML's special characters are escaped; control characters are not allowed in XML.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += ' ';
    } else {
      out += c;
    }
  }
  return out;
}

std::string attribute(std::string_view name, std::string_view value) {
  return std::string(" ").append(name).append("=\"").append(escaped(value)).append("\"");
}

}  // namespace

std::string svg_number(double value) {
  if (!std::isfinite(value)) value = 0;
  const double rounded = std::round(value * 1000) / 1000;
  char buffer[400];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, rounded == 0 ? 0.0 : rounded, std::chars_format::fixed, 3).ptr;
  std::string text(buffer, end);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string svg_point(const Vec2& point) { return svg_number(point.x()).append(",").append(svg_number(point.y())); }

std::vector<std::string> svg_wrapped(std::string_view text, std::size_t letters) {
  std::vector<std::string> lines;
  while (text.size() > letters) {
    std::size_t cut = text.rfind(' ', letters);
    if (cut == std::string_view::npos || cut == 0) {
      cut = letters;
      while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xc0) == 0x80) --cut;  // not within a character
      if (cut == 0) break;
    }
    lines.emplace_back(text.substr(0, cut));
    text.remove_prefix(cut);
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  }
  lines.emplace_back(text);
  return lines;
}

void SvgText::open(double width, double height, double unit) {
  const double margin = 2 * unit;
  const std::string w = svg_number(width + 2 * margin), h = svg_number(height + 2 * margin);
  text_ += "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"";
  text_ += attribute("width", w + "cm") + attribute("height", h + "cm");
  text_ += attribute("viewBox", svg_number(-margin) + " " + svg_number(-margin) + " " + w + " " + h);
  text_ += " font-family=\"sans-serif\" style=\"max-width:100%;max-height:100vh\">\n<rect";
  text_ += attribute("x", svg_number(-margin)) + attribute("y", svg_number(-margin)) + attribute("width", w) +
           attribute("height", h) + " fill=\"#ffffff\"/>\n";
}

void SvgText::open_group(std::string_view title) {
  text_.append("<g><title>").append(escaped(title)).append("</title>\n");
}

void SvgText::path(std::string_view d, const SvgLine& line) {
  text_ += std::string("<path") + attribute("d", d) + attribute("fill", line.fill) + attribute("stroke", line.stroke);
  if (line.width > 0)
    text_ += attribute("stroke-width", svg_number(line.width)) + " stroke-linecap=\"round\" stroke-linejoin=\"round\"";
  if (line.dash > 0) text_ += attribute("stroke-dasharray", svg_number(line.dash));
  text_ += "/>\n";
}

void SvgText::rectangle(const Vec2& corner, const Vec2& size, const SvgLine& line) {
  text_ += "<rect" + attribute("x", svg_number(corner.x())) + attribute("y", svg_number(corner.y())) +
           attribute("width", svg_number(size.x())) + attribute("height", svg_number(size.y())) +
           attribute("fill", line.fill) + attribute("stroke", line.stroke) +
           attribute("stroke-width", svg_number(line.width));
  if (line.dash > 0) text_ += attribute("stroke-dasharray", svg_number(line.dash));
  text_ += "/>\n";
}

void SvgText::circle(const Vec2& middle, double radius, std::string_view fill, std::string_view stroke, double width) {
  text_ += "<circle" + attribute("cx", svg_number(middle.x())) + attribute("cy", svg_number(middle.y())) +
           attribute("r", svg_number(radius)) + attribute("fill", fill) + attribute("stroke", stroke);
  if (width > 0) text_ += attribute("stroke-width", svg_number(width));
  text_ += "/>\n";
}

void SvgText::text(const Vec2& place, std::string_view words, const SvgFont& font) {
  // About its middle: capitals are 0.7 of a font's size high.  `dominant-baseline` is not understood everywhere.
  text_ += "<text" + attribute("x", svg_number(place.x())) + attribute("y", svg_number(place.y() + 0.35 * font.size)) +
           attribute("font-size", svg_number(font.size)) + attribute("fill", font.colour);
  if (font.bold) text_ += " font-weight=\"bold\"";
  if (!font.from_left) text_ += " text-anchor=\"middle\"";
  text_.append(">").append(escaped(words)).append("</text>\n");
}

}  // namespace toile::internal
