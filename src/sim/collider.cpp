#include "sim/collider.hpp"

#include "core/error.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace toile::internal {

void check_areas(std::string_view file, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  constexpr double smallest = 1e-9;  // relative to the longer side's square
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3& origin = positions[at(triangles[t][0])];
    const Vec3 a = positions[at(triangles[t][1])] - origin, b = positions[at(triangles[t][2])] - origin;
    const double area = 0.5 * a.cross(b).norm();
    if (area > smallest * std::max(a.squaredNorm(), b.squaredNorm())) continue;
    throw InputError(file, "triangle " + std::to_string(t), "an area above zero", fmt::sprintf("%g", area));
  }
}

namespace {

// Every collider writes its own vertices, moved if it moves; `at` [part] is empty for static ones.
BodyAt together(std::vector<JoinedColliders::Part> parts, std::vector<BodyAt> at, Vec3s standing) {
  return [parts = std::move(parts), at = std::move(at), standing = std::move(standing)](double t_s, std::span<Vec3> x) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const auto& [first, count, moves] = parts[k];
      const std::span own = x.subspan(first, count);
      if (moves) {
        at[k].function()(t_s, own);
      } else {
        std::copy_n(standing.begin() + static_cast<std::ptrdiff_t>(first), count, own.begin());
      }
    }
  };
}

}  // namespace

JoinedColliders join(std::vector<Collider> colliders) {
  JoinedColliders joined;
  std::vector<BodyAt> at_of;
  std::optional<BodyMovement> whole;
  for (Collider& collider : colliders) {
    SolidMesh& all = joined.surface;
    const std::vector<Vec3>& own = collider.surface.positions;
    const auto first = static_cast<Index>(all.positions.size());
    joined.vertex_collider.resize(all.positions.size() + own.size(), static_cast<Index>(joined.parts.size()));
    joined.parts.push_back({all.positions.size(), own.size(), collider.movement.has_value()});
    all.positions.insert(all.positions.end(), own.begin(), own.end());
    for (const auto& [a, b, c] : collider.surface.triangles) all.triangles.push_back({a + first, b + first, c + first});
    at_of.emplace_back();
    if (!collider.movement) continue;
    if (!whole) whole = BodyMovement{{}, collider.movement->name, 0};
    whole->duration_s = std::max(whole->duration_s, collider.movement->duration_s);
    at_of.back() = std::move(collider.movement->at);
  }
  if (whole) {
    whole->at = together(joined.parts, std::move(at_of), joined.surface.positions);
    joined.movement = std::move(whole);
  }
  return joined;
}

}  // namespace toile::internal
