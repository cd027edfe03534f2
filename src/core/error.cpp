#include "core/error.hpp"

#include "core/utf8.hpp"

#include <algorithm>
#include <vector>

namespace toile::internal {
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
    : Error(ErrorKind::bad_input, input_message(where, place, expected, got)),
      where_(where),
      place_(place),
      expected_(expected),
      got_(got) {}

InputError::InputError(const std::string& message, const InputError& like)
    : Error(ErrorKind::bad_input, message),
      path_(like.path_),
      where_(like.where_),
      place_(like.place_),
      expected_(like.expected_),
      got_(like.got_) {}

InputError InputError::of(std::string_view path) const {
  InputError error = *this;
  error.path_ = path;
  return error;
}

InputError InputError::within(std::string_view where) const {
  const std::string_view message = what();
  if (message.starts_with(where)) return *this;
  InputError error(std::string(where).append(": ").append(message), *this);
  error.where_ = where_.empty() ? std::string(where) : std::string(where).append(": ").append(where_);
  return error;
}

IoError::IoError(std::string_view path, std::string_view what)
    : Error(ErrorKind::io, printable(path) + ": " + std::string(what)) {}

std::string printable(std::string_view name) {
  constexpr std::size_t limit = 200;
  std::string out;
  std::size_t i = 0;
  while (i < name.size()) {
    const std::size_t bytes = utf8_character_bytes(name.substr(i));
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

std::string alternatives(std::span<const std::string> names) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 == names.size() ? " or " : ", ") + names[k];
  return text;
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

}  // namespace toile::internal
