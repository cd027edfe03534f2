#include "material/drape_curve.hpp"

#include <algorithm>
#include <vector>

namespace toile::internal::drape_curve {
namespace {

const Drape& drape_at(const Point& point, bool filament) { return filament ? point.filament : point.staple; }

MonotoneCurve curve_of(bool filament) {
  std::vector<std::array<double, 2>> list;
  for (const Point& point : points) list.push_back({point.bending_length_m, drape_at(point, filament).percent});
  return MonotoneCurve(list);
}

}  // namespace

const MonotoneCurve& percent_of_bending_length(double compression_ratio) {
  static const std::array<MonotoneCurve, 2> curves = {curve_of(false), curve_of(true)};
  return curves[compression_ratio < filament_below ? 1 : 0];
}

double uncertainty_points(double bending_length_m, double compression_ratio) {
  const bool filament = compression_ratio < filament_below;
  std::size_t k = 0;
  while (k + 2 < points.size() && bending_length_m >= points[k + 1].bending_length_m) ++k;
  const Point &before = points[k], &after = points[k + 1];
  const double share = std::clamp(
      (bending_length_m - before.bending_length_m) / (after.bending_length_m - before.bending_length_m), 0.0, 1.0);
  const double least = drape_at(before, filament).scatter, most = drape_at(after, filament).scatter;
  return std::max(least_uncertainty_points, least + share * (most - least));
}

}  // namespace toile::internal::drape_curve
