#include "step/drag.hpp"

#include <algorithm>

namespace toile::internal {

void append_springs(const Drag& drag, const ClothState& state, double t_s, double h_s,
                    std::vector<LinearSpring>& springs) {
  LinearSpring spring;
  Vec3 p = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    if (drag.particle[k] < 0) continue;
    spring.particle[k] = drag.particle[k];
    spring.weight[k] = drag.weight[k];
    p += drag.weight[k] * state.x[static_cast<std::size_t>(drag.particle[k])];
  }
  const Vec3 start = drag.target(t_s), end = drag.target(t_s + h_s);
  const double distance = (end - p).norm();
  const double share =
      drag.stiffness_N_per_m * distance > drag.max_force_N ? drag.max_force_N / (drag.stiffness_N_per_m * distance) : 1;
  spring.stiffness_N_per_m = share * drag.stiffness_N_per_m;
  spring.damping_N_s_per_m = share * drag.damping_N_s_per_m;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    spring.direction = Vec3::Unit(axis);
    spring.force_N = spring.stiffness_N_per_m * (start - p)[axis];
    spring.body_displacement_m = (end - start)[axis];
    springs.push_back(spring);
  }
}

}  // namespace toile::internal
