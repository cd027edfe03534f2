#include "dress/tangles.hpp"

#include "contact/intersection_contours.hpp"

#include <algorithm>

namespace toile::internal {
namespace {

constexpr double guarded_again = 0.1;                   // from here the thickness grows
constexpr int unguarded_while_worn = 2;                 // of particles around a crossing
constexpr int looks_per_ring = 4, most_more_rings = 6;  // without progress
constexpr double largest_part = 0.1;     // of a surface that may be swept: a larger part did not pass through
constexpr double drag_N_s_per_m = 5;     // per point of a contour; as much again per look without progress, up to
constexpr int most_drag = 20;            // times as much: the last creases are held shut by their threads
constexpr double moves_in_s = 1.0 / 30;  // the time for a move: it goes no faster
constexpr int patience = 20;             // looks without progress until contours are pushed another way
constexpr int ways_while_worn = 3;

}  // namespace

Tangles::Tangles(const Topology& topology, std::span<const Triangle> triangles)
    : topology_(&topology), triangles_(triangles) {}

void Tangles::find(const Vec3s& x) {
  if (over_) return;
  springs_.clear();
  unguarded_.assign(x.size(), 0);
  if (!finder_) finder_.emplace(*topology_, triangles_, triangles_.size(), x.size());
  const std::vector<SurfaceCrossing> crossings = std::move(finder_->find(x).all);
  over_ = crossings.empty();
  any_ = !over_;
  if (over_) {
    waited_ = 0;
    fewest_ = 0;
    finder_.reset();
    return;
  }
  if (!push_) {
    first_pushed_ = x;
    push_.emplace(*topology_, triangles_, first_pushed_);
    for (const Edge& e : topology_->edges) edge_m_ += (x[at(e.a)] - x[at(e.b)]).norm();
    edge_m_ /= static_cast<double>(topology_->edges.size());
  }
  ++waited_;
  if (fewest_ == 0 || crossings.size() < fewest_) {
    fewest_ = crossings.size();
    waited_ = 0;
  }
  for (const SurfaceCrossing& crossing : crossings) mark_particles(crossing, triangles_, unguarded_);
  for (const IntersectionContour& contour : trace_contours(*topology_, triangles_, crossings))
    push(contour, crossings, x);
  push_->regions().grow(unguarded_, unguarded_while_worn + std::min(waited_ / looks_per_ring, most_more_rings));
}

void Tangles::push(const IntersectionContour& contour, std::span<const SurfaceCrossing> crossings, const Vec3s& x) {
  const auto way =
      gently_ ? ContourPush::Way::gently : static_cast<ContourPush::Way>(waited_ / patience % ways_while_worn);
  (*push_)(contour, crossings, x, way, edge_m_, largest_part, unguarded_,
           [&](const ContourPull& point, const Vec3& move_m) {
             const double length_m = move_m.norm();
             if (!(length_m > 0)) return;
             LinearSpring drag = spring_along(point, move_m);
             drag.damping_N_s_per_m = drag_N_s_per_m * std::min(1 + waited_, most_drag);
             drag.force_N = drag.damping_N_s_per_m * length_m / moves_in_s;
             springs_.push_back(drag);
           });
}

void Tangles::switch_off(std::vector<double>& thickness_scale) const {
  for (std::size_t i = 0; i < thickness_scale.size(); ++i) {
    if (any_ && unguarded_[i] != 0) {
      thickness_scale[i] = 0;
    } else if (thickness_scale[i] == 0) {
      thickness_scale[i] = guarded_again;
    }
  }
}

void Tangles::append_springs(std::vector<LinearSpring>& springs) const {
  springs.insert(springs.end(), springs_.begin(), springs_.end());
}

}  // namespace toile::internal
