// sim/scene_cloth.cpp: what the keys of a cloth ask of each other.
#include "sim/scene_settle.hpp"
#include "sim/settings_cloth.hpp"

#include <fmt/printf.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace toile::internal {
namespace {

void check_speed_along(const Json& path, const std::vector<VectorKey>& keys) {
  for (std::size_t k = 1; k < keys.size(); ++k) {
    const double m_per_s = (keys[k].x - keys[k - 1].x).norm() / (keys[k].t_s - keys[k - 1].t_s);
    if (m_per_s > most_led_m_per_s)
      path.array()[k].fail(fmt::sprintf("at most %g m/s from the key before", most_led_m_per_s),
                           fmt::sprintf("%.4g m/s", m_per_s));
  }
}

// The key that only one way of holding has: given with another one it would do nothing.
const Json* of_hold(const Json& pin, std::string_view key, std::string_view hold, bool chosen) {
  const Json* value = pin.find(key);
  if (value != nullptr && !chosen)
    value->fail("\"hold\": \"" + std::string(hold) + "\" beside it", "\"" + std::string(key) + "\" without it");
  return value;
}

double length_of(const std::vector<Vec3>& path, bool closed) {
  double length = closed ? (path.front() - path.back()).norm() : 0;
  for (std::size_t k = 1; k < path.size(); ++k) length += (path[k] - path[k - 1]).norm();
  return length;
}

// Throws for more triangles of this edge length than anyone means.
void check_count(const Json& shape, double area_m2, double edge_m) {
  const double triangles = 4 * area_m2 / (edge_m * edge_m * std::sqrt(3.0));
  if (triangles > 2e6) shape.fail("at most 2 million triangles", std::to_string(triangles) + " from this edge_m");
}

// The triangulation counts in 2^-20 m, with 25 bits.
constexpr double nearest_points_m = 2e-6, longest_m = 32;

double area_m2(const SceneCloth& cloth) {
  if (cloth.grid) return cloth.grid->width_m * cloth.grid->height_m;
  if (cloth.tube) return 2 * std::numbers::pi * cloth.tube->radius_m * cloth.tube->length_m;
  return length_of(cloth.ribbon->path_m, cloth.ribbon->closed) * cloth.ribbon->width_m;
}

}  // namespace

void check_ascending(const Json& moves, const std::vector<RigidKey>& keys) {
  for (std::size_t k = 1; k < keys.size(); ++k)
    if (!(keys[k].t_s > keys[k - 1].t_s))
      moves.array()[k].at("t_s").fail("times that ascend", "a time not after the one before");
}

void settle(const Json& value, SceneTube& tube) {
  if (tube.edge_m > tube.radius_m)
    value.fail("an edge_m of at most its radius_m", fmt::sprintf("%g of %g", tube.edge_m, tube.radius_m));
}

void settle(const Json& value, SceneRibbon& ribbon) {
  const Json& path = value.at("path_m");
  for (std::size_t k = 1; k < ribbon.path_m.size(); ++k)
    if (!((ribbon.path_m[k] - ribbon.path_m[k - 1]).norm() >= nearest_points_m))
      path.array()[k].fail(fmt::sprintf("another place than the point before, by at least %g m", nearest_points_m),
                           fmt::sprintf("%g m", (ribbon.path_m[k] - ribbon.path_m[k - 1]).norm()));
  const std::size_t least = ribbon.closed ? 3 : 2;
  if (ribbon.path_m.size() < least)
    path.fail("at least " + std::to_string(least) + " points [x, y, z]", std::to_string(ribbon.path_m.size()));
  if (ribbon.closed && !((ribbon.path_m.front() - ribbon.path_m.back()).norm() >= nearest_points_m))
    path.fail("the first point only once: a closed ribbon goes back to it", "the first point again at the end");
  if (ribbon.closed && length_of(ribbon.path_m, true) < 6 * ribbon.edge_m)
    value.fail("an edge_m of at most a sixth of the way round", path.describe());
  if (const double along = length_of(ribbon.path_m, ribbon.closed); along > longest_m)
    path.fail(fmt::sprintf("at most %g m along it", longest_m), fmt::sprintf("%.4g m", along));
  if (!(ribbon.across.squaredNorm() >= std::numeric_limits<double>::min()))
    value.at("across").fail("a direction", "zero");
}

void settle(const Json& value, ScenePin& pin) {
  if (!(pin.to_s > pin.from_s)) value.fail("a pin that lets go after it takes hold", "to_s not after from_s");
  const bool on_path = pin.hold == ScenePin::Hold::path, moved = pin.hold == ScenePin::Hold::moves;
  const Json* path = of_hold(value, "path_m", "path", on_path);
  const Json* moves = of_hold(value, "moves", "moves", moved);
  of_hold(value, "about_m", "moves", moved);
  if (on_path) {
    if (path == nullptr) value.fail("\"path_m\": [[t_s, x, y, z], ...]", "hold \"path\" without a path");
    if (pin.in_box_m) path->fail("\"moves\" for all in a box", "one place for all of them");
    check_speed_along(*path, pin.path);
  }
  if (moved) {
    if (moves == nullptr) value.fail("\"moves\": [{\"t_s\": ...}, ...]", "hold \"moves\" without moves");
    check_ascending(*moves, pin.moves.keys());
  }
}

void settle(const Json& value, SceneDrag& drag) {
  check_speed_along(value.at("path_m"), drag.path);
  if (value.find("from_s") == nullptr) drag.from_s = drag.path.front().t_s;
  if (value.find("to_s") == nullptr) drag.to_s = drag.path.back().t_s;
  if (!(drag.to_s > drag.from_s)) value.fail("a drag that ends after it begins", "to_s not after from_s");
}

void settle(const Json& value, SceneCloth& cloth) {
  if (cloth.mesh.empty())
    for (const std::string_view key : {"mesh_unit", "rest_shape"})
      if (const Json* given = value.find(key)) given->fail("a mesh beside it", given->describe());
  if (cloth.is_sewn()) return;
  if (!cloth.mesh.empty()) {
    if (cloth.name.empty()) cloth.name = std::filesystem::path(cloth.mesh).stem().string();
    if (const Json* vertices = value.find("vertices")) vertices->fail("a pattern beside it", "a number of vertices");
    return;
  }
  const std::string_view kind = cloth.shape_key();
  check_count(value.at(kind), area_m2(cloth), cloth.edge_m());
  if (cloth.name.empty()) cloth.name = cloth.grid ? "sheet" : kind;
  if (const Json* vertices = value.find("vertices"))
    vertices->fail("a pattern beside it: other shapes have an edge_m", "a number of vertices");
}

}  // namespace toile::internal
