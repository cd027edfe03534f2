#include "io/mesh_writer.hpp"

#include "core/error.hpp"
#include "io/mesh_formats.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

namespace toile::internal {
namespace {

class Check {
 public:
  explicit Check(const std::string& path) : path_(path) {}

  // Finite as a float: 1e39 is not.
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

}  // namespace

void check_writable(const std::string& path, const SurfaceMesh& mesh) {
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

std::string name_on_one_line(std::string_view name) {
  std::string line(name);
  for (char& c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = '_';
  }
  return line;
}

std::vector<MeshPiece> pieces_of(const SurfaceMesh& mesh) {
  std::map<Index, std::size_t> objects;                         // in order of first appearance
  std::map<std::pair<std::size_t, Index>, std::size_t> places;  // object's number, group -> piece
  std::vector<MeshPiece> found;
  std::vector<std::size_t> number;  // [piece] of its object
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Index object = mesh.object.empty() ? -1 : mesh.object[t], group = mesh.group.empty() ? -1 : mesh.group[t];
    const std::size_t of_object = objects.try_emplace(object, objects.size()).first->second;
    const auto [place, is_new] = places.try_emplace({of_object, group}, found.size());
    if (is_new) {
      found.push_back({object, group, {}});
      number.push_back(of_object);
    }
    found[place->second].triangles.push_back(t);
  }
  // Those of one object together.
  std::vector<MeshPiece> pieces;
  for (std::size_t object = 0; object < objects.size(); ++object)
    for (std::size_t p = 0; p < found.size(); ++p)
      if (number[p] == object) pieces.push_back(std::move(found[p]));
  return pieces;
}

SplitVertices split_vertices(const SurfaceMesh& mesh, const std::vector<std::size_t>& triangles) {
  SplitVertices split;
  split.has_uv = !mesh.texcoord.empty();
  for (const std::size_t t : triangles)
    for (std::size_t k = 0; k < 3 && split.has_uv; ++k) split.has_uv = mesh.texcoord[t][k] >= 0;
  const auto corner = [&](std::size_t t, std::size_t k) {
    return std::pair<Index, Index>(mesh.triangles[t][k], split.has_uv ? mesh.texcoord[t][k] : -1);
  };
  std::map<std::pair<Index, Index>, Index> numbers;
  for (const std::size_t t : triangles)
    for (std::size_t k = 0; k < 3; ++k) numbers.try_emplace(corner(t, k), -1);
  for (auto& [vertex, number] : numbers) {
    number = static_cast<Index>(split.position.size());
    split.position.push_back(vertex.first);
    split.texcoord.push_back(vertex.second);
  }
  for (const std::size_t t : triangles)
    split.triangles.push_back({numbers.at(corner(t, 0)), numbers.at(corner(t, 1)), numbers.at(corner(t, 2))});
  return split;
}

const std::vector<MeshWriter>& mesh_writers() {
  static const std::vector<MeshWriter> writers = all_mesh_writers();
  return writers;
}

const MeshWriter* mesh_writer_named(std::string_view name) {
  for (const MeshWriter& writer : mesh_writers())
    if (writer.name == name) return &writer;
  return nullptr;
}

const MeshWriter* mesh_writer_for(std::string_view path) {
  for (const MeshWriter& writer : mesh_writers())
    if (path.ends_with(writer.ending)) return &writer;
  return nullptr;
}

std::string mesh_writers_in_words() {
  std::vector<std::string> names;
  for (const MeshWriter& writer : mesh_writers()) names.emplace_back(writer.name);
  return alternatives(names);
}

}  // namespace toile::internal
