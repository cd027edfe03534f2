#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/mesh_formats.hpp"
#include "io/obj.hpp"
#include "io/obj_words.hpp"

namespace toile::internal {
namespace {

// Too small for a double, as opposed to too large; `text` is known to be one of the two.
bool underflows(std::string_view text) {
  const std::size_t exponent = text.find_first_of("eE");
  if (exponent != std::string_view::npos) return text.substr(exponent + 1, 1) == "-";
  return text.find_first_of("123456789") > text.find('.');
}

// Lines or words that have no part in the surface and say nothing that can be read: counted, and told in one sentence.
class Skipped {
 public:
  enum Kind : std::size_t { statement, thin_face, texcoord, texcoord_index, kinds };

  void add(Kind kind, int line, std::string_view example = {}) {
    Place& place = places_[kind];
    if (place.count++ == 0) place = {1, line, printable(example)};
  }
  // Empty when nothing was skipped.
  std::string sentence(std::string_view file) const {
    static constexpr std::array<std::string_view, kinds> what = {
        "lines of statements that OBJ does not have", "faces of fewer than three corners",
        "texture coordinates that are no numbers", "texture coordinates of corners that do not exist"};
    std::string list;
    for (std::size_t k = 0; k < kinds; ++k) {
      const Place& place = places_[k];
      if (place.count == 0) continue;
      list += (list.empty() ? "" : ", ") + std::to_string(place.count) + ' ' + std::string(what[k]) + " (line " +
              std::to_string(place.line) + (place.example.empty() ? ")" : ": " + place.example + ")");
    }
    return list.empty() ? list : printable(file) + ": skipped " + list;
  }

 private:
  struct Place {
    std::size_t count = 0;
    int line = 0;  // of the first
    std::string example;
  };
  std::array<Place, kinds> places_;
};

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
    if (std::string note = skipped_.sentence(file_); !note.empty()) mesh_.notes.push_back(std::move(note));
    return std::move(mesh_);
  }

