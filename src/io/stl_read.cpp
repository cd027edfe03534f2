// io/stl_read.cpp: STL, ascii and binary.
//
// It has triangles alone, without vertices that they share: corners at one place become one vertex, in the order in which places appear.  Normals
// are ignored: the order of the corners says which side is outside.  Names of solids are groups.
//
// Easily missed: binary files may begin with "solid", too.  A file of exactly the size that its count gives is binary.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <tuple>

#include "core/error.hpp"
#include "io/mesh_formats.hpp"

namespace toile::internal {
namespace {

constexpr std::size_t header_bytes = 80, count_bytes = 4, facet_bytes = 50;

std::uint32_t little_endian(std::string_view bytes, std::size_t from) {
  std::uint32_t value = 0;
  for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[from + k]);
  return value;
}

bool is_binary(std::string_view bytes) {
  return bytes.size() >= header_bytes + count_bytes && (bytes.size() - header_bytes - count_bytes) % facet_bytes == 0 &&
         (bytes.size() - header_bytes - count_bytes) / facet_bytes == little_endian(bytes, header_bytes);
}

std::string_view first_word(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  return text.substr(begin, std::min(text.find_first_of(" \t\r\n", begin), text.size()) - begin);
}

// Triangles of corners as they come; join() gives them vertices.
class Corners {
 public:
  void add(const Vec3& corner) { positions_.push_back(corner); }
  void add_triangle_of(Index group) { group_.push_back(group); }
  std::size_t triangles() const { return positions_.size() / 3; }

  SurfaceMesh join() {
    std::vector<Index> order(positions_.size()), first(positions_.size());
    std::iota(order.begin(), order.end(), 0);
    const auto place = [&](Index i) {
      const Vec3& p = positions_[at(i)];
      return std::tuple(p.x(), p.y(), p.z());
    };
    std::sort(order.begin(), order.end(),
              [&](Index i, Index j) { return std::tuple(place(i), i) < std::tuple(place(j), j); });
    for (std::size_t k = 0; k < order.size(); ++k)
      first[at(order[k])] = k > 0 && place(order[k]) == place(order[k - 1]) ? first[at(order[k - 1])] : order[k];
    SurfaceMesh mesh;
    std::vector<Index> number(positions_.size());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if (at(first[i]) != i) continue;
      number[i] = static_cast<Index>(mesh.positions.size());
      mesh.positions.push_back(positions_[i]);
    }
    for (std::size_t t = 0; t < triangles(); ++t)
      mesh.triangles.push_back({number[at(first[3 * t])], number[at(first[3 * t + 1])], number[at(first[3 * t + 2])]});
    mesh.group = std::move(group_);
    mesh.object.assign(mesh.triangles.size(), 0);
    mesh.object_names = {""};
    return mesh;
  }

 private:
  Vec3s positions_;
  std::vector<Index> group_;  // [triangle]
};

SurfaceMesh read_binary(const MeshSource& source) {
  const std::uint32_t count = little_endian(source.bytes, header_bytes);
  if (count == 0) throw InputError(source.file, "mesh", "at least one triangle", "none");
  if (count > mesh_triangle_limit)
    throw InputError(source.file, "mesh", "at most " + std::to_string(mesh_triangle_limit) + " triangles",
                     std::to_string(count));
  Corners corners;
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t facet = header_bytes + count_bytes + t * facet_bytes;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Vec3 p;
      for (Eigen::Index k = 0; k < 3; ++k) {
        const std::uint32_t bits =
            little_endian(source.bytes, facet + 12 + 12 * corner + 4 * at(static_cast<Index>(k)));
        float number = 0;
        std::memcpy(&number, &bits, sizeof number);
        if (!std::isfinite(number))
          throw InputError(source.file, "triangle " + std::to_string(t), "finite coordinates",
                           "infinity or not a number");
        p[k] = static_cast<double>(number);
      }
      corners.add(p);
    }
    corners.add_triangle_of(0);
  }
  SurfaceMesh mesh = corners.join();
  mesh.group_names = {""};
  return mesh;
}

class AsciiStl {
 public:
  explicit AsciiStl(const MeshSource& source) : text_(source.bytes), file_(source.file) {}

  SurfaceMesh read() {
    while (!peek().empty()) read_solid();
    if (corners_.triangles() == 0) fail("mesh", "at least one facet", "none");
    SurfaceMesh mesh = corners_.join();
    mesh.group_names = std::move(names_);
    return mesh;
  }

 private:
  [[noreturn]] void fail(std::string_view place, std::string_view expected, std::string_view got) const {
    throw InputError(file_ + ':' + std::to_string(line_), place, expected, got);
  }
  void skip_blanks() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n' || (c == '\r' && text_.substr(at_, 2) != "\r\n")) ++line_;
      if (c != ' ' && c != '\t' && c != '\n' && c != '\r') return;
    }
  }
  // The next word, without taking it; empty at the end of the file.
  std::string_view peek() {
    skip_blanks();
    return text_.substr(at_, std::min(text_.find_first_of(" \t\r\n", at_), text_.size()) - at_);
  }
  std::string_view take() {
    const std::string_view word = peek();
    at_ += word.size();
    return word;
  }
  void expect(std::string_view word) {
    const std::string_view got = take();
    if (got != word)
      fail("facet", '"' + std::string(word) + '"', got.empty() ? "the end of the file" : '"' + printable(got) + '"');
  }
  std::string_view rest_of_line() {
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    std::string_view rest = text_.substr(at_, end - at_);
    at_ = end;
    const std::size_t first = std::min(rest.find_first_not_of(" \t"), rest.size());
    rest.remove_prefix(first);
    while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.remove_suffix(1);
    return rest;
  }
  double number() {
    const std::string_view word = take();
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
      fail("vertex", "a finite number", word.empty() ? "the end of the file" : '"' + printable(word) + '"');
    return value;
  }

  void read_solid() {
    expect("solid");
    const std::string name(rest_of_line());
    const std::size_t before = corners_.triangles();
    while (peek() == "facet") read_facet(static_cast<Index>(names_.size()));
    expect("endsolid");
    rest_of_line();
    if (corners_.triangles() > before) names_.push_back(name);
  }

  void read_facet(Index group) {
    if (corners_.triangles() == mesh_triangle_limit)
      fail("facet", "at most " + std::to_string(mesh_triangle_limit) + " triangles", "more");
    expect("facet");
    rest_of_line();  // the normal
    expect("outer");
    expect("loop");
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      const double x = number(), y = number(), z = number();
      corners_.add(Vec3(x, y, z));
    }
    corners_.add_triangle_of(group);
    expect("endloop");
    expect("endfacet");
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;
  Corners corners_;
  std::vector<std::string> names_;
};

bool is_ascii(std::string_view bytes) {
  if (first_word(bytes) != "solid") return false;
  const std::size_t line = bytes.find_first_of("\r\n", bytes.find("solid"));
  if (line == std::string_view::npos) return false;
  const std::string_view next = first_word(bytes.substr(line));
  return next == "facet" || next == "endsolid";
}

}  // namespace

MeshReader stl_reader() {
  return {
      "STL",
      {".stl"},
      [](std::string_view bytes) { return is_binary(bytes) || is_ascii(bytes); },
      [](const MeshSource& source) { return is_binary(source.bytes) ? read_binary(source) : AsciiStl(source).read(); },
      nullptr};
}

}  // namespace toile::internal
