// body/collision_body.cpp: the body of a file in metres and upright, and the check of its size.
#include "body/collision_body.hpp"

#include "body/body_parts.hpp"
#include "core/error.hpp"
#include "mesh/check.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace toile::internal {

namespace {

constexpr double shortest_body_m = 0.5, tallest_body_m = 2.5;
// Units in which the body would be of a possible height, the likeliest first.
std::vector<LengthUnit> units_that_fit(double height) {
  constexpr double usual_m = 1.7;
  std::vector<LengthUnit> fit;
  for (const LengthUnit unit : {LengthUnit::dm, LengthUnit::cm, LengthUnit::mm, LengthUnit::inch}) {
    const double h = height * metres_in(unit);
    if (h >= shortest_body_m && h <= tallest_body_m) fit.push_back(unit);
  }
  const auto ratio = [&](LengthUnit unit) {
    const double h = height * metres_in(unit);
    return std::max(h / usual_m, usual_m / h);
  };
  std::stable_sort(fit.begin(), fit.end(), [&](LengthUnit l, LengthUnit r) { return ratio(l) < ratio(r); });
  return fit;
}

[[noreturn]] void fail_height(std::string_view file, double height) {
  std::string advice;
  for (const LengthUnit unit : units_that_fit(height))
    advice += (advice.empty() ? "pass --body-unit " : ", or ") + std::string(to_string(unit)) + " if the body is " +
              fmt::sprintf("%.2f m", height * metres_in(unit)) + " tall";
  if (advice.empty()) advice = "no unit of m, dm, cm, mm, in fits: say which one is meant with --body-unit";
  throw InputError(file, "body height", "0.5 to 2.5 m when coordinates are taken as metres (" + advice + ")",
                   fmt::sprintf("%.4g m", height));
}

// Checked before any arithmetic: every index in range, every coordinate finite.
void check_input(const SurfaceMesh& mesh, std::string_view file) {
  if (mesh.triangles.empty()) throw InputError(file, "body", "a closed surface", "no faces");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (Index v : mesh.triangles[i]) {
      if (v < 0 || at(v) >= mesh.positions.size())
        throw InputError(file, "triangle " + std::to_string(i),
                         "an index below " + std::to_string(mesh.positions.size()), std::to_string(v));
      if (!mesh.positions[at(v)].allFinite())
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
    case LengthUnit::mm:
      return 0.001;
    case LengthUnit::inch:
      return 0.0254;
    case LengthUnit::automatic:
    case LengthUnit::m:
      break;
  }
  return 1.0;
}

std::string_view to_string(LengthUnit unit) {
  for (const auto& [name, named] : length_units)
    if (named == unit) return name;
  return "automatic";
}

CollisionBody make_collision_body(const SurfaceMesh& mesh, std::string_view file, LengthUnit unit, UpAxis up) {
  check_input(mesh, file);
  CollisionBody body;
  body.notes = mesh.notes;
  BodyParts parts = body_parts(mesh, file, metres_in(unit));
  body.notes.insert(body.notes.end(), parts.notes.begin(), parts.notes.end());

  body.name = std::filesystem::path(file).stem().string();
  std::vector<Index> map(mesh.positions.size(), -1);
  for (const Triangle& t : parts.triangles)
    for (const Index v : t) map[at(v)] = 0;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (map[i] == 0) {
      map[i] = static_cast<Index>(body.positions.size());
      body.positions.push_back(metres_in(unit) * mesh.positions[i]);
      body.source_vertex.push_back(static_cast<Index>(i));
    }
  for (const auto& [a, b, c] : parts.triangles) body.triangles.push_back({map[at(a)], map[at(b)], map[at(c)]});
  body.source_vertex_count = mesh.positions.size();
  body.source_triangles = mesh.triangles;
  check_closed(file, body.positions, body.triangles);

  const Turned turned = upright(body.positions, body.triangles, up);
  for (const std::string& note : turned.notes) body.notes.push_back(std::string(file) + ": " + note);
  body.rotation = turned.rotation;
  if (!body.rotation.isIdentity(0))
    for (Vec3& x : body.positions) x = body.rotation * x;

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
  body.source_triangles = body.triangles;
  for (std::size_t i = 0; i < body.positions.size(); ++i) body.source_vertex.push_back(static_cast<Index>(i));
  return body;
}

}  // namespace toile::internal
