#include "material/plate.hpp"

#include "material/bend_hysteresis.hpp"

#include <Eigen/LU>  // inverse
#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double stiffest_side = 1000;  // an equilateral triangle's are below 2

// M = W (m_k), with M as (M_uu, M_vv, M_uv): the sum of m_k/L_k S_k, where S_k has n.S n = 1 across edge k and 0 across the others,
// the symmetric part of t_i t_j, scaled.
struct MomentTensors {
  Mat3 W;
  double area_m2 = 0;
};

MomentTensors moment_tensors(const std::array<Vec2, 3>& uv) {
  std::array<Vec2, 3> t;  // edge k as a unit vector
  std::array<double, 3> L;
  for (std::size_t k = 0; k < 3; ++k) {
    t[k] = uv[(k + 1) % 3] - uv[k];
    L[k] = t[k].norm();
    t[k] /= L[k];
  }
  MomentTensors tensors;
  tensors.area_m2 = 0.5 * std::abs(L[0] * L[1] * (t[0].x() * t[1].y() - t[0].y() * t[1].x()));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 &a = t[(k + 1) % 3], &b = t[(k + 2) % 3], n(t[k].y(), -t[k].x());
    const double scale = 1 / (L[k] * n.dot(a) * n.dot(b));
    tensors.W.col(static_cast<Eigen::Index>(k)) =
        scale * Vec3(a.x() * b.x(), a.y() * b.y(), 0.5 * (a.x() * b.y() + a.y() * b.x()));
  }
  return tensors;
}

}  // namespace

Mat3 bending_rigidity(const Fabric& fabric) {
  const double D_u = std::max(fabric.bend_u_N_m, least_rigidity_N_m);
  const double D_v = std::max(fabric.bend_v_N_m, least_rigidity_N_m);
  const double mean = std::sqrt(D_u * D_v), nu = fabric.bend_poisson;
  Mat3 C = Mat3::Zero();
  C(0, 0) = D_u;
  C(1, 1) = D_v;
  C(0, 1) = C(1, 0) = nu * mean;
  C(2, 2) = fabric.bend_uv_N_m > 0 ? fabric.bend_uv_N_m : 0.5 * (1 - nu) * mean;
  return fabric.bend_friction_N > 0 ? Mat3(friction_stiffening(fabric) * C) : C;
}

Mat3 plate_compliance(const std::array<Vec2, 3>& uv, const Mat3& rigidity_N_m) {
  const auto [W, area] = moment_tensors(uv);
  Mat3 F = area * W.transpose() * rigidity_N_m.inverse() * W;
  F = 0.5 * (F + F.transpose()).eval();
  F.diagonal().array() += 1 / (stiffest_side * rigidity_N_m.maxCoeff());
  return F;
}

Mat3 side_turns(const std::array<Vec2, 3>& uv) {
  const auto [W, area] = moment_tensors(uv);
  return area * W.transpose();
}

}  // namespace toile::internal
