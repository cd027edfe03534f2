#include "sim/collider_capsule.hpp"

#include "core/elementary.hpp"
#include "core/error.hpp"
#include "sim/colliders.hpp"
#include "step/tangents.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace toile::internal {
namespace {

constexpr double shortest_m = 1e-6;

// Its profile along the y axis, from below: two quarters of a circle in pieces of at most edge_m.
std::vector<Vec2> outline(const SceneCapsule& capsule, double edge_m) {
  constexpr double quarter = std::numbers::pi / 2;
  const double r = capsule.radius_m, half = 0.5 * (capsule.to_m - capsule.from_m).norm();
  const int pieces = std::max(2, static_cast<int>(std::ceil(quarter * r / edge_m)));
  std::vector<Vec2> upper{{r, half}};
  for (int k = 1; k < pieces; ++k) {
    const double angle = quarter * k / pieces;
    upper.emplace_back(r * ieee_cos(angle), half + r * ieee_sin(angle));
  }
  upper.emplace_back(0, half + r);
  std::vector<Vec2> whole(upper.rbegin(), upper.rend());
  for (Vec2& p : whole) p.y() = -p.y();
  whole.insert(whole.end(), upper.begin(), upper.end());
  return whole;
}

}  // namespace

Collider load(const SceneCapsule& capsule, const SceneCollider& whole) {
  const Vec3 way = capsule.to_m - capsule.from_m;
  if (way.norm() < shortest_m) throw InputError("", "to_m", "another place than from_m", "the same: that is a sphere");
  SolidMesh surface = revolved(outline(capsule, whole.edge_m), whole.edge_m);
  const Vec3 along = way.normalized(), middle = 0.5 * (capsule.from_m + capsule.to_m);
  const auto [across, beside] = tangents(along);
  for (Vec3& p : surface.positions) p = middle + p.x() * across + p.y() * along - p.z() * beside;
  return standing(std::move(surface));
}

ColliderCost cost(const SceneCapsule& capsule, const SceneCollider& whole) {
  return {"(capsule)", revolved_triangles(outline(capsule, whole.edge_m), whole.edge_m)};
}

}  // namespace toile::internal
