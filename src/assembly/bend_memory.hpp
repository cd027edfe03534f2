// assembly/bend_memory.hpp: what the triangles of a cloth remember of their bends.                      [material/bend_hysteresis.hpp]
//
// A remembered curvature S_0 of a triangle turns its sides by phi = B S_0, as one at rest would, and a fold angle at rest is the sum of both sides':
//
//   C_h = theta - theta_0 - (B S_0)_of both triangles          B = A W^T of plate.hpp
//
// A triangle's own curvature, which is what it remembers next, follows from its moments: S = B^-1 F m + S_0.  Beside a fold that is being pressed,
// whose theta_0 changes, it remembers nothing: what is ironed has no bend of before.
#pragma once
#include "assembly/cloth_model.hpp"

#include <span>
#include <vector>

namespace toile::internal {

class BendMemory {
 public:
  explicit BendMemory(const ClothModel& model);

  // turned[h] -= what hinge h is turned by at rest.
  void subtract_rest(std::span<double> turned_rad) const;
  // After a step of h_s, at whose end the hinges have the moments m.
  void follow(const ClothModel& model, std::span<const double> m_N_m, double h_s);

  const BentCurvature& of(Index triangle) const { return bent_[at(triangle)]; }

  template <class Archive>
  void remember(Archive& archive) {
    archive.fixed(bent_);
    archive.fixed(pressed_rad_);
    for (std::size_t t = 0; t < bent_.size(); ++t) find_turns(t);
  }

 private:
  struct Side {
    Index triangle = -1;
    Eigen::Index k = 0;
  };
  std::vector<Mat3> B_;                      // [triangle]
  std::vector<std::array<Index, 3>> hinge_;  // [triangle][side], -1: free
  std::vector<std::array<Side, 2>> sides_;   // [hinge]
  std::vector<BendHysteresis> of_triangle_;  // [triangle]
  std::vector<BentCurvature> bent_;          // [triangle]
  std::vector<Vec3> turns_;                  // [triangle] B S_0
  std::vector<double> pressed_rad_;          // [hinge] theta_0 of the last step
  void find_turns(std::size_t triangle);
};

}  // namespace toile::internal
