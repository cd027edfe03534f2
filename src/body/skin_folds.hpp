// body/skin_folds.hpp: skin that yields where it is folded onto itself.
//
// Blended skin does not know flesh: in the armpit of a hanging arm, or the bend of an elbow, it passes into itself by some millimetres, and cloth
// there has nowhere to be.  Flesh yields: where skin faces skin nearer than cloth needs, each moves half of what is missing into its own body,
//   x' = x - h n,   h = min(largest, sum over passes of (room - gap) / 2)       n: vertex normal of the blended skin
// gap: along n to the faces that look back; negative within another part.  h is found at 30 poses a second or more, by 3 passes, and is in
// time the mean of the largest about, so that it has no corners.  What is near at rest already keeps that distance: the body at rest is its file's.
//
// largest: 1 % of the height, and a quarter of the limb.  Deeper is no fold: cloth is pinched there (step/flypaper.hpp).
#pragma once
#include "body/limb_clearance.hpp"

#include <span>
#include <vector>

namespace toile::internal {

class SkinFolds {
 public:
  SkinFolds() = default;  // none
  SkinFolds(const PosedBody& body, double room_m, const PoseTrack& track);

  // Of blended skin at a time of the track; `share`: of the way from rest.
  void yield(double track_s, double share, std::span<Vec3> x) const;

  double deepest_m() const { return deepest_m_; }

 private:
  double depth(std::size_t k, double track_s) const;

  std::vector<Index> vertices_;             // that ever yield
  std::vector<std::vector<Index>> around_;  // [k] the triangles of vertices_[k]
  std::vector<Triangle> triangles_;
  std::vector<double> depth_m_;  // [sample][k]
  std::size_t samples_ = 0;
  double rate_hz_ = 0, deepest_m_ = 0;
  bool loops_ = false;
};

}  // namespace toile::internal
