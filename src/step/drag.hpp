// step/drag.hpp: the user's hand: a damped spring from a point of the cloth to a moving target.         [BW98 4.4]
//
//   p = sum_k weight_k x_k       d = target - p
//   F = k_s d + c (k_s/k) (target's velocity - p'),      k_s = min( k, max / |d| )      at the end of the step
//
// Three rows of the implicit system (assembly/implicit_row.hpp): no stiffness overshoots within a step.
//
// Easily got wrong: max_force_N limits the spring by its length at the start of the step.  A point that moves away
// within a step feels a larger force until the next.
#pragma once
#include "assembly/cloth_model.hpp"
#include "assembly/implicit_row.hpp"

#include <functional>
#include <limits>
#include <vector>

namespace toile::internal {

struct Drag {
  std::array<Index, 3> particle{-1, -1, -1};  // corners of a triangle, or one particle; -1: unused
  std::array<double, 3> weight{1, 0, 0};      // barycentric
  std::function<Vec3(double t_s)> target;     // m
  double stiffness_N_per_m = 50;              // k > 0
  double damping_N_s_per_m = 0.5;             // c
  double max_force_N = 5;                     // infinity: no limit
};

// Appends the rows for a step from t_s to t_s + h_s.
void append_springs(const Drag& drag, const ClothState& state, double t_s, double h_s,
                    std::vector<LinearSpring>& springs);

}  // namespace toile::internal
