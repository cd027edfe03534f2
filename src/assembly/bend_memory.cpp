#include "assembly/bend_memory.hpp"

#include "assembly/plate_moments.hpp"
#include "core/parallel.hpp"

#include <Eigen/LU>  // inverse

namespace toile::internal {
namespace {

constexpr std::size_t memory_grain = 1024;  // triangles or hinges per block of work

}  // namespace

BendMemory::BendMemory(const ClothModel& model)
    : hinge_(hinges_of_sides(model.topology)),
      sides_(model.topology.hinges.size()),
      bent_(hinge_.size()),
      turns_(hinge_.size(), Vec3::Zero()),
      pressed_rad_(sides_.size(), 0) {
  for (std::size_t t = 0; t < hinge_.size(); ++t) {
    B_.push_back(side_turns(model.mesh.uv[t]));
    of_triangle_.push_back(model.hysteresis[model.hysteresis.size() == 1 ? 0 : at(model.mesh.panel[t])]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (hinge_[t][k] < 0) continue;
      std::array<Side, 2>& sides = sides_[at(hinge_[t][k])];
      sides[sides[0].triangle < 0 ? 0 : 1] = {static_cast<Index>(t), static_cast<Eigen::Index>(k)};
    }
  }
}

void BendMemory::find_turns(std::size_t t) { turns_[t] = B_[t] * bent_[t].rest(of_triangle_[t]); }

void BendMemory::subtract_rest(std::span<double> turned) const {
  parallel_for(sides_.size(), memory_grain, [&](std::size_t h) {
    for (const Side& side : sides_[h]) turned[h] -= turns_[at(side.triangle)][side.k];
  });
}

void BendMemory::follow(const ClothModel& model, std::span<const double> m, double h_s) {
  parallel_for(bent_.size(), memory_grain, [&](std::size_t t) {
    Vec3 of_sides = Vec3::Zero();
    bool pressing = false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (hinge_[t][k] < 0) continue;
      const std::size_t h = at(hinge_[t][k]);
      of_sides[static_cast<Eigen::Index>(k)] = m[h];
      pressing |= model.bend[h].theta_0 != pressed_rad_[h];
    }
    if (pressing) {
      bent_[t] = {};
    } else {
      const Vec3 turned = model.plate_compliance[t] * of_sides + turns_[t];
      bent_[t].follow(of_triangle_[t], B_[t].inverse() * turned, h_s);
    }
    find_turns(t);
  });
  for (std::size_t h = 0; h < pressed_rad_.size(); ++h) pressed_rad_[h] = model.bend[h].theta_0;
}

}  // namespace toile::internal
