#include "io/obj_replace.hpp"

#include "core/error.hpp"

#include <array>
#include <charconv>
#include <string>

namespace toile::internal {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_newline(char c) { return c == '\n' || c == '\r'; }

// End of the physical line that begins at `begin`, without its line end.
std::size_t line_end(std::string_view text, std::size_t begin) {
  while (begin < text.size() && !is_newline(text[begin])) ++begin;
  return begin;
}

std::size_t after_newline(std::string_view text, std::size_t end) {
  if (end < text.size() && text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n') return end + 2;
  return end < text.size() ? end + 1 : end;
}

std::string_view next_word(std::string_view line, std::size_t& from) {
  while (from < line.size() && is_blank(line[from])) ++from;
  const std::size_t begin = from;
  while (from < line.size() && !is_blank(line[from]) && line[from] != '#') ++from;
  return line.substr(begin, from - begin);
}

double number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

void append(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text += ' ';
  text.append(digits.data(), end);
}

}  // namespace

std::string with_positions(std::string_view text, std::span<const Vec3> positions, std::string_view file) {
  std::string out;
  out.reserve(text.size() + text.size() / 4);
  std::size_t count = 0;
  std::string line;
  for (std::size_t begin = 0; begin < text.size();) {
    // A line and its continuations by "\"; in a comment a "\" means nothing.
    line.clear();
    std::size_t end = line_end(text, begin), from = begin;
    for (;;) {
      const std::string_view piece = text.substr(from, end - from);
      const bool continues = piece.ends_with('\\') && piece.find('#') == std::string_view::npos;
      line += continues ? piece.substr(0, piece.size() - 1) : piece;
      if (!continues || end == text.size()) break;
      line += ' ';
      from = after_newline(text, end);
      end = line_end(text, from);
    }
    const std::size_t next = after_newline(text, end);
    std::size_t at = 0;
    const bool vertex = next_word(line, at) == "v";
    if (vertex && count < positions.size()) {
      const Vec3& p = positions[count];
      const std::string_view x = next_word(line, at), y = next_word(line, at), z = next_word(line, at);
      if (number(x) == p.x() && number(y) == p.y() && number(z) == p.z()) {
        out += text.substr(begin, next - begin);
      } else {
        out += 'v';
        for (const double coordinate : p) append(out, coordinate);
        out += line.substr(at);
        out += text.substr(end, next - end);
      }
    } else {
      out += text.substr(begin, next - begin);
    }
    if (vertex) ++count;
    begin = next;
  }
  if (count != positions.size())
    throw InputError(file, "v", std::to_string(positions.size()) + " lines", std::to_string(count));
  return out;
}

}  // namespace toile::internal
