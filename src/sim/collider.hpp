// sim/collider.hpp: a loaded collider: its surface, its motion, its friction and thickness.  All colliders become one body.
#pragma once
#include "body/collision_body.hpp"
#include "body/solid_shapes.hpp"
#include "io/body_measurements.hpp"
#include "step/body_at.hpp"
#include "step/collider_contact.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct BodyMovement {
  BodyAt at;  // at 0 s the body is at its start
  std::string name;
  double duration_s = 0;  // until the body holds still; infinite for a periodic motion
};

struct Collider {
  SolidMesh surface;                             // where it stands, m
  std::optional<BodyMovement> movement;          // absent: it is static
  std::optional<BodyMeasurements> measurements;  // of a person, if known
  std::vector<std::string> warnings;             // parts of its file that are left out
  std::uint64_t input_hash = 0;                  // of its files and arrays; 0: it has none
};

// The union of the colliders' surfaces, in their order.
struct JoinedColliders {
  SolidMesh surface;
  std::vector<Index> vertex_collider;  // [vertex] an index of `parts`
  struct Part {
    std::size_t first_vertex = 0, vertices = 0;
    bool moves = false;  // by itself
  };
  std::vector<Part> parts;
  std::optional<BodyMovement> movement;  // of all, if any moves; it has the first name among them
};
JoinedColliders join(std::vector<Collider> colliders);

// The cost of making a collider, before it is made.
struct ColliderCost {
  std::string what;  // "woman", "(sphere)"; empty: no collider
  double triangles = 0;
  double making_mb = 0;  // at the peak, given back
  double making_s = 0;
};

// Throws InputError for the first triangle whose corners lie on a line.
void check_areas(std::string_view file, std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace toile::internal
