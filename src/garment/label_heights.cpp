#include "garment/label_heights.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double pull_N_per_m = 20, give_m = 0.02, damping_s = 0.02;

}  // namespace

LabelSprings::LabelSprings(const GarmentMesh& garment, std::span<const LabelHeight> heights) {
  for (const LabelledEdge& edge : garment.labels) {
    const auto wanted = std::find_if(heights.begin(), heights.end(),
                                     [&](const LabelHeight& height) { return height.label == edge.label; });
    if (wanted == heights.end()) continue;
    for (std::size_t k = 0; k < edge.particles.size(); ++k) {
      // Panels are placed flat and unstretched: distances there are lengths of the edge.
      double share = 0;
      if (k > 0) share += 0.5 * (garment.x[at(edge.particles[k])] - garment.x[at(edge.particles[k - 1])]).norm();
      if (k + 1 < edge.particles.size())
        share += 0.5 * (garment.x[at(edge.particles[k + 1])] - garment.x[at(edge.particles[k])]).norm();
      held_.push_back({edge.particles[k], wanted->height_m, share});
    }
  }
}

void LabelSprings::append(const ClothState& state, double strength, std::vector<LinearSpring>& springs) const {
  if (strength <= 0) return;
  for (const Held& held : held_) {
    const double away = held.height_m - state.x[at(held.particle)].y();
    const double limit = strength * pull_N_per_m * held.share_m, k = limit / give_m;
    const double force = std::clamp(k * away, -limit, limit);
    LinearSpring spring;
    spring.particle = {held.particle, -1, -1, -1};
    spring.weight = {1, 0, 0, 0};
    spring.direction = Vec3::UnitY();
    spring.force_N = force;
    spring.stiffness_N_per_m = std::fabs(away) > give_m ? std::fabs(force / away) : k;  // secant: never overshoots
    spring.damping_N_s_per_m = damping_s * spring.stiffness_N_per_m;
    springs.push_back(spring);
  }
}

LabelSprings LabelSprings::welded(std::span<const Index> particle_of) const {
  LabelSprings joined = *this;
  for (Held& held : joined.held_) held.particle = particle_of[at(held.particle)];
  return joined;
}

}  // namespace toile::internal
