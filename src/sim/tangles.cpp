#include "sim/tangles.hpp"

#include "verify/crossings.hpp"

#include <algorithm>

namespace toile {
namespace {

constexpr double radius_m = 0.03;
constexpr double guarded_again = 0.1;  // from here the thickness grows

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

void Tangles::find(std::span<const Triangle> triangles, const Vec3s& x) {
  if (over_) return;
  places_.clear();
  crossing_.assign(x.size(), 0);
  for (const Crossing& crossing : find_cloth_crossings(triangles, x)) {
    places_.push_back(crossing.position);
    for (const Index i : crossing.edge) crossing_[at(i)] = 1;
    for (const Index i : triangles[at(crossing.triangle)]) crossing_[at(i)] = 1;
  }
  over_ = places_.empty();
}

void Tangles::switch_off(const Vec3s& x, std::vector<double>& thickness_scale) const {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto beside = [&](const Vec3& p) { return (x[i] - p).norm() < radius_m; };
    if (any() && (crossing_[i] != 0 || std::any_of(places_.begin(), places_.end(), beside))) {
      thickness_scale[i] = 0;
    } else if (thickness_scale[i] == 0) {
      thickness_scale[i] = guarded_again;
    }
  }
}

}  // namespace toile
