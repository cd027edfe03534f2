// verify/interior.hpp: the number of parts of a body that contain a point; some of them may be rooms.
#pragma once
#include "verify/winding.hpp"

#include <optional>
#include <span>

namespace toile::internal {

// A closed part that faces inwards and lies within no other is a room: its inside is free, and all around it is solid.
// An inward part within another is a hollow of that one.
class Interior {
 public:
  // Indices must be in range and positions finite.
  Interior(std::span<const Triangle> body, std::span<const Vec3> x);

  // 0 in free space; with rooms, free space is inside a room.
  int depth(const Vec3& p) const;

 private:
  std::optional<ClosedSurface> solids_, rooms_;
};

}  // namespace toile::internal
