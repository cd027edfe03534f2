#include "step/stretch_changes.hpp"

#include "core/parallel.hpp"

#include <cmath>
#include <functional>

namespace toile::internal {
namespace {

constexpr std::size_t element_grain = 1024;

}  // namespace

StretchChanges::StretchChanges(const ClothModel& model, const Elements& elements)
    : model_(&model),
      elements_(&elements),
      start_(model.mesh.triangles.size()),
      end_(start_.size()),
      of_blocks_((start_.size() + element_grain - 1) / element_grain) {}

void StretchChanges::begin(std::span<const Vec3> x) { elements_->stretch(x, start_); }

StretchChange StretchChanges::largest(std::span<const Vec3> x) {
  elements_->stretch(x, end_);
  const auto block = [&](std::size_t begin, std::size_t end) {
    of_blocks_[begin / element_grain] = largest_of(begin, end);
  };
  parallel_blocks(start_.size(), element_grain, std::cref(block));  // by reference: no copy of the lambda on the heap
  StretchChange largest;
  for (const StretchChange& of_block : of_blocks_) {
    if (of_block.farthest > largest.farthest) {
      largest.farthest = of_block.farthest;
      largest.beyond = of_block.beyond;
      largest.strain = of_block.strain;
    }
    if (of_block.change > largest.change) {
      largest.change = of_block.change;
      largest.triangle = of_block.triangle;
    }
  }
  return largest;
}

// Of triangles [begin, end).  Only changes away from the rest length count: a thread that relaxes is not diverging, however fast.  One that
// is pushed together counts by its energy, k c C^2 / 2: a squeeze of s is as much as a stretch of sqrt(c) s.
StretchChange StretchChanges::largest_of(std::size_t begin, std::size_t end) const {
  StretchChange largest;
  for (std::size_t t = begin; t < end; ++t) {
    const MembraneStiffness& stiffness = model_->stiffness_of(t);
    const std::array<double, 2> rest{model_->membrane[t].b_u, model_->membrane[t].b_v};
    const double limit = stiffness.strain_limit;
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double b = rest[static_cast<std::size_t>(k)], before = start_[t][k], after = end_[t][k];
      if (const double from = limited_from(b);
          limit > 0 && after > before && after - from > largest.farthest * limit * from) {
        largest.farthest = (after - from) / (limit * from);
        largest.beyond = static_cast<Index>(t);
        largest.strain = after / from - 1;
      }
      if (std::abs(after - b) <= std::abs(before - b)) continue;
      double change = std::abs(after - before);
      if (change <= largest.change) continue;  // a squeeze counts for no more than itself
      if (after < b) change *= std::sqrt(stiffness.compression);
      if (change <= largest.change) continue;
      largest.change = change;
      largest.triangle = static_cast<Index>(t);
    }
  }
  return largest;
}

}  // namespace toile::internal
