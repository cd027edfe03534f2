// step/safe_filter.hpp: corrects the end of a step so that cloth does not pass through cloth or the body.          (L3)
//
//   1  impacts on the straight motion from the state to the candidate (contact/impacts.hpp, contact/body_impacts.hpp)
//   2  at most 4 rounds of 3 sweeps, earliest impact first: inelastic impulses without friction that bring the gap of
//      the pair at the end to min(r/4, max(d_0, r/50)).  Every round searches for impacts anew.
//      Pinned particles and those on the body have infinite mass.  Where all particles of a pair have, as in layers
//      that a crease of the body presses together, those pinched with room move.  Against the body only pins have
//      infinite mass, since cloth that touches the body may always be moved away.  An edge with one such end, hit near
//      it, would throw its other end: no particle moves farther than four times the correction of the pair.
//   3  impacts left: the step is refused and halved by the caller; so is one with too many impacts to be worth
//      correcting
//   4  where a step may not be shorter, motion is clipped by impact zones: particles joined by impacts move by
//            m + s (u - m),   u their displacement, m the zone's mean, s = 0.9 x the zone's earliest impact,
//      so their relative motion is part of one that was free.  Pairs across zones are tested again and merge them.
//      The body is not stopped: pinched cloth, or cloth clipped before the body, may end within it.
//
// It works on positions after the solve: the paper's step is untouched.  Velocities are the caller's business.
//
// Easily got wrong: pairs that intersect already would be kept so; their particles must have contact_m = 0.
#pragma once
#include "contact/body_impacts.hpp"
#include "core/disjoint_sets.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct FilterReport {
  int impacts = 0;        // in the motion to the candidate
  int left = 0;           // of cloth with cloth, after the last round; 0 once motion is clipped
  int body_left = 0;      // of cloth with the body, at the end
  int rounds = 0;         // of impulses
  int corrected = 0;      // particles moved
  int truncated = 0;      // particles of zones whose motion was clipped
  bool hopeless = false;  // more than most_impacts: given up; `left` and `body_left` are the counts so far
};

// The velocity of a particle that moves by `moved_m` in a step of h_s with the alteration y.  Only the part of y that
// was carried out is excluded; excluding all of y would throw back a particle whose motion was clipped.
Vec3 velocity_of_motion(const Vec3& moved_m, const Vec3& y_m, double h_s);

// The share of a correction in a step of h_s that counts as velocity: the part that stops the particle, and the part
// that the longest step would have given it.  The length of a correction does not depend on h: all of it would be 100 m/s in 16 us.
double counted_share(const Vec3& correction_m, const Vec3& v_m_per_s, double h_s, double base_h_s);

class SafeFilter {
 public:
  // Moves `end` where needed.  `inverse_mass` per particle in 1/kg, 0 for constrained ones; `contact_m` is r per
  // particle (0: not guarded; empty: none is).  With `truncate` the result has no impacts of cloth with cloth; without
  // it `left` may be positive.  `before_body`: inverse masses against the body; without a guard there is no body.
  // `pinched` [particle], or empty: exempts pairs (contact/pinched.hpp).  `near`: as in find_impacts.
  FilterReport operator()(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                          std::span<const double> inverse_mass, std::span<const double> contact_m, bool truncate,
                          std::span<Vec3> end, const BodyGuard* guard = nullptr,
                          std::span<const double> before_body = {}, std::span<const Pinched> pinched = {},
                          const FeaturePairs* near = nullptr);

  // The impacts of cloth with cloth left by the last call without `truncate`.
  std::span<const Impact> left() const { return impacts_; }
  // Those of cloth with the body; indices from the number of cloth particles on are the body's vertices.
  std::span<const Impact> left_with_body() const { return body_impacts_; }
  // [particle] moved by the last call.
  std::span<const char> moved() const { return moved_; }

 private:
  void push_apart(std::span<const double> inverse_mass, std::span<const double> before_body,
                  std::span<const Pinched> pinched, const BodyGuard* guard, std::span<Vec3> end);
  void cut_short(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                 std::span<const double> inverse_mass, std::span<const double> contact_m,
                 std::span<const Pinched> pinched, const FeaturePairs* near, std::span<Vec3> end, FilterReport& report);

  ImpactWorkspace workspace_;
  BodyImpactWorkspace body_workspace_;
  std::vector<Impact> impacts_, body_impacts_;
  std::vector<std::size_t> order_;
  std::vector<char> moved_;
  DisjointSets zones_;
  Vec3s whole_;  // the candidate before its motion was clipped
};

}  // namespace toile::internal
