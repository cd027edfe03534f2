// contact/impacts.hpp: features of the cloth that would pass through each other on a straight motion.       (L0 and L3)
//
//   x(t) = start + t (end - start),  0 <= t <= 1
//   xi   = min(0.1 r, max(0.5 d_0, min(1 um, 0.999 d_0)))
//         separation that a pair keeps: r its contact distance, d_0 its distance at the start
//
// A pair pressed harder than contact can bear loses half of its gap in every step.  Without the floor the gap shrinks
// to the rounding of the files, 10 nm, and the pair changes sides.
//
// Every vertex-face and edge-edge pair that does not touch (share a merged particle) and whose swept boxes meet is
// decided by additive CCD (contact/ccd.hpp); most by one distance, because their relative motion is shorter than it.
//
// Easily got wrong: a pair that already intersects has a distance like any other, and would be kept on its wrong side
// for good.  The caller exempts such particles by r = 0.
#pragma once
#include "contact/pinched.hpp"
#include "contact/proximity.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace toile::internal {

struct Impact {
  ContactKind kind;               // vertex_face: (vertex, corners);  edge_edge: (ends, ends)
  std::array<Index, 4> particle;  // of one cloth
  std::array<double, 4> weight;   // of the closest points at the impact; sums to 0
  Vec3 normal;                    // unit, there, from the second feature to the first
  double time;                    // 0 ... 1
  double start_gap_m, contact_m;  // d_0 and r
  double separation_m;            // xi
};

// Memory kept between queries.
struct ImpactWorkspace {
  std::vector<TreeTask> tasks;
  std::vector<std::vector<Impact>> found;  // by task, or by block of features
  std::vector<Vec3> displacement_m;
  ParticleBoxes boxes;
};

// Number of impacts above which a motion is not worth correcting: cloth was thrown through cloth, or through the body.
inline constexpr std::size_t few_impacts = 20'000;
inline std::size_t most_impacts(std::size_t particles) { return few_impacts + 4 * particles; }
// A task of cloth with cloth stops at a number of its own: a hundred tasks going on to most_impacts would fill the
// memory.
inline std::size_t most_impacts_of_a_task(std::size_t particles) {
  return std::max(few_impacts, most_impacts(particles) / 8);
}
// Collects the impacts of all tasks, sorted by (kind, particles).  Returns false, and stops, at more than most_impacts
// of all, or `of_a_task` of one.
[[nodiscard]] bool gather_impacts(std::span<const std::vector<Impact>> found, std::size_t particles,
                                  std::size_t of_a_task, std::vector<Impact>& impacts);

// All impacts, sorted by (kind, particles).  `contact_m` is r per particle, and a pair takes the least of its four; 0
// exempts it, and so does is_exempt (contact/pinched.hpp; `pinched` per particle, or empty).  Of `tree` only the
// hierarchy is used; its boxes become those of the motion.  `pairs`: lists used where they are valid; the impacts are
// the same without.  Returns false when there are more than most_impacts, or far too many in one place: then the list
// is incomplete.
[[nodiscard]] bool find_impacts(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                                std::span<const Vec3> end, std::span<const double> contact_m,
                                ImpactWorkspace& workspace, std::vector<Impact>& impacts,
                                std::span<const Pinched> pinched = {}, const FeaturePairs* pairs = nullptr);

inline constexpr double separation_share = 0.1;  // of r: the largest xi

// Finds the impact of one pair whose corners x move by u.  Particle, kind and contact_m are those of `impact`; the rest
// is filled in.  Returns false if there is none.  A pair that coincides at the start has no side to be kept on, and
// none.
bool decide_impact(const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, Impact& impact);

// The time at which this pair meets on another motion, as Impact::time, or no_impact.
double impact_time(const Impact& pair, std::span<const Vec3> start, std::span<const Vec3> end);

}  // namespace toile::internal
