// sim/body_figures.cpp: heights and girths of a body.
//
//   head     greatest level girth between 90 % and 98 % of the height: above chin and neck, below the crown
//   waist    body/measure.hpp; the middle of the trunk is that of the section there
#include "sim/body_figures.hpp"

#include "body/measure.hpp"
#include "core/elementary.hpp"
#include "garment/pattern_figures.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::internal {

namespace {

void add_measured(const BodyMeasurements& measured, BodyFigures& figures) {
  const auto height = [&](const std::optional<double>& above_feet_m, std::optional<double>& member) {
    if (above_feet_m) member = figures.low_m.y() + *above_feet_m;
  };
  height(measured.shoulder_m(), figures.shoulder_m);
  height(measured.waist_m(), figures.tape_waist_m);
  figures.waist_m = figures.tape_waist_m.value_or(figures.waist_m);
  figures.waist_girth_m = measured.waist_girth_m.value_or(figures.waist_girth_m);
  figures.hips_girth_m = measured.hips_girth_m.value_or(figures.hips_girth_m);
  if (measured.arm_down_rad) figures.arm_down_deg = *measured.arm_down_rad * 180 / std::numbers::pi;
}

BodyFigures figures_of_surface(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
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

}  // namespace

BodyFigures body_figures(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                         const std::optional<BodyMeasurements>& measured) {
  BodyFigures figures = figures_of_surface(positions, triangles);
  if (measured) add_measured(*measured, figures);
  return figures;
}

void add_arms(BodyFigures& figures, const Arms& arms) {
  if (!arms) return;
  double down_rad = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double outwards = k == 0 ? 1 : -1;
    down_rad -= 0.5 * ieee_atan2((*arms)[k].direction.y(), outwards * (*arms)[k].direction.x());
  }
  figures.arm_down_deg = down_rad * 180 / std::numbers::pi;
  figures.arm_roots_m = {(*arms)[0].root, (*arms)[1].root};
}

std::string odd_pose(const BodyMeasurements& measured, const BodyFigures& figures) {
  if (!measured.arm_down_rad || !figures.arm_roots_m) return {};
  const double said_deg = *measured.arm_down_rad * 180 / std::numbers::pi;
  if (std::abs(said_deg - *figures.arm_down_deg) <= pose_agrees_deg) return {};
  return fmt::sprintf(
      "%s: body.arm_pose_angle: expected about %.0f degrees, as the arms of the mesh hang below the level, got %.0f; "
      "the mesh's counts",
      measured.file, *figures.arm_down_deg, said_deg);
}

}  // namespace toile::internal
