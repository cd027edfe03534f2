// tests/support/tubes.hpp: upright tubes about the y axis, open or closed by lids.
#pragma once
#include "core/types.hpp"

#include <cmath>
#include <vector>

namespace toile::internal::test {

struct Tube {
  Vec3s x;
  std::vector<Triangle> triangles;  // counter-clockwise from outside
};

inline Tube tube(double radius_m, double low_m, double high_m, Index around, Index rows, bool closed) {
  Tube tube;
  for (Index r = 0; r <= rows; ++r)
    for (Index k = 0; k < around; ++k) {
      const double angle = 2 * M_PI * k / around;
      tube.x.emplace_back(radius_m * std::cos(angle), low_m + (high_m - low_m) * r / rows, radius_m * std::sin(angle));
    }
  for (Index r = 0; r < rows; ++r)
    for (Index k = 0; k < around; ++k) {
      const Index a = r * around + k, b = r * around + (k + 1) % around, c = a + around, d = b + around;
      tube.triangles.push_back({a, c, b});
      tube.triangles.push_back({b, c, d});
    }
  if (!closed) return tube;
  const auto middle = static_cast<Index>(tube.x.size());
  tube.x.emplace_back(0, low_m, 0);
  tube.x.emplace_back(0, high_m, 0);
  for (Index k = 0; k < around; ++k) {
    const Index next = (k + 1) % around;
    tube.triangles.push_back({middle, k, next});
    tube.triangles.push_back({middle + 1, rows * around + next, rows * around + k});
  }
  return tube;
}

}  // namespace toile::internal::test
