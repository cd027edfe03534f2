#include "material/bend_hysteresis.hpp"

#include "material/plate.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

// |S|: the root of the sum of the squares of its entries as a matrix, so that no direction is favoured.
double magnitude(const Vec3& S) { return std::sqrt(S.x() * S.x() + S.y() * S.y() + 0.5 * S.z() * S.z()); }

}  // namespace

double friction_stiffening(const Fabric& fabric) {
  const double D =
      std::sqrt(std::max(fabric.bend_u_N_m, least_rigidity_N_m) * std::max(fabric.bend_v_N_m, least_rigidity_N_m));
  return 1 + fabric.bend_friction_N / (fabric.bend_friction_curvature_per_m * D);
}

BendHysteresis bend_hysteresis(const Fabric& fabric) {
  const double stiffening = friction_stiffening(fabric);
  return {.friction_share = (stiffening - 1) / stiffening,
          .slip_curvature_per_m = fabric.bend_friction_curvature_per_m,
          .set_share = fabric.bend_set,
          .set_s = fabric.bend_set_s};
}

void BentCurvature::follow(const BendHysteresis& of, const Vec3& S, double h_s) {
  if (of.friction_share > 0) {
    const Vec3 held = S - slipped;
    const double bent = magnitude(held);
    if (bent > of.slip_curvature_per_m) slipped = S - (of.slip_curvature_per_m / bent) * held;
  }
  if (of.set_share > 0) set += h_s / (of.set_s + h_s) * (S - set);  // backward Euler
}

}  // namespace toile::internal
