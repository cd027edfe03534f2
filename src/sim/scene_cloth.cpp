// sim/scene_cloth.cpp: checks the keys of a cloth against each other.
#include "sim/scene_settle.hpp"
#include "sim/settings_cloth.hpp"

#include <fmt/printf.h>

#include <cmath>
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

// The value of a key of one `hold`, if given; an error beside another `hold`, where it would have no effect.
const Json* of_hold(const Json& pin, std::string_view key, std::string_view hold, bool chosen) {
  const Json* value = pin.find(key);
  if (value != nullptr && !chosen)
    value->fail("\"hold\": \"" + std::string(hold) + "\" beside it", "\"" + std::string(key) + "\" without it");
  return value;
}

// Throws for too many triangles of this edge length.
void check_count(const Json& shape, double area_m2, double edge_m) {
  const double triangles = 4 * area_m2 / (edge_m * edge_m * std::sqrt(3.0));
  if (triangles > 2e6) shape.fail("at most 2 million triangles", std::to_string(triangles) + " from this edge_m");
}

}  // namespace

void check_ascending(const Json& moves, const std::vector<RigidKey>& keys) {
  for (std::size_t k = 1; k < keys.size(); ++k)
    if (!(keys[k].t_s > keys[k - 1].t_s))
      moves.array()[k].at("t_s").fail("times that ascend", "a time not after the one before");
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
  for_each_kind<ClothKind>([&]<class Kind>(const Kind& kind) {
    if constexpr (requires { refuse_beside(value, kind, cloth); })
      if (cloth.as<Kind>() == nullptr) refuse_beside(value, kind, cloth);
  });
  std::visit(
      [&]<class Kind>(const Kind& kind) {
        if constexpr (requires { size_of(kind); }) check_count(value.at(Kind::key), size_of(kind).area_m2, kind.edge_m);
        if constexpr (requires { usual_name(kind); })
          if (cloth.name.empty()) cloth.name = usual_name(kind);
      },
      cloth.kind);
}

}  // namespace toile::internal
