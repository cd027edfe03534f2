#include "io/ply_header.hpp"

#include <charconv>

#include "core/error.hpp"

namespace toile::internal {
namespace {

std::optional<PlyNumber> number_type(std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> names{{{"char", "int8"},
                                                                  {"uchar", "uint8"},
                                                                  {"short", "int16"},
                                                                  {"ushort", "uint16"},
                                                                  {"int", "int32"},
                                                                  {"uint", "uint32"},
                                                                  {"float", "float32"},
                                                                  {"double", "float64"}}};
  for (std::size_t k = 0; k < names.size(); ++k)
    if (word == names[k][0] || word == names[k][1]) return static_cast<PlyNumber>(k);
  return std::nullopt;
}

// The words of one line.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    at = std::min(line.find_first_not_of(" \t", at), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    if (end > at) words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

class HeaderReader {
 public:
  explicit HeaderReader(const MeshSource& source) : bytes_(source.bytes), file_(source.file) {}

  PlyHeader read() {
    if (const std::string_view magic = line(); magic != "ply") fail("header", "\"ply\"", quoted(magic));
    bool format = false;
    for (;;) {
      if (at_ >= bytes_.size()) fail("header", "\"end_header\"", "the end of the file");
      const std::string_view text = line();
      const std::vector<std::string_view> words = words_of(text);
      if (words.empty() || words[0] == "obj_info") continue;
      if (words[0] == "comment") {
        read_comment(words);
      } else if (words[0] == "format") {
        format = read_format(words);
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      } else if (words[0] == "end_header") {
        break;
      } else {
        fail("header", "format, element, property, comment, obj_info or end_header", quoted(words[0]));
      }
    }
    if (!format) fail("header", "a line \"format\"", "none");
    header_.end = at_;
    header_.lines = line_;
    return std::move(header_);
  }

 private:
  static constexpr std::size_t element_limit = 64, property_limit = 256;  // many more than any program writes

  [[noreturn]] void fail(std::string_view place, std::string_view expected, std::string_view got) const {
    throw InputError(file_ + ':' + std::to_string(line_), place, expected, got);
  }

  // "\n", "\r\n" or "\r" ends it.
  std::string_view line() {
    ++line_;
    const std::size_t end = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    const std::string_view text = bytes_.substr(at_, end - at_);
    at_ = end + (bytes_.substr(end, 2) == "\r\n" ? 2 : end < bytes_.size() ? 1 : 0);
    return text;
  }

  void read_comment(const std::vector<std::string_view>& words) {
    if (words.size() < 4 || (words[1] != "panel" && words[1] != "garment")) return;
    Index number = 0;
    const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), number);
    if (error != std::errc() || end != words[2].data() + words[2].size()) return;
    const char* const name_end = words.back().data() + words.back().size();
    header_.names[std::string(words[1])].try_emplace(
        number, std::string(words[3].data(), static_cast<std::size_t>(name_end - words[3].data())));
  }

  bool read_format(const std::vector<std::string_view>& words) {
    using Format = PlyHeader::Format;
    const std::string_view kind = words.size() > 1 ? words[1] : "";
    if (kind != "ascii" && kind != "binary_little_endian" && kind != "binary_big_endian")
      fail("format", "ascii, binary_little_endian or binary_big_endian", quoted(kind));
    if (words.size() < 3 || words[2] != "1.0")
      fail("format", "version 1.0", words.size() < 3 ? "none" : quoted(words[2]));
    header_.format = kind == "ascii" ? Format::ascii : kind == "binary_big_endian" ? Format::big : Format::little;
    return true;
  }

  void read_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("element", "a name and a number", std::to_string(words.size() - 1) + " words");
    if (header_.elements.size() == element_limit)
      fail("element", "at most " + std::to_string(element_limit) + " kinds", "more");
    PlyElement element;
    element.name = words[1];
    element.line = line_;
    const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (error != std::errc() || end != words[2].data() + words[2].size())
      fail("element " + printable(words[1]), "a number of them", quoted(words[2]));
    header_.elements.push_back(std::move(element));
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("property", "an element before it", "none");
    PlyElement& element = header_.elements.back();
    if (element.properties.size() == property_limit)
      fail("property", "at most " + std::to_string(property_limit) + " of an element", "more");
    const bool list = words.size() > 1 && words[1] == "list";
    if (words.size() != (list ? 5U : 3U))
      fail("property", list ? "list, two types and a name" : "a type and a name",
           std::to_string(words.size() - 1) + " words");
    const auto type = [&](std::string_view word) {
      const std::optional<PlyNumber> known = number_type(word);
      if (!known) fail("property", "a type: char, uchar, short, ushort, int, uint, float or double", quoted(word));
      return *known;
    };
    PlyProperty property;
    property.name = words.back();
    property.type = type(words[words.size() - 2]);
    if (list) {
      property.count = type(words[2]);
      if (*property.count >= PlyNumber::f32)
        fail("property", "a whole number for the length of a list", quoted(words[2]));
    }
    element.properties.push_back(std::move(property));
  }

  std::string_view bytes_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 0;
  PlyHeader header_;
};

}  // namespace

std::string quoted(std::string_view text) { return text.empty() ? "nothing" : '"' + printable(text) + '"'; }

PlyHeader parse_ply_header(const MeshSource& source) { return HeaderReader(source).read(); }

}  // namespace toile::internal
