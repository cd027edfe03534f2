// step/stretch_changes.hpp: the largest change of a thread in a step, away from rest, and strain limits.       [BW98 7]
//
//   change    max over triangles of | |w'| - |w| |, w = w_u, w_v, where |w'| is farther from its rest length than |w|.
//             Compression counts as sqrt(c) of it, so that it counts by its energy, k c C^2 / 2.
#pragma once
#include "assembly/elements.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct StretchChange {
  double change = 0;
  Index triangle = -1;
  Index beyond = -1;    // of the triangles that got longer beyond their strain limit, the worst
  double strain = 0;    // of `beyond`
  double farthest = 1;  // strain over limit of `beyond`
};

class StretchChanges {
 public:
  // Model and elements must outlive this object.
  StretchChanges(const ClothModel& model, const Elements& elements);

  // Stores the start of a step, x in m, [particle].
  void begin(std::span<const Vec3> x);
  // The largest change from there to x; the same on any number of threads.
  StretchChange largest(std::span<const Vec3> x);

 private:
  StretchChange largest_of(std::size_t begin, std::size_t end) const;

  const ClothModel* model_;
  const Elements* elements_;
  std::vector<Vec2> start_, end_;         // [triangle] |w_u|, |w_v|
  std::vector<StretchChange> of_blocks_;  // [block of triangles]
};

}  // namespace toile::internal
