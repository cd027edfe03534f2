// assembly/plate_moments.hpp: the bending moments of a cloth's hinges, from their fold angles.      [material/plate.hpp]
//
//   F m = C        C_h = theta - theta_0 of hinge h;  m_h its moment;  F the sum of the triangles' compliances
//
// Each hinge meets the four others of its two triangles.  An edge without a hinge is free: its moment is zero and it takes no part.
// E = C.m/2, and the force on the corners of a hinge is -m_h g_h (bend.hpp): nothing else differs from a hinge by itself, m = kappa C.
#pragma once
#include "assembly/cloth_model.hpp"

namespace toile::internal {

class PlateMoments {
 public:
  explicit PlateMoments(const ClothModel& model);

  void pack(const ClothModel& model);  // again, after the model's compliances have changed
  // m of hinges folded by C, to a millionth.
  void solve(std::span<const double> C_rad, std::span<double> m_N_m);

 private:
  struct Row {
    double diagonal = 1;
    std::array<double, 4> entry{};
    std::array<Index, 4> other{};  // itself with an entry of zero where there is none
  };
  std::vector<Row> rows_;
  std::vector<double> r_, p_, q_, sums_;
};

// What stands for dm/dC in the matrix of a step: one number per hinge, no smaller than F^-1 in any motion.  By Gershgorin's circles of
// every triangle's F^-1 with its angles shared evenly by both sides, which is stiffer than F^-1.
std::vector<double> plate_bounds_N_m(const Topology& topology, std::span<const Mat3> compliance);

// [triangle][side]: the hinge there, or -1.
std::vector<std::array<Index, 3>> hinges_of_sides(const Topology& topology);

}  // namespace toile::internal
