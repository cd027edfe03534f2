// sim/tangles.hpp: places where cloth passes through cloth already when a run begins, or when the body lets go of it.
//
// The safe filter keeps every pair on the side where it is, which would hold a crossing for good.  Around each
// crossing contact is therefore switched off, so that bending can open it; once it is gone the particles are guarded
// like all others, thinly at first.  (Sewing does not look again: what it leaves off, the first frame of the drape gives
// back.)
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile {

class Tangles {
 public:
  // Looks for crossings at x.  After a look that found none it does nothing, until it is told to: the filter lets no new ones come.
  void find(std::span<const Triangle> triangles, const Vec3s& x);
  // What the body pinches is not guarded (step/flypaper.hpp).
  void look_again() { over_ = false; }
  bool any() const { return !places_.empty(); }
  // Sets the scale of the particles around them to 0 (ContactRows::set_thickness_scale), and gives those that were 0 and
  // have no crossing beside them any more a tenth.
  void switch_off(const Vec3s& x, std::vector<double>& thickness_scale) const;

 private:
  std::vector<Vec3> places_;
  std::vector<char> crossing_;  // [particle] of an edge or a triangle that crosses: it may be long
  bool over_ = false;
};

}  // namespace toile
