#include "material/edge_finish.hpp"

#include "material/plate.hpp"

#include <Eigen/LU>  // inverse
#include <algorithm>

namespace toile::internal {
namespace {

constexpr double layers = 2;

Vec3 moment_along(const Vec2& unit) { return {unit.x() * unit.x(), unit.y() * unit.y(), unit.x() * unit.y()}; }

double strip_stretch_N_per_m(const Fabric& fabric, const Vec2& unit) {
  const double c2 = unit.x() * unit.x(), s2 = unit.y() * unit.y();
  const double shear = std::max(fabric.shear_N_per_m, 1e-6 * fabric.stretch_u_N_per_m);
  return 1 / (c2 * c2 / fabric.stretch_u_N_per_m + s2 * s2 / fabric.stretch_v_N_per_m + c2 * s2 / shear);
}

double strip_rigidity_N_m(const Mat3& C, const Vec2& unit) {
  const Vec3 m = moment_along(unit);
  return 1 / m.dot(C.inverse() * m);
}

}  // namespace

LineStiffness line_stiffness(const Fabric& fabric, const Vec2& along, const EdgeFinish& finish) {
  const Vec2 unit = along.normalized(), warp(1, 0);
  const Mat3 C = bending_rigidity(fabric);
  LineStiffness line;
  line.mass_kg_per_m = layers * (finish.hem_m + finish.tape_m) * fabric.density_kg_per_m2;
  line.stretch_N = layers * (finish.hem_m * strip_stretch_N_per_m(fabric, unit) +
                             finish.tape_m * strip_stretch_N_per_m(fabric, warp));
  line.bend_N_m2 = layers * (finish.hem_m * strip_rigidity_N_m(C, unit) + finish.tape_m * strip_rigidity_N_m(C, warp));
  if (finish.allowance_m > 0) {
    line.mass_kg_per_m += finish.allowance_m * fabric.density_kg_per_m2;
    line.stretch_N += finish.allowance_m * strip_stretch_N_per_m(fabric, unit);
    line.bend_N_m2 += finish.allowance_m *
                      (strip_rigidity_N_m(C, unit) + (finish.topstitched ? layer_coupling_N_m(fabric, unit) : 0));
  }
  return line;
}

double layer_coupling_N_m(const Fabric& fabric, const Vec2& direction) {
  const double c = fabric.compression_ratio, t_m = fabric.density_kg_per_m2 / cloth_kg_per_m3;
  return c / (1 + c) * strip_stretch_N_per_m(fabric, direction.normalized()) * t_m * t_m;
}

Mat3 topstitched_rigidity(const Fabric& fabric, const Vec2& across) {
  const Vec2 unit = across.normalized();
  const Mat3 C = bending_rigidity(fabric);
  const Vec3 m = moment_along(unit);
  return C + (strip_rigidity_N_m(C, unit) + layer_coupling_N_m(fabric, unit)) * m * m.transpose();
}

}  // namespace toile::internal
