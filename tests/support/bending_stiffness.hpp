// tests/support/bending_stiffness.hpp: the stiffness of a flat cloth out of its plane, as a dense matrix: K = G^T H G with G = dtheta/dy,
// and H = dm/dtheta: kappa of hinges by themselves, the inverse of the compliances of plates, and finished edges.  Cloth is in the plane y = 0.
#pragma once
#include "assembly/line_moments.hpp"
#include "assembly/plate_moments.hpp"

#include <Eigen/LU>

namespace toile::internal::test {

// [hinge][particle], 1/m.
inline Eigen::MatrixXd angle_of_heights(const ClothModel& model, const Vec3s& flat) {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(model.bend.size()), model.particle_count());
  for (std::size_t h = 0; h < model.bend.size(); ++h) {
    const std::array<Index, 4>& particle = model.topology.hinges[h].particle;
    const std::array<Vec3, 4> g = hinge_angle_gradient(
        {flat[at(particle[0])], flat[at(particle[1])], flat[at(particle[2])], flat[at(particle[3])]});
    for (std::size_t k = 0; k < 4; ++k) G(static_cast<Eigen::Index>(h), particle[k]) += g[k].y();
  }
  return G;
}

// F of plate_moments.hpp, rad/(N m).
inline Eigen::MatrixXd compliance_of_hinges(const ClothModel& model) {
  const std::vector<std::array<Index, 3>> sides = hinges_of_sides(model.topology);
  const auto count = static_cast<Eigen::Index>(model.bend.size());
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t t = 0; t < sides.size(); ++t) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        const Index a = sides[t][static_cast<std::size_t>(j)], b = sides[t][static_cast<std::size_t>(k)];
        if (a >= 0 && b >= 0) F(a, b) += model.plate_compliance[t](j, k);
      }
    }
  }
  return F;
}

inline Eigen::MatrixXd bending_stiffness(const ClothModel& model, const Vec3s& flat) {
  const Eigen::MatrixXd G = angle_of_heights(model, flat);
  Eigen::VectorXd kappa(G.rows());
  for (Eigen::Index h = 0; h < kappa.size(); ++h) kappa[h] = model.bend[static_cast<std::size_t>(h)].kappa_N_m;
  Eigen::MatrixXd K = G.transpose() * kappa.asDiagonal() * G;
  if (!model.plate_compliance.empty()) K += G.transpose() * compliance_of_hinges(model).lu().solve(G);
  for (const LineBend& bend : model.line_bends) {
    Eigen::VectorXd kink = Eigen::VectorXd::Zero(model.particle_count());
    for (const LineBend::Part& part : bend.hinges) kink += part.share * G.row(part.hinge).transpose();
    K += line_stiffness_N_m(model, bend) * kink * kink.transpose();
  }
  return K;
}

// What the matrix of a step has instead.
inline Eigen::MatrixXd bending_in_matrix(const ClothModel& model, const Vec3s& flat) {
  const Eigen::MatrixXd G = angle_of_heights(model, flat);
  Eigen::VectorXd kappa(G.rows());
  for (Eigen::Index h = 0; h < kappa.size(); ++h) {
    const BendRest& rest = model.bend[static_cast<std::size_t>(h)];
    kappa[h] = rest.kappa_N_m + rest.plate_N_m;
  }
  return G.transpose() * kappa.asDiagonal() * G;
}

}  // namespace toile::internal::test
