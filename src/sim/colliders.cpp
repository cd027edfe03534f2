#include "sim/colliders.hpp"

#include "core/error.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <utility>

namespace toile::internal {
namespace {

// Places it and adds its moves to its own motion.
void place(const SceneCollider& from, std::string_view path, Collider& collider) {
  SolidMesh& surface = collider.surface;
  if (from.inside_out) turn_inside_out(surface);
  const Mat3 turn = rotation_from_degrees(from.rotation_deg);
  double reach_m = 0;
  for (Vec3& x : surface.positions) {
    reach_m = std::max(reach_m, x.norm());
    x = turn * x + from.translation_m;
  }
  check_speed(from.moves, reach_m, path);
  const Vec3s standing = surface.positions;
  from.moves.place(0, standing, surface.positions);
  if (from.moves.empty() && !collider.movement) return;
  BodyMovement whole{{}, "moves", from.moves.duration_s()};
  if (collider.movement) {
    whole.name = collider.movement->name;
    whole.duration_s = std::max(whole.duration_s, collider.movement->duration_s);
  }
  whole.at = [turn, shift = from.translation_m, moves = from.moves, standing,
              own = collider.movement ? collider.movement->at : BodyAt{}](double t_s, std::span<Vec3> x) {
    if (!own) {
      moves.place(t_s, standing, x);
      return;
    }
    own.function()(t_s, x);
    for (Vec3& p : x) p = moves.place(t_s, turn * p + shift);
  };
  collider.movement = std::move(whole);
}

Collider load_kind(const SceneCollider& from) {
  return std::visit(
      [&]<class Kind>(const Kind& kind) {
        if constexpr (std::is_same_v<Kind, std::monostate>)
          return Collider{};
        else
          return load(kind, from);
      },
      from.shape);
}

}  // namespace

Collider load_collider(const SceneCollider& from, std::string_view path) {
  Collider collider;
  try {
    collider = load_kind(from);
  } catch (const InputError& error) {
    if (from.is_person()) throw;  // names its own file
    throw error.of(path);
  }
  if (!from.worn) place(from, path, collider);
  return collider;
}

ColliderCost cost_of(const SceneCollider& collider) {
  return std::visit(
      [&]<class Kind>(const Kind& kind) {
        if constexpr (std::is_same_v<Kind, std::monostate>)
          return ColliderCost{};
        else
          return cost(kind, collider);
      },
      collider.shape);
}

LoadedColliders load_colliders(const SceneCollider& body, std::span<const SceneCollider> solids) {
  LoadedColliders loaded;
  std::vector<Collider> all;
  const auto add = [&](const SceneCollider& one, std::string_view path) {
    all.push_back(load_collider(one, path));
    loaded.input_hashes.push_back(all.back().input_hash);
    for (std::string& warning : all.back().warnings) loaded.warnings.push_back(std::move(warning));
  };
  if (body.exists()) {
    add(body, "/body");
    loaded.worn_vertices = all.front().surface.positions.size();
    loaded.worn_triangles = all.front().surface.triangles.size();
    loaded.measurements = std::move(all.front().measurements);
  }
  for (std::size_t k = 0; k < solids.size(); ++k) add(solids[k], path_of_solid(k));
  loaded.joined = join(std::move(all));
  return loaded;
}

void check_speed(const RigidPath& moves, double reach_m, std::string_view path) {
  const auto [key, m_per_s] = moves.fastest(reach_m);
  if (m_per_s > most_led_m_per_s)
    throw InputError("", "/moves/" + std::to_string(key),
                     fmt::sprintf("no point faster than %g m/s from the key before", most_led_m_per_s),
                     fmt::sprintf("up to %.4g m/s", m_per_s))
        .of(path);
}

}  // namespace toile::internal
