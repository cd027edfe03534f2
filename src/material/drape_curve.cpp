#include "material/drape_curve.hpp"

#include <algorithm>
#include <vector>

namespace toile::internal::drape_curve {

const MonotoneCurve& percent_of_bending_length() {
  static const MonotoneCurve curve = [] {
    std::vector<std::array<double, 2>> list;
    for (const Point& point : points) list.push_back({point.bending_length_m, point.percent});
    return MonotoneCurve(list);
  }();
  return curve;
}

double uncertainty_points(double bending_length_m) {
  std::size_t k = 0;
  while (k + 2 < points.size() && bending_length_m >= points[k + 1].bending_length_m) ++k;
  const Point &before = points[k], &after = points[k + 1];
  const double share = std::clamp(
      (bending_length_m - before.bending_length_m) / (after.bending_length_m - before.bending_length_m), 0.0, 1.0);
  return std::max(least_uncertainty_points, before.scatter + share * (after.scatter - before.scatter));
}

}  // namespace toile::internal::drape_curve
