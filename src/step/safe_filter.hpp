// step/safe_filter.hpp: the end of a step, corrected so that cloth does not pass through cloth or the body.        (L3)
//
//   1  impacts on the straight way from the state to the candidate (contact/impacts.hpp, contact/body_impacts.hpp)
//   2  at most 4 rounds of 3 sweeps, earliest impact first: inelastic impulses without friction that bring the pair's
//      gap at the end to min(r/4, max(d_0, r/50));  particles that are held (pins, body) have infinite mass, the body has too,
//      and against it only pins do: what it touches may always be moved away from it.  Layers that a crease of the body presses together are all held: of these, what has
//      room moves.  Of an edge held at one end, and met near
//      it, the other end would fly: none goes farther than four times what the pair is moved apart
//      every round looks for impacts anew
//   3  impacts left: the step is refused and halved by its caller; so is one with more impacts than are worth correcting
//   4  where a step may not be shorter, zones are cut short: particles joined by impacts move by
//            m + s (u - m),   u their displacement, m the zone's mean, s = 0.9 x the zone's earliest impact,
//      so their relative motion shrinks to what was found free.  Pairs across zones are asked again and join them.
//      The body goes where it goes: cloth that it pinches, or that is cut short before it, may end within it.
//
// Works on positions after the solve: the paper's step is untouched.  Velocities are the caller's business.
//
// Easily got wrong: pairs that intersect already would be kept so; their particles must have contact_m = 0.
#pragma once
#include "contact/body_impacts.hpp"
#include "core/disjoint_sets.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct FilterReport {
  int impacts = 0;        // on the way to the candidate
  int left = 0;           // of cloth with cloth, after the last round; 0 once zones are cut short
  int body_left = 0;      // of cloth with the body, in the end
  int rounds = 0;         // of impulses
  int corrected = 0;      // particles that were moved
  int truncated = 0;      // particles in zones that were cut short
  bool hopeless = false;  // more impacts than most_impacts: it gave up, `left` and `body_left` are what was counted
};

// Velocity of a particle that moves by `moved_m` in a step of h_s in which it was to be altered by y.  Only the part of y that was
// carried out is no velocity; the rest, of a motion that was cut short, would throw the particle back.
Vec3 velocity_of_motion(const Vec3& moved_m, const Vec3& y_m, double h_s);

// Of a correction in a step of h_s, the share that counts as velocity: what stops the particle, and what the longest step would have
// given it.  A pair is moved apart by as much in however short a step, so that all of it would throw cloth at 100 m/s in 16 us.
double counted_share(const Vec3& correction_m, const Vec3& v_m_per_s, double h_s, double base_h_s);

class SafeFilter {
 public:
  // Moves `end` where needed.  `inverse_mass` per particle in 1/kg, 0 where it is held; `contact_m` is r per particle
  // (0: not guarded; empty: none is).  With `truncate` the result is free of impacts of cloth with cloth, without it `left` may
  // be positive.  `before_body` are the inverse masses against the body; without a guard there is no body.
  // `pinched` [particle], or empty: pairs that are let be are not looked at (contact/pinched.hpp).  `near`: as find_impacts has it.
  FilterReport operator()(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                          std::span<const double> inverse_mass, std::span<const double> contact_m, bool truncate,
                          std::span<Vec3> end, const BodyGuard* guard = nullptr,
                          std::span<const double> before_body = {}, std::span<const Pinched> pinched = {},
                          const FeaturePairs* near = nullptr);

  // Of the last call without `truncate`: the impacts of cloth with cloth that are left.
  std::span<const Impact> left() const { return impacts_; }
  // Those of cloth with the body; particles from the cloth's number on are the body's.
  std::span<const Impact> left_with_body() const { return body_impacts_; }
  // [particle] of the last call: moved.
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
  Vec3s whole_;  // the candidate before zones were cut
};

}  // namespace toile::internal
