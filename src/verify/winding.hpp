// verify/winding.hpp: the exact winding number of a surface about a point: 0 outside, 1 inside, 2 where a body overlaps itself.
#pragma once
#include "core/types.hpp"
#include "verify/box_tree.hpp"

#include <span>
#include <utility>
#include <vector>

namespace toile::internal {

// A surface without boundary: `triangles`, and a fan around the middle of each hole.
class ClosedSurface {
 public:
  // Indices must be in range and positions finite.
  ClosedSurface(std::span<const Triangle> triangles, std::span<const Vec3> x);

  int winding_number(const Vec3& p) const;

 private:
  explicit ClosedSurface(std::pair<std::vector<Triangle>, Vec3s> closed);

  std::vector<Triangle> triangles_;
  Vec3s x_;
  BoxTree tree_;
  ExactBox bounds_;
};

}  // namespace toile::internal
