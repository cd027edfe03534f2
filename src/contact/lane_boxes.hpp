// contact/lane_boxes.hpp: bounding boxes in single precision, single ones and groups of four, the nodes of the tree.
//
// Half the memory traffic of double precision, and one vector instruction for four boxes.  A box is never smaller than
// the exact one: if two boxes do not overlap, neither do their contents.  At 2 m from the origin the outward rounding
// adds at most 0.4 micrometres.  Coordinates must be below 1e30 m.
#pragma once
#include "core/types.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace toile::internal {

// A box in single precision that contains the double precision box it was made from.
struct OuterBox {
  std::array<float, 3> low{}, high{};

  // below: a float at most as large as x; above: one at least as large.  Conversion errs by half a unit in the last
  // place; |f| 2^-23 is one to two such units, and the small constant serves numbers near zero.
  static float below(double x) {
    const float f = static_cast<float>(x);
    return f - (std::fabs(f) * 0x1p-23f + 1e-37f);
  }
  static float above(double x) {
    const float f = static_cast<float>(x);
    return f + (std::fabs(f) * 0x1p-23f + 1e-37f);
  }
  bool overlaps(const OuterBox& other) const {  // without branches: the outcome is unpredictable
    const auto& a = *this;
    const auto& b = other;
    return static_cast<bool>(static_cast<int>(a.low[0] <= b.high[0]) & static_cast<int>(b.low[0] <= a.high[0]) &
                             static_cast<int>(a.low[1] <= b.high[1]) & static_cast<int>(b.low[1] <= a.high[1]) &
                             static_cast<int>(a.low[2] <= b.high[2]) & static_cast<int>(b.low[2] <= a.high[2]));
  }
  bool within(const OuterBox& other) const {
    int inside = 1;
    for (std::size_t k = 0; k < 3; ++k)
      inside &= static_cast<int>(other.low[k] <= low[k]) & static_cast<int>(high[k] <= other.high[k]);
    return inside != 0;
  }
  void grow(float by) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] -= by;
      high[k] += by;
    }
  }
  void include(const OuterBox& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = other.low[k] < low[k] ? other.low[k] : low[k];
      high[k] = other.high[k] > high[k] ? other.high[k] : high[k];
    }
  }
};

// Four boxes in lanes; an empty lane overlaps nothing and is infinitely far.
struct LaneBoxes {
  using Lanes = float __attribute__((vector_size(16)));
  using Mask = std::int32_t __attribute__((vector_size(16)));
  static constexpr float none = std::numeric_limits<float>::infinity();

  std::array<Lanes, 3> low{all(none), all(none), all(none)}, high{all(-none), all(-none), all(-none)};

  static constexpr Lanes all(float x) { return Lanes{x, x, x, x}; }
  static Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }

  void set(int lane, const OuterBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k][lane] = box.low[k];
      high[k][lane] = box.high[k];
    }
  }
  OuterBox box(int lane) const {
    return {{low[0][lane], low[1][lane], low[2][lane]}, {high[0][lane], high[1][lane], high[2][lane]}};
  }
  OuterBox whole() const {
    OuterBox sum = box(0);
    for (int lane = 1; lane < 4; ++lane) sum.include(box(lane));
    return sum;
  }
  // Bit `lane` is set where the lane overlaps the box.
  unsigned overlapping(const OuterBox& other) const {
    const Mask hit = (low[0] <= all(other.high[0])) & (all(other.low[0]) <= high[0]) &  //
                     (low[1] <= all(other.high[1])) & (all(other.low[1]) <= high[1]) &  //
                     (low[2] <= all(other.high[2])) & (all(other.low[2]) <= high[2]);
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(hit & Mask{1, 2, 4, 8});
    const std::uint64_t both = halves[0] | halves[1];
    return static_cast<unsigned>(both | both >> 32) & 15u;
  }
  // Lower bounds of the squared distances to a point in the box [below, above]: the factor covers the rounding of the
  // sums.
  Lanes distance2(const std::array<float, 3>& below, const std::array<float, 3>& above) const {
    Lanes sum = all(0);
    for (std::size_t k = 0; k < 3; ++k) {
      const Lanes out = larger(larger(low[k] - all(above[k]), all(below[k]) - high[k]), all(0));
      sum += out * out;
    }
    return sum * all(1 - 1e-6f);
  }
};

// Calls body(lane) for the set bits, ascending.
template <class Body>
void for_lanes(unsigned bits, Body&& body) {
  for (; bits != 0; bits &= bits - 1) body(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace toile::internal
