// tests/support/strip_rigidity.hpp: the bending rigidity of a strip cut along the warp or the weft, by small deflections.
//
// Out of the plane a flat sheet's forces are linear (bending_stiffness.hpp).  A strip clamped at
// one end sags by w under a load; so does the same mesh with the same rigidity D both ways, by w_iso.  Realised: D w_iso / w.
#pragma once
#include "support/bending_stiffness.hpp"
#include "support/fabrics.hpp"

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

namespace toile::internal::test {

enum class StripAlong { u, v };

// Mean deflection of the free end under a load per area; the strip begins at coordinate 0 and is clamped over `held_m`.
inline double end_deflection(const ClothModel& model, StripAlong along, double length_m, double held_m) {
  const auto n = static_cast<Eigen::Index>(model.particle_count());
  std::vector<Vec2> uv(static_cast<std::size_t>(n));
  for (std::size_t t = 0; t < model.mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) uv[static_cast<std::size_t>(model.mesh.triangles[t][c])] = model.mesh.uv[t][c];
  }
  Vec3s flat;
  for (const Vec2& p : uv) flat.emplace_back(p.x(), 0, -p.y());
  Eigen::MatrixXd K = bending_stiffness(model, flat);
  const auto coordinate = [&](Eigen::Index i) {
    const Vec2& p = uv[static_cast<std::size_t>(i)];
    return along == StripAlong::u ? p.x() : p.y();
  };
  Eigen::VectorXd load(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    load[i] = model.mass_kg[static_cast<std::size_t>(i)];
    if (coordinate(i) > held_m) continue;
    K.row(i).setZero();
    K.col(i).setZero();
    K(i, i) = 1;
    load[i] = 0;
  }
  const Eigen::VectorXd w = K.ldlt().solve(load);
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (coordinate(i) > length_m - 1e-9) sum += w[i], ++count;
  }
  EXPECT_GT(count, 1);
  return sum / count;
}

// The rigidity along the strip, N m, of a cloth with D_u and D_v.
inline double realised_rigidity(const ClothMesh& mesh, StripAlong along, double length_m, double held_m, double D_u,
                                double D_v) {
  Fabric fabric = test::elastic_cotton();
  fabric.bend_u_N_m = D_u;
  fabric.bend_v_N_m = D_v;
  const double w = end_deflection(build_model(mesh, {&fabric, 1}), along, length_m, held_m);
  fabric.bend_u_N_m = fabric.bend_v_N_m = 1e-5;
  return 1e-5 * end_deflection(build_model(mesh, {&fabric, 1}), along, length_m, held_m) / w;
}

}  // namespace toile::internal::test
