// body/arms.hpp: the arms of an upright person, found from the surface alone.
//
//   extremities   farthest-point sampling by geodesic distance gives two feet, two hands and a head, in any pose and any mesh
//   an arm        the curves of equal distance from a hand's tip are rings about it, until they run out over the trunk: the root
//
// A body that is no person (a ball, a torso without arms) has none.
#pragma once
#include "core/types.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace toile::internal {

struct Arm {
  Vec3 root{0, 0, 0};       // middle of the ring at the armpit
  Vec3 direction{0, 0, 0};  // unit, from the root to the wrist
  double length_m = 0;      // along the surface, from the root's ring to the tip
  std::vector<double>
      past;  // [vertex] its distance beyond the root's ring towards the hand, along the surface, m; < 0: not on the arm
};

// Left (at larger x) and right.
using Arms = std::optional<std::array<Arm, 2>>;
Arms find_arms(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace toile::internal
