#include "assembly/pressure.hpp"

#include "core/parallel.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace toile::internal {
namespace {

constexpr std::size_t pressure_grain = 512;  // triangles per block of work

}  // namespace

bool Pressure::acts(double end_s) {
  std::fill(panel_Pa_.begin(), panel_Pa_.end(), 0);
  of_panels_(end_s, panel_Pa_);
  return std::any_of(panel_Pa_.begin(), panel_Pa_.end(), [](double Pa) { return Pa != 0; });
}

void Pressure::prepare(const ClothModel& model, const BlockPattern&) {
  triangles_ = model.mesh.triangles;
  panel_ = model.mesh.panel;
  at_corner_.resize(triangles_.size());
}

void Pressure::evaluate(const ClothState& state, double) {
  parallel_for(triangles_.size(), pressure_grain, [&](std::size_t t) {
    const auto& [i, j, k] = triangles_[t];
    const Vec3& x = state.x[at(i)];
    at_corner_[t] = (panel_Pa_[at(panel_[t])] / 6) * (state.x[at(j)] - x).cross(state.x[at(k)] - x);
  });
}

void Pressure::add_forces(std::span<Vec3> f) const {
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const Index corner : triangles_[t]) f[at(corner)] += at_corner_[t];
}

}  // namespace toile::internal
