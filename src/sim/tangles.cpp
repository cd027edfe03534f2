#include "sim/tangles.hpp"

#include "verify/crossings.hpp"

#include <algorithm>

namespace toile {
namespace {

constexpr double radius_m = 0.03;

}  // namespace

void Tangles::find(std::span<const Triangle> triangles, const Vec3s& x) {
  if (over_) return;
  places_.clear();
  for (const Crossing& crossing : find_cloth_crossings(triangles, x)) places_.push_back(crossing.position);
  over_ = places_.empty();
}

void Tangles::switch_off(const Vec3s& x, std::vector<double>& thickness_scale) const {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::any_of(places_.begin(), places_.end(), [&](const Vec3& p) { return (x[i] - p).norm() < radius_m; }))
      thickness_scale[i] = 0;
  }
}

}  // namespace toile
