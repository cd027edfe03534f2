// garment/exact_predicates.hpp: exact orientation and in-circle tests.
//
// Points are integers on a grid of 2^-20 m (0.95 micrometre).  Bit budget, for coordinates |x|, |y| < 2^25 (32 m):
//     a difference of two coordinates       < 2^26
//     orient2d, two products                < 2 * 2^52         = 2^53     fits 64 bits
//     incircle: d.d and a 2x2 minor         < 2 * 2^52         = 2^53
//               three products of those     < 3 * 2^53 * 2^53  < 2^108    fits 128 bits
// An outline is centred on the origin and may reach 16 m from it (2^24): one bit is spare.
//
// The answers are exact for grid points.  An outline point given in floating point may lie up to 2^-21 m per axis
// from its grid point, so results that are exact on the grid hold for the given points to within one grid step.
#pragma once
#include <array>
#include <cstdint>

namespace toile::internal {

struct GridPoint {
  std::int32_t x = 0, y = 0;

  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

inline constexpr double grid_step_m = 1.0 / (1 << 20);

// Twice the signed area of triangle abc: positive when it is counter-clockwise.
inline std::int64_t orient2d(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const std::int64_t ux = std::int64_t{b.x} - a.x, uy = std::int64_t{b.y} - a.y;
  const std::int64_t vx = std::int64_t{c.x} - a.x, vy = std::int64_t{c.y} - a.y;
  return ux * vy - uy * vx;
}

// +1 when d lies strictly inside the circle through the counter-clockwise triangle abc, 0 on it, -1 outside.
inline int incircle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  __extension__ typedef __int128 Wide;
  const std::int64_t ax = std::int64_t{a.x} - d.x, ay = std::int64_t{a.y} - d.y;
  const std::int64_t bx = std::int64_t{b.x} - d.x, by = std::int64_t{b.y} - d.y;
  const std::int64_t cx = std::int64_t{c.x} - d.x, cy = std::int64_t{c.y} - d.y;
  const Wide det = Wide{ax * ax + ay * ay} * (bx * cy - by * cx) + Wide{bx * bx + by * by} * (cx * ay - cy * ax) +
                   Wide{cx * cx + cy * cy} * (ax * by - ay * bx);
  return det > 0 ? 1 : det < 0 ? -1 : 0;
}

inline std::int64_t squared_length(const GridPoint& a, const GridPoint& b) {
  const std::int64_t x = std::int64_t{b.x} - a.x, y = std::int64_t{b.y} - a.y;
  return x * x + y * y;
}

}  // namespace toile::internal
