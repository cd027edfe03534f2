// body/collision_body.cpp: selects the part of a file that is the body, and checks its size.
#include "body/collision_body.hpp"

#include "core/error.hpp"
#include "mesh/check.hpp"
#include "mesh/join_sides.hpp"
#include "mesh/surface_parts.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

namespace toile::internal {

namespace {

constexpr double shortest_body_m = 0.5, tallest_body_m = 2.5;
constexpr double part_share = 0.1;   // of the largest part's volume; smaller parts are eyes, teeth, buttons
constexpr double told_share = 0.01;  // of the body's: a smaller part that is left out is not noted

std::size_t z(Index i) { return static_cast<std::size_t>(i); }

bool is_body_name(std::string_view name) {
  constexpr std::string_view wanted = "body";
  return std::equal(name.begin(), name.end(), wanted.begin(), wanted.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

// The triangles (by index) whose group or object is called body; empty when there are none.
std::vector<Index> named_body(const SurfaceMesh& mesh) {
  const auto belongs = [&](const std::vector<Index>& of, const std::vector<std::string>& names, std::size_t t) {
    return t < of.size() && is_body_name(names[z(of[t])]);
  };
  std::vector<Index> kept;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (belongs(mesh.group, mesh.group_names, t) || belongs(mesh.object, mesh.object_names, t))
      kept.push_back(static_cast<Index>(t));
  return kept;
}

struct Kept {
  std::vector<Index> triangles;  // ascending
  std::vector<std::string> notes;
};

// The names of the objects (of the groups, if there is only one object) of these triangles, in the order of the file.
std::string names_of(const SurfaceMesh& mesh, const std::vector<Index>& triangles) {
  const bool by_object = mesh.object_names.size() > 1;
  const auto& of = by_object ? mesh.object : mesh.group;
  const auto& names = by_object ? mesh.object_names : mesh.group_names;
  std::vector<char> used(names.size(), 0);
  for (const Index t : triangles)
    if (z(t) < of.size()) used[z(of[z(t)])] = 1;
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (used[k] != 0 && !names[k].empty()) text += (text.empty() ? "" : ", ") + printable(names[k]);
  return text.empty() ? "a part without a name" : text;
}

std::size_t vertices_of(const SurfaceMesh& mesh, const std::vector<Index>& triangles) {
  std::vector<Index> vertices;
  for (const Index t : triangles)
    for (const Index v : mesh.triangles[z(t)]) vertices.push_back(v);
  std::sort(vertices.begin(), vertices.end());
  return static_cast<std::size_t>(std::unique(vertices.begin(), vertices.end()) - vertices.begin());
}

// Names the closed parts that are left out and have at least this share of the volume of those that are taken.
void note_left_out(const SurfaceMesh& mesh, const SurfaceParts& parts, const std::vector<char>& taken,
                   double least_share, Kept& kept) {
  double volume = 0;
  for (std::size_t p = 0; p < taken.size(); ++p)
    if (taken[p] != 0) volume += std::abs(parts.parts[p].volume_m3);
  for (std::size_t p = 0; p < taken.size(); ++p) {
    const double share = std::abs(parts.parts[p].volume_m3) / volume;
    if (taken[p] != 0 || !parts.parts[p].closed || !(share >= least_share)) continue;
    std::vector<Index> left;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (z(parts.of[t]) == p) left.push_back(static_cast<Index>(t));
    kept.notes.push_back(names_of(mesh, left) + " (" + std::to_string(vertices_of(mesh, left)) + " vertices, " +
                         fmt::sprintf("%.0f %% of the volume of the body) left out", 100 * share));
  }
}

// The triangles of the closed parts that are large enough; all triangles when no part is closed, so that the check
// of the whole surface reports where it is open.
Kept closed_parts(const SurfaceMesh& mesh) {
  const SurfaceParts found = surface_parts(mesh.triangles, mesh.positions);
  double largest = 0;
  for (const SurfacePart& part : found.parts)
    if (part.closed) largest = std::max(largest, std::abs(part.volume_m3));
  Kept kept;
  std::vector<char> taken;
  for (const SurfacePart& part : found.parts)
    taken.push_back(largest == 0 || (part.closed && std::abs(part.volume_m3) >= part_share * largest) ? 1 : 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (taken[z(found.of[t])] != 0) kept.triangles.push_back(static_cast<Index>(t));
  note_left_out(mesh, found, taken, told_share, kept);
  return kept;
}

// The part named body; if it is open, the closed parts that contain it.
Kept named_parts(const SurfaceMesh& mesh, std::vector<Index> named) {
  Kept kept;
  std::vector<Triangle> triangles;
  for (const Index t : named) triangles.push_back(mesh.triangles[z(t)]);
  const SurfaceParts alone = surface_parts(triangles, mesh.positions);
  const SurfaceParts whole = surface_parts(mesh.triangles, mesh.positions);
  std::vector<char> taken(whole.parts.size(), 0);
  for (const Index t : named) taken[z(whole.of[z(t)])] = 1;
  std::vector<Index> joined;
  bool closed = true;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (taken[z(whole.of[t])] == 0) continue;
    joined.push_back(static_cast<Index>(t));
    closed &= whole.parts[z(whole.of[t])].closed;
  }
  const bool open =
      std::any_of(alone.parts.begin(), alone.parts.end(), [](const SurfacePart& part) { return !part.closed; });
  if (open && closed && joined.size() > named.size()) {
    kept.notes.push_back("what the file calls body is open: taken with what it hangs together with (" +
                         names_of(mesh, joined) + ")");
    kept.triangles = std::move(joined);
  } else {
    kept.triangles = std::move(named);
  }
  note_left_out(mesh, whole, taken, part_share, kept);
  return kept;
}

// "dm", "cm", or empty when no unit fits this height.
std::optional<LengthUnit> unit_that_fits(double height) {
  for (const LengthUnit unit : {LengthUnit::dm, LengthUnit::cm}) {
    const double h = height * metres_in(unit);
    if (h >= shortest_body_m && h <= tallest_body_m) return unit;
  }
  return std::nullopt;
}

[[noreturn]] void fail_height(std::string_view file, double height) {
  std::string advice = "no unit of m, dm, cm fits: say which one is meant with --body-unit";
  if (const auto unit = unit_that_fits(height)) {
    advice = std::string("pass --body-unit ") + (*unit == LengthUnit::dm ? "dm" : "cm") + " if the body is " +
             fmt::sprintf("%.2f m", height * metres_in(*unit)) + " tall";
  }
  throw InputError(file, "body height", "0.5 to 2.5 m when coordinates are taken as metres (" + advice + ")",
                   fmt::sprintf("%.4g m", height));
}

// Checked before any arithmetic: every index in range, every coordinate finite.
void check_input(const SurfaceMesh& mesh, std::string_view file) {
  if (mesh.triangles.empty()) throw InputError(file, "body", "a closed surface", "no faces");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (Index v : mesh.triangles[i]) {
      if (v < 0 || z(v) >= mesh.positions.size())
        throw InputError(file, "triangle " + std::to_string(i),
                         "an index below " + std::to_string(mesh.positions.size()), std::to_string(v));
      if (!mesh.positions[z(v)].allFinite())
        throw InputError(file, "vertex " + std::to_string(v), "finite coordinates", "infinity or not a number");
    }
}

}  // namespace

double metres_in(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::dm:
      return 0.1;
    case LengthUnit::cm:
      return 0.01;
    case LengthUnit::automatic:
    case LengthUnit::m:
      break;
  }
  return 1.0;
}

CollisionBody make_collision_body(const SurfaceMesh& read, std::string_view file, LengthUnit unit) {
  check_input(read, file);
  CollisionBody body;
  body.notes = read.notes;
  const JoinedSides joined = join_sides(read.positions, read.triangles, read.object);
  SurfaceMesh mesh = read;
  mesh.triangles = joined_triangles(read.triangles, joined);
  if (joined.joined > 0)
    body.notes.push_back(std::string(file) + ": " + std::to_string(joined.joined) +
                         " vertices lie where another one does, along a seam, and are one with it");
  std::vector<Index> named = named_body(mesh);
  Kept taken = named.empty() ? closed_parts(mesh) : named_parts(mesh, std::move(named));
  for (const std::string& note : taken.notes) body.notes.push_back(std::string(file) + ": " + note);
  std::vector<Index>& kept = taken.triangles;

  body.name = std::filesystem::path(file).stem().string();
  std::vector<Index> map(mesh.positions.size(), -1);
  for (Index t : kept)
    for (Index v : mesh.triangles[z(t)]) map[z(v)] = 0;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (map[i] == 0) {
      map[i] = static_cast<Index>(body.positions.size());
      body.positions.push_back(metres_in(unit) * mesh.positions[i]);
      body.source_vertex.push_back(static_cast<Index>(i));
    }
  for (Index k : kept) {
    const Triangle& t = mesh.triangles[z(k)];
    body.triangles.push_back({map[z(t[0])], map[z(t[1])], map[z(t[2])]});
  }
  body.source_triangle = std::move(kept);
  body.source_vertex_count = mesh.positions.size();
  body.source_triangle_count = mesh.triangles.size();
  check_closed(file, body.positions, body.triangles);

  const auto [low, high] = std::minmax_element(body.positions.begin(), body.positions.end(),
                                               [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  body.height_m = high->y() - low->y();
  if (unit == LengthUnit::automatic && !(body.height_m >= shortest_body_m && body.height_m <= tallest_body_m))
    fail_height(file, body.height_m);
  return body;
}

CollisionBody from_mannequin(const Mannequin& mannequin) {
  CollisionBody body;
  body.positions = mannequin.positions;
  body.triangles = mannequin.triangles;
  body.name = "mannequin";
  body.height_m = mannequin.measurements_m.height;
  body.source_vertex_count = body.positions.size();
  body.source_triangle_count = body.triangles.size();
  for (std::size_t i = 0; i < body.positions.size(); ++i) body.source_vertex.push_back(static_cast<Index>(i));
  for (std::size_t i = 0; i < body.triangles.size(); ++i) body.source_triangle.push_back(static_cast<Index>(i));
  return body;
}

}  // namespace toile::internal
