// sim/body_figures.cpp: heights and girths of a body.
//
//   head     greatest level girth between 90 % and 98 % of the height: above chin and neck, below the crown
//   waist    body/measure.hpp; the middle of the trunk is that of the section there
#include "sim/body_figures.hpp"

#include "body/measure.hpp"

#include <algorithm>

namespace toile {

BodyFigures body_figures(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  BodyFigures figures;
  if (positions.empty()) return figures;
  figures.low_m = figures.high_m = positions.front();
  Vec3 crown = positions.front();
  for (const Vec3& p : positions) {
    figures.low_m = figures.low_m.cwiseMin(p);
    figures.high_m = figures.high_m.cwiseMax(p);
    if (p.y() > crown.y()) crown = p;
  }
  const double height = figures.height_m();
  for (int percent = 90; percent <= 98; ++percent) {
    const Vec3 origin(crown.x(), figures.low_m.y() + 0.01 * percent * height, crown.z());
    figures.head_girth_m = std::max(figures.head_girth_m, girth_at_m(positions, triangles, origin, Vec3::UnitY()));
  }
  figures.waist_m = waist_height_m(positions, triangles);
  figures.hips_girth_m = hips(positions, triangles).girth_m;
  figures.middle_m = 0.5 * (figures.low_m + figures.high_m);
  if (figures.waist_m <= 0) return figures;
  const Vec3 origin(figures.middle_m.x(), figures.waist_m, figures.middle_m.z());
  figures.waist_girth_m = girth_at_m(positions, triangles, origin, Vec3::UnitY());
  double nearest = 0;
  bool found = false;
  for (const auto& curve : section(positions, triangles, origin, Vec3::UnitY())) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : curve) middle += p / static_cast<double>(curve.size());
    const double distance = (middle - origin).norm();
    if (found && distance >= nearest) continue;
    found = true;
    nearest = distance;
    figures.middle_m = middle;
  }
  return figures;
}

}  // namespace toile
