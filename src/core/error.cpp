#include "core/error.hpp"

#include <algorithm>
#include <vector>

namespace toile {
namespace {

std::string input_message(std::string_view where, std::string_view place, std::string_view expected,
                          std::string_view got) {
  std::string text;
  if (!where.empty()) text.append(where).append(": ");
  if (!place.empty()) text.append(place).append(": ");
  text.append("expected ").append(expected).append(", got ").append(got);
  return text;
}

}  // namespace

InputError::InputError(std::string_view where, std::string_view place, std::string_view expected, std::string_view got)
    : Error(ExitCode::bad_input, input_message(where, place, expected, got)) {}

IoError::IoError(std::string_view path, std::string_view what)
    : Error(ExitCode::io, printable(path) + ": " + std::string(what)) {}

namespace {

// Bytes of the character that begins the text; 0: it is not UTF-8.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t bytes = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (bytes == 1) return 1;
  if (first < 0xc2 || first > 0xf4 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool beyond =
      (first == 0xed && byte(1) > 0x9f) || (first == 0xf4 && byte(1) > 0x8f);  // surrogates, U+110000 ...
  return overlong || beyond ? 0 : bytes;
}

}  // namespace

std::string printable(std::string_view name) {
  constexpr std::size_t limit = 200;
  std::string out;
  std::size_t i = 0;
  while (i < name.size()) {
    const std::size_t bytes = character_bytes(name.substr(i));
    if (i + std::max<std::size_t>(bytes, 1) > limit) break;
    const auto byte = static_cast<unsigned char>(name[i]);
    if (bytes == 0 || byte < 0x20 || byte == 0x7f) {
      out.push_back('?');
      ++i;
    } else {
      out += name.substr(i, bytes);
      i += bytes;
    }
  }
  if (i < name.size()) out += "...";
  return out;
}

std::string_view nearest_name(std::string_view name, const std::string_view* first, std::size_t count) {
  std::string_view best;
  std::size_t best_distance = static_cast<std::size_t>(-1);
  for (std::size_t c = 0; c < count; ++c) {
    const std::string_view other = first[c];
    // Levenshtein distance, one row at a time.
    std::vector<std::size_t> row(other.size() + 1);
    for (std::size_t j = 0; j <= other.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= name.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= other.size(); ++j) {
        const std::size_t above = row[j];
        row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (name[i - 1] == other[j - 1] ? 0 : 1)});
        diagonal = above;
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = other;
    }
  }
  return best;
}

}  // namespace toile
