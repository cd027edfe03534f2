#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/mesh_formats.hpp"
#include "io/obj.hpp"

namespace toile::internal {
namespace {

// Words of a line, with the number of the line on which each one stands.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ == text_.size(); }
  int line() const { return line_; }

  // The next word of this line, over "\" continuations; empty at the end of the line or at a comment.
  std::string_view next() {
    skip_blanks();
    if (at_end() || is_newline(text_[at_]) || text_[at_] == '#') return {};
    const std::size_t begin = at_;
    while (!at_end() && !is_blank(text_[at_]) && !is_newline(text_[at_]) && continuation() == 0) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  // The rest of this line, trimmed: a name.
  std::string_view rest() {
    while (!at_end() && is_blank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (!at_end() && !is_newline(text_[at_])) ++at_;
    std::size_t end = at_;
    while (end > begin && is_blank(text_[end - 1])) --end;
    return text_.substr(begin, end - begin);
  }

  // Goes to the beginning of the next line.  A comment ends with its line: a path in it may well end in "\".
  void next_line() {
    while (!at_end() && !is_newline(text_[at_])) ++at_;
    at_ += newline(at_);
    if (!at_end()) ++line_;
  }
  // The same for a line whose words do not matter, but whose continuations belong to it.
  void skip_line() {
    while (!next().empty()) {
    }
    next_line();
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_newline(char c) { return c == '\n' || c == '\r'; }

  // Length of the line end at `position`: "\n", "\r\n", "\r"; 0 when there is none.
  std::size_t newline(std::size_t position) const {
    if (position >= text_.size() || !is_newline(text_[position])) return 0;
    return text_.substr(position, 2) == "\r\n" ? 2 : 1;
  }
  // Length of "\" and the line end behind it.
  std::size_t continuation() const {
    if (text_[at_] != '\\') return 0;
    const std::size_t length = newline(at_ + 1);
    return length == 0 ? 0 : 1 + length;
  }
  void skip_blanks() {
    while (!at_end()) {
      if (is_blank(text_[at_])) {
        ++at_;
      } else if (const std::size_t length = continuation()) {
        at_ += length;
        ++line_;
      } else {
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

// Too small for a double, as opposed to too large; `text` is known to be one of the two.
bool underflows(std::string_view text) {
  const std::size_t exponent = text.find_first_of("eE");
  if (exponent != std::string_view::npos) return text.substr(exponent + 1, 1) == "-";
  return text.find_first_of("123456789") > text.find('.');
}

class ObjReader {
 public:
  ObjReader(std::string_view text, std::string_view file) : words_(text), file_(file) {}

  // The first word of the text is a keyword of the format, which has no other mark.
  bool begins_well() {
    std::string_view keyword;
    while (keyword.empty() && !words_.at_end()) {
      keyword = words_.next();
      if (keyword.empty()) words_.next_line();
    }
    return keyword == "v" || keyword == "vt" || keyword == "f" || keyword == "g" || keyword == "o" ||
           is_harmless(keyword);
  }

  SurfaceMesh read() {
    while (!words_.at_end()) read_line();
    check_forward();
    if (mesh_.positions.empty()) fail(words_.line(), "mesh", "at least one vertex", "none");
    if (mesh_.triangles.empty()) fail(words_.line(), "mesh", "at least one face", "none");
    if (!any_texcoord_) mesh_.texcoord = {};
    return std::move(mesh_);
  }

 private:
  struct Corner {
    Index position, texcoord;
  };
  // A corner that names a vertex before the file has defined it.  Rare, and allowed; checked at the end of the file.
  struct Forward {
    int line;
    bool texcoord;
    Index index;  // from 0
  };

  [[noreturn]] void fail(int line, std::string_view place, std::string_view expected, std::string_view got) const {
    throw InputError(printable(file_) + ':' + std::to_string(line), place, expected, got);
  }
  static std::string quoted(std::string_view word) {
    return word.empty() ? "the end of the line" : '"' + printable(word) + '"';
  }

  void read_line() {
    const std::string_view keyword = words_.next();
    if (keyword.empty()) {
      words_.next_line();
    } else if (keyword == "v") {
      read_vertex();
    } else if (keyword == "vt") {
      read_texcoord();
    } else if (keyword == "f") {
      read_face();
    } else if (keyword == "g") {
      group_ = words_.rest();
      current_group_ = -1;
      words_.next_line();
    } else if (keyword == "o") {
      object_ = words_.rest();
      current_object_ = -1;
      words_.next_line();
    } else if (is_harmless(keyword)) {
      words_.skip_line();
    } else {
      fail(words_.line(), "keyword", "v, vt, vn, f, g, o or another keyword of a polygon mesh", quoted(keyword));
    }
  }

  static bool is_harmless(std::string_view keyword) {
    static constexpr std::string_view harmless[] = {"vn",         "vp",        "s",   "usemtl", "mtllib",   "usemap",
                                                    "maplib",     "mg",        "lod", "bevel",  "c_interp", "d_interp",
                                                    "shadow_obj", "trace_obj", "p",   "l"};
    return std::find(std::begin(harmless), std::end(harmless), keyword) != std::end(harmless);
  }

  // "1", "-1.5e-3", "+2."; nothing else may stand in the word.  from_chars ignores the locale.
  double parse_number(std::string_view word, std::string_view place) const {
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range && end == digits.data() + digits.size() && underflows(digits)) return 0;
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
      fail(words_.line(), place, "a finite number", quoted(word));
    }
    return value;
  }

  // At least `required` numbers into `values`; up to `limit` numbers in all.
  void read_numbers(std::string_view place, double* values, int required, int limit) {
    int count = 0;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next(), ++count) {
      if (count == limit) fail(words_.line(), place, "at most " + std::to_string(limit) + " numbers", quoted(word));
      const double value = parse_number(word, place);
      if (count < required) values[count] = value;
    }
    if (count < required) {
      fail(words_.line(), place, std::to_string(required) + " numbers", std::to_string(count));
    }
    words_.next_line();
  }

  void read_vertex() {
    if (mesh_.positions.size() == mesh_vertex_limit) {
      fail(words_.line(), "vertex", "at most " + std::to_string(mesh_vertex_limit) + " vertices", "more");
    }
    Vec3 position;
    read_numbers("vertex", position.data(), 3, 8);  // x y z [w] [r g b [a]]
    mesh_.positions.push_back(position);
  }

  void read_texcoord() {
    if (mesh_.texcoords.size() == 3 * mesh_vertex_limit) {
      fail(words_.line(), "texture coordinate", "at most " + std::to_string(3 * mesh_vertex_limit), "more");
    }
    // u [v [w]]: v is 0 when it is not there.
    const std::string_view first = words_.next();
    Vec2 uv(parse_number(first, "texture coordinate"), 0);
    const std::string_view second = words_.next();
    if (!second.empty()) {
      uv.y() = parse_number(second, "texture coordinate");
      double none = 0;
      read_numbers("texture coordinate", &none, 0, 1);
    } else {
      words_.next_line();
    }
    mesh_.texcoords.push_back(uv);
  }

  // The index in `word`, from 0.  It may lie beyond `count`, the number defined so far, but not below 0.
  Index parse_index(std::string_view word, std::size_t count, bool texcoord) {
    const auto refuse = [&] {
      const std::string range =
          count == 0 ? "an index that exists (none does yet)" : "an index in 1.." + std::to_string(count);
      fail(words_.line(), "face", texcoord ? range + " for the texture coordinate" : range,
           word.empty() ? "nothing" : printable(word));
    };
    long long index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (error != std::errc() || end != word.data() + word.size() || index == 0) refuse();
    const auto defined = static_cast<long long>(count);
    index = index > 0 ? index - 1 : defined + index;
    if (index < 0 || index > std::numeric_limits<Index>::max()) refuse();
    if (index >= defined) forward_.push_back({words_.line(), texcoord, static_cast<Index>(index)});
    return static_cast<Index>(index);
  }

  Corner parse_corner(std::string_view word) {
    const std::size_t slash1 = word.find('/');
    const std::size_t slash2 = slash1 == word.npos ? word.npos : word.find('/', slash1 + 1);
    Corner corner{parse_index(word.substr(0, slash1), mesh_.positions.size(), false), -1};
    if (slash1 == word.npos) return corner;
    const std::string_view texcoord = word.substr(slash1 + 1, slash2 == word.npos ? word.npos : slash2 - slash1 - 1);
    // Some programs write "3/" for a corner without one.
    if (!texcoord.empty()) corner.texcoord = parse_index(texcoord, mesh_.texcoords.size(), true);
    if (slash2 != word.npos && slash2 + 1 < word.size()) {  // the normal: some number
      long long normal = 0;
      const std::string_view digits = word.substr(slash2 + 1);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), normal);
      if (error != std::errc() || end != digits.data() + digits.size() || normal == 0) {
        fail(words_.line(), "face", "an index for the normal", printable(digits));
      }
    }
    return corner;
  }

  void read_face() {
    corners_.clear();
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      corners_.push_back(parse_corner(word));
    }
    if (corners_.size() < 3) {
      fail(words_.line(), "face", "at least 3 corners", std::to_string(corners_.size()));
    }
    if (mesh_.triangles.size() + corners_.size() - 2 > mesh_triangle_limit) {
      fail(words_.line(), "face", "at most " + std::to_string(mesh_triangle_limit) + " triangles", "more");
    }
    if (current_group_ < 0) current_group_ = number_of(group_, groups_, mesh_.group_names);
    if (current_object_ < 0) current_object_ = number_of(object_, objects_, mesh_.object_names);
    for (std::size_t c = 2; c < corners_.size(); ++c) {
      const Corner &c0 = corners_[0], &c1 = corners_[c - 1], &c2 = corners_[c];
      mesh_.triangles.push_back({c0.position, c1.position, c2.position});
      mesh_.texcoord.push_back({c0.texcoord, c1.texcoord, c2.texcoord});
      mesh_.group.push_back(current_group_);
      mesh_.object.push_back(current_object_);
      any_texcoord_ = any_texcoord_ || c0.texcoord >= 0 || c1.texcoord >= 0 || c2.texcoord >= 0;
    }
    words_.next_line();
  }

  static Index number_of(std::string_view name, std::map<std::string, Index, std::less<>>& numbers,
                         std::vector<std::string>& names) {
    const auto [at, is_new] = numbers.try_emplace(std::string(name), static_cast<Index>(names.size()));
    if (is_new) names.emplace_back(name);
    return at->second;
  }

  void check_forward() const {
    for (const Forward& corner : forward_) {
      const std::size_t count = corner.texcoord ? mesh_.texcoords.size() : mesh_.positions.size();
      if (static_cast<std::size_t>(corner.index) < count) continue;
      const std::string_view what = corner.texcoord ? " for the texture coordinate" : "";
      fail(corner.line, "face",
           (count == 0 ? "an index that exists (none does)" : "an index in 1.." + std::to_string(count)).append(what),
           std::to_string(static_cast<long long>(corner.index) + 1));
    }
  }

  Words words_;
  std::string_view file_;
  SurfaceMesh mesh_;
  bool any_texcoord_ = false;
  std::string_view group_, object_;                 // names in force, numbered at their first face
  Index current_group_ = -1, current_object_ = -1;  // their numbers; -1 until then
  std::map<std::string, Index, std::less<>> groups_, objects_;
  std::vector<Corner> corners_;
  std::vector<Forward> forward_;
};

std::string_view without_byte_order_mark(std::string_view text) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);  // of UTF-8
  return text;
}

}  // namespace

SurfaceMesh parse_obj(std::string_view text, std::string_view file) {
  return ObjReader(without_byte_order_mark(text), file).read();
}

SurfaceMesh load_obj(const std::string& path) { return parse_obj(read_file(path), path); }

MeshReader obj_reader() {
  return {"OBJ",
          {".obj"},
          [](std::string_view text) { return ObjReader(without_byte_order_mark(text), "").begins_well(); },
          [](const MeshSource& source) { return parse_obj(source.bytes, source.file); },
          nullptr};
}

}  // namespace toile::internal