 private:
  struct Corner {
    Index position, texcoord;
  };
  // A corner that names a vertex before the file has defined it.  Rare, and allowed; checked at the end of the file.
  struct Forward {
    int line;
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
    } else if (!begun_ || is_free_form(keyword)) {  // another format, or a shape that would be lost
      fail(words_.line(), "keyword", "v, vt, vn, f, g, o or another keyword of a polygon mesh", quoted(keyword));
    } else {
      skipped_.add(Skipped::statement, words_.line(), keyword);
      words_.skip_line();
    }
    begun_ = begun_ || !keyword.empty();
  }

  static bool is_free_form(std::string_view keyword) {
    return keyword == "curv" || keyword == "curv2" || keyword == "surf";
  }

  static bool is_harmless(std::string_view keyword) {
    static constexpr std::string_view harmless[] = {"vn",         "vp",        "s",   "usemtl", "mtllib",   "usemap",
                                                    "maplib",     "mg",        "lod", "bevel",  "c_interp", "d_interp",
                                                    "shadow_obj", "trace_obj", "p",   "l"};
    return std::find(std::begin(harmless), std::end(harmless), keyword) != std::end(harmless);
  }

  // "1", "-1.5e-3", "+2."; nothing else may stand in the word.  from_chars ignores the locale.
  static std::optional<double> number_in(std::string_view word) {
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end != digits.data() + digits.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range && underflows(digits)) return 0;
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
  }
  double parse_number(std::string_view word, std::string_view place) const {
    if (const auto value = number_in(word)) return *value;
    const bool comma = std::count(word.begin(), word.end(), ',') == 1 && word.find('.') == word.npos;
    fail(words_.line(), place, comma ? "a finite number with a decimal point, not a comma" : "a finite number",
         quoted(word));
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
    // u [v [w]]: v is 0 when it is not there.  A corner with one that is no number has none.
    const int line = words_.line();
    const std::string_view first = words_.next(), second = words_.next();
    const auto u = number_in(first), v = second.empty() ? std::optional(0.0) : number_in(second);
    if (!u || !v) skipped_.add(Skipped::texcoord, line, u ? second : first);
    mesh_.texcoords.push_back(u && v ? Vec2(*u, *v) : Vec2(0, 0));
    is_number_.push_back(u && v ? 1 : 0);
    words_.skip_line();
  }

  // The index in `word`, from 0, of `count` that are defined so far: it may lie beyond them.  Empty for what is none.
  static std::optional<Index> index_in(std::string_view word, std::size_t count) {
    long long index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (error != std::errc() || end != word.data() + word.size() || index == 0) return std::nullopt;
    index = index > 0 ? index - 1 : static_cast<long long>(count) + index;
    if (index < 0 || index > std::numeric_limits<Index>::max()) return std::nullopt;
    return static_cast<Index>(index);
  }

  Index parse_position(std::string_view word) {
    const std::size_t count = mesh_.positions.size();
    const auto index = index_in(word, count);
    if (!index)
      fail(words_.line(), "face",
           count == 0 ? "an index that exists (none does yet)" : "an index in 1.." + std::to_string(count),
           word.empty() ? "nothing" : printable(word));
    if (at(*index) >= count) forward_.push_back({words_.line(), *index});
    return *index;
  }

  // v, v/vt, v//vn, v/vt/vn; what stands for the normal does not matter.
  Corner parse_corner(std::string_view word) {
    const std::size_t slash1 = word.find('/');
    const std::size_t slash2 = slash1 == word.npos ? word.npos : word.find('/', slash1 + 1);
    Corner corner{parse_position(word.substr(0, slash1)), -1};
    if (slash1 == word.npos) return corner;
    const std::string_view texcoord = word.substr(slash1 + 1, slash2 == word.npos ? word.npos : slash2 - slash1 - 1);
    if (texcoord.empty()) return corner;  // some programs write "3/" for a corner without one
    if (const auto index = index_in(texcoord, mesh_.texcoords.size()))
      corner.texcoord = *index;
    else
      skipped_.add(Skipped::texcoord_index, words_.line(), texcoord);
    return corner;
  }

  void read_face() {
    corners_.clear();
    const int line = words_.line();
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      corners_.push_back(parse_corner(word));
    }
    if (corners_.size() < 3) {  // no surface: a line or a point
      skipped_.add(Skipped::thin_face, line);
      words_.next_line();
      return;
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
      face_line_.push_back(line);
    }
    words_.next_line();
  }

  static Index number_of(std::string_view name, std::map<std::string, Index, std::less<>>& numbers,
                         std::vector<std::string>& names) {
    const auto [at, is_new] = numbers.try_emplace(std::string(name), static_cast<Index>(names.size()));
    if (is_new) names.emplace_back(name);
    return at->second;
  }

  // Faces may stand before their vertices: only here is it known what exists.
  void check_forward() {
    for (const Forward& corner : forward_) {
      const std::size_t count = mesh_.positions.size();
      if (at(corner.index) >= count)
        fail(corner.line, "face",
             count == 0 ? "an index that exists (none does)" : "an index in 1.." + std::to_string(count),
             std::to_string(static_cast<long long>(corner.index) + 1));
    }
    any_texcoord_ = false;
    for (std::size_t t = 0; t < mesh_.texcoord.size(); ++t)
      for (Index& index : mesh_.texcoord[t]) {
        if (index >= 0 && at(index) >= mesh_.texcoords.size()) {
          skipped_.add(Skipped::texcoord_index, face_line_[t], std::to_string(static_cast<long long>(index) + 1));
          index = -1;
        } else if (index >= 0 && is_number_[at(index)] == 0) {
          index = -1;
        }
        any_texcoord_ = any_texcoord_ || index >= 0;
      }
  }

  Words words_;
  std::string_view file_;
  SurfaceMesh mesh_;
  bool begun_ = false;  // a statement of the format has been read
  bool any_texcoord_ = false;
  std::string_view group_, object_;                 // names in force, numbered at their first face
  Index current_group_ = -1, current_object_ = -1;  // their numbers; -1 until then
  std::map<std::string, Index, std::less<>> groups_, objects_;
  std::vector<Corner> corners_;
  std::vector<Forward> forward_;
  std::vector<int> face_line_;   // [triangle]
  std::vector<char> is_number_;  // [texture coordinate]
  Skipped skipped_;
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
