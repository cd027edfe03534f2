// verify/interior.hpp: how many parts of a body are around a point, where some of them may be rooms.
#pragma once
#include "verify/winding.hpp"

#include <optional>
#include <span>

namespace toile::internal {

// A closed part that faces inwards and lies within no other is a room: its inside is free, and all around it is solid.
// One within another is that one's hollow.
class Interior {
 public:
  // Indices must be in range and positions finite.
  Interior(std::span<const Triangle> body, std::span<const Vec3> x);

  // 0 in the open; where there are rooms, within one of them.
  int depth(const Vec3& p) const;

 private:
  std::optional<ClosedSurface> solids_, rooms_;
};

}  // namespace toile::internal
