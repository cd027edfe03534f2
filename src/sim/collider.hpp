// sim/collider.hpp: what cloth collides with, loaded: a surface, how it moves, how cloth lies on it.  Many become one body.
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
  BodyAt at;  // since it began to move; at 0 s the body is where it stands
  std::string name;
  double duration_s = 0;  // until the body holds still; infinite for what repeats
};

struct Collider {
  SolidMesh surface;                             // where it stands, m
  std::optional<BodyMovement> movement;          // absent: it stands
  std::optional<BodyMeasurements> measurements;  // of a person, where they are known
  std::vector<std::string> warnings;             // what of its file is left out
  std::uint64_t input_hash = 0;                  // of the files and arrays that it was made of; 0: of none
};

// The union of the colliders' surfaces, in their order.
struct JoinedColliders {
  SolidMesh surface;
  std::vector<Index> vertex_collider;  // [vertex] a place in `parts`
  struct Part {
    std::size_t first_vertex = 0, vertices = 0;
    bool moves = false;  // by itself
  };
  std::vector<Part> parts;
  std::optional<BodyMovement> movement;  // of all, if any moves; it has the name of the first that has one
};
JoinedColliders join(std::vector<Collider> colliders);

// What making a collider takes, before it is made.
struct ColliderCost {
  std::string what;  // "woman", "(sphere)"; empty: it is no collider
  double triangles = 0;
  double making_mb = 0;  // at the peak, given back
  double making_s = 0;
};

// Throws InputError for the first triangle whose corners lie on a line.
void check_areas(std::string_view file, std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace toile::internal
