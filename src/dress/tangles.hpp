// dress/tangles.hpp: places where cloth passes through cloth when a run begins, or when the body lets go of it.           (L4)
//
// The safe filter keeps every pair on the side where it is, which would hold a crossing for good.  Around each
// contour contact is therefore switched off, and drag pushes it the way that takes least (dress/contour_push.hpp) until it is gone;
// then the particles are guarded like all others, thinly at first.  (Sewing only switches off, and does not look again: what it
// leaves so, the first frame of the drape gives back.)
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

  // Looks for crossings at x.  After a look that found none it does nothing, until it is told to: the filter lets no new ones come.
  void find(const Vec3s& x);
  // What the body pinches is not guarded (step/flypaper.hpp); while it does, no progress is expected.
  void look_again() {
    over_ = false;
    fewest_ = 0;
  }
  bool any() const { return any_; }
  // Sets the scale of the particles around them to 0 (ContactRows::set_thickness_scale), and gives those that were 0 and
  // have no crossing beside them any more a tenth.
  void switch_off(std::vector<double>& thickness_scale) const;
  // What pushes them apart from now to the next look.
  void append_springs(std::vector<LinearSpring>& springs) const;

  // Between two looks (core/state_archive.hpp).
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
  bool over_ = false, any_ = false;
  std::size_t fewest_ = 0;  // crossings of all looks since there were none, or the body pinched
  int waited_ = 0;          // looks since then
};

}  // namespace toile::internal
