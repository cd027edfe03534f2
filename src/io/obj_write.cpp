#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <tuple>

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/obj.hpp"

namespace toile::internal {
namespace {

// A text on its way to the file, in large pieces.
class ObjText {
 public:
  explicit ObjText(AtomicFile& file) : file_(file) {}

  void word(std::string_view text) { text_ += text; }
  // "%.9g" of the float, in every locale.
  void number(double value) {
    char digits[32];
    const auto end =
        std::to_chars(digits, digits + sizeof digits, static_cast<float>(value), std::chars_format::general, 9).ptr;
    text_.append(digits, end);
  }
  void index(Index from_zero) { text_ += std::to_string(from_zero + 1); }
  // A name cannot end its line or go on in the next one.
  void name(std::string_view text) {
    const std::size_t begin = text_.size();
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      text_ += byte < 0x20 || byte == 0x7f ? '_' : c;
    }
    if (text_.size() > begin && text_.back() == '\\') text_.back() = '_';
  }
  void end_line() {
    text_ += '\n';
    if (text_.size() > (std::size_t{1} << 20)) flush();
  }
  void flush() {
    file_.write(text_);
    text_.clear();
  }

 private:
  AtomicFile& file_;
  std::string text_;
};

class Check {
 public:
  explicit Check(const std::string& path) : path_(path) {}

  // `finite` as a float: 1e39 is not.
  void number(std::string_view kind, std::size_t i, double value) const {
    if (!std::isfinite(static_cast<float>(value))) {
      char digits[32];
      throw InputError(printable(path_), std::string(kind) + ' ' + std::to_string(i), "a number that a float can hold",
                       std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr));
    }
  }
  void count(std::string_view what, std::size_t expected, std::size_t got) const {
    if (expected != got) {
      throw InputError(printable(path_), what, std::to_string(expected) + " entries", std::to_string(got));
    }
  }
  void index(std::string_view what, std::size_t t, Index lowest, std::size_t count, Index got) const {
    if (got < lowest || (got >= 0 && static_cast<std::size_t>(got) >= count)) {
      throw InputError(printable(path_), "triangle " + std::to_string(t),
                       std::string(what) + " below " + std::to_string(count), std::to_string(got));
    }
  }

 private:
  const std::string& path_;
};

void check(const std::string& path, const ObjMesh& mesh) {
  const Check check(path);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (const double x : mesh.positions[i]) check.number("vertex", i, x);
  }
  for (std::size_t i = 0; i < mesh.texcoords.size(); ++i) {
    for (const double x : mesh.texcoords[i]) check.number("texture coordinate", i, x);
  }
  const std::size_t count = mesh.triangles.size();
  if (!mesh.texcoord.empty()) check.count("texcoord", count, mesh.texcoord.size());
  if (!mesh.group.empty()) check.count("group", count, mesh.group.size());
  if (!mesh.object.empty()) check.count("object", count, mesh.object.size());
  for (std::size_t t = 0; t < count; ++t) {
    for (const Index i : mesh.triangles[t]) check.index("a vertex", t, 0, mesh.positions.size(), i);
    if (!mesh.texcoord.empty()) {
      for (const Index i : mesh.texcoord[t]) check.index("a texture coordinate", t, -1, mesh.texcoords.size(), i);
    }
    if (!mesh.group.empty()) check.index("a group", t, 0, mesh.group_names.size(), mesh.group[t]);
    if (!mesh.object.empty()) check.index("an object", t, 0, mesh.object_names.size(), mesh.object[t]);
  }
}

// Where a triangle goes: its object and its group within that, each numbered in order of first appearance.
struct Placed {
  std::size_t object, group, triangle;
};

std::vector<Placed> placed_triangles(const ObjMesh& mesh) {
  std::map<Index, std::size_t> objects;
  std::map<std::pair<Index, Index>, std::size_t> groups;
  std::vector<Placed> placed(mesh.triangles.size());
  for (std::size_t t = 0; t < placed.size(); ++t) {
    const Index object = mesh.object.empty() ? 0 : mesh.object[t];
    const Index group = mesh.group.empty() ? 0 : mesh.group[t];
    placed[t].object = objects.try_emplace(object, objects.size()).first->second;
    placed[t].group = groups.try_emplace({object, group}, groups.size()).first->second;
    placed[t].triangle = t;
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& l, const Placed& r) {
    return std::tie(l.object, l.group, l.triangle) < std::tie(r.object, r.group, r.triangle);
  });
  return placed;
}

}  // namespace

void write_obj(const std::string& path, const ObjMesh& mesh) {
  check(path, mesh);
  const std::vector<Placed> placed = placed_triangles(mesh);
  AtomicFile file(path);
  ObjText text(file);

  const auto write_object = [&](std::size_t t) {
    text.word("o ");
    text.name(mesh.object_names[static_cast<std::size_t>(mesh.object[t])]);
    text.end_line();
  };
  // Programs that read one object per `o` expect its vertices behind it.
  const bool one_object = !placed.empty() && placed.front().object == placed.back().object;
  if (one_object && !mesh.object.empty()) write_object(0);

  for (const Vec3& x : mesh.positions) {
    text.word("v");
    for (const double coordinate : x) {
      text.word(" ");
      text.number(coordinate);
    }
    text.end_line();
  }
  for (const Vec2& uv : mesh.texcoords) {
    text.word("vt");
    for (const double coordinate : uv) {
      text.word(" ");
      text.number(coordinate);
    }
    text.end_line();
  }
  for (std::size_t p = 0; p < placed.size(); ++p) {
    const std::size_t t = placed[p].triangle;
    const bool new_object = p == 0 || placed[p].object != placed[p - 1].object;
    if (new_object && !one_object) write_object(t);
    if (!mesh.group.empty() && (new_object || placed[p].group != placed[p - 1].group)) {
      text.word("g ");
      text.name(mesh.group_names[static_cast<std::size_t>(mesh.group[t])]);
      text.end_line();
    }
    text.word("f");
    for (std::size_t corner = 0; corner < 3; ++corner) {
      text.word(" ");
      text.index(mesh.triangles[t][corner]);
      if (!mesh.texcoord.empty() && mesh.texcoord[t][corner] >= 0) {
        text.word("/");
        text.index(mesh.texcoord[t][corner]);
      }
    }
    text.end_line();
  }
  text.flush();
  file.commit();
}

}  // namespace toile::internal
