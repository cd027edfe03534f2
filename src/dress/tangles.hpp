// dress/tangles.hpp: resolves crossings of cloth with cloth from the start of a run, or out of a pinch.                   (L4)
//
// The safe filter keeps every pair on its side, which would make a crossing permanent.  Around each contour contact is
// therefore switched off, and drag pushes it the cheapest way (dress/contour_push.hpp) until it is gone; then the particles are
// guarded like all others, with a small thickness at first.  (Sewing only switches contact off; the first frame of the drape
// switches it on again.)
#pragma once
#include "assembly/implicit_row.hpp"
#include "contact/crossing_finder.hpp"
#include "dress/contour_push.hpp"
#include "mesh/topology.hpp"

#include <optional>
#include <span>
#include <vector>

namespace toile::internal {

class Tangles {
 public:
  // Both are kept by reference.
  Tangles(const Topology& topology, std::span<const Triangle> triangles);

  // Looks for crossings at x.  After a look that found none it does nothing until requested: the filter prevents new ones.
  void find(const Vec3s& x);
  // Pinched cloth is not guarded (step/flypaper.hpp); during a pinch no progress is expected.
  void look_again() {
    over_ = false;
    fewest_ = 0;
  }
  // Contours that cut nothing off are pulled no farther than their length (ContourPush::Way::gently), for as long as it is set.
  void push_gently(bool gently) { gently_ = gently; }
  bool any() const { return any_; }
  // Sets the scale of the particles around crossings to 0 (ContactRows::set_thickness_scale), and to a tenth for those that
  // were 0 and have no crossing beside them any more.
  void switch_off(std::vector<double>& thickness_scale) const;
  // The drag that pushes them apart until the next look.
  void append_springs(std::vector<LinearSpring>& springs) const;

  // The state between two looks (core/state_archive.hpp).
  template <class Archive>
  void remember(Archive& archive) {
    archive(over_, any_, fewest_, waited_, edge_m_, first_pushed_);
    archive.fixed(unguarded_);
    if constexpr (Archive::reads) {
      springs_.clear();
      push_.reset();
      if (!first_pushed_.empty()) push_.emplace(*topology_, triangles_, first_pushed_);
    }
  }

 private:
  void push(const IntersectionContour& contour, std::span<const SurfaceCrossing> crossings, const Vec3s& x);

  const Topology* topology_;
  std::span<const Triangle> triangles_;
  std::optional<CrossingFinder> finder_;  // while there are crossings
  std::optional<ContourPush> push_;       // once there is something to push
  Vec3s first_pushed_;                    // x then: areas are measured there
  double edge_m_ = 0;                     // mean
  std::vector<char> unguarded_;           // [particle]
  std::vector<LinearSpring> springs_;
  bool over_ = false, any_ = false, gently_ = false;
  std::size_t fewest_ = 0;  // the fewest crossings since there were none, or since a pinch
  int waited_ = 0;          // looks since then
};

}  // namespace toile::internal
