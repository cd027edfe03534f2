// contact/crossing_finder.hpp: all edges of a surface that pass through one of its triangles; for steering a run.
//
// Of cloth with itself, and of cloth with a body whose particles and triangles follow the cloth's in one mesh (as in
// contact/intersection_contours.hpp).  The body is not tested against itself.  Pairs that share a particle are not
// tested: two triangles that cross and share one do so through an edge that shares nothing with the other.
//
// Positions are rounded to multiples of 2^-60 of the power of two of the largest coordinate of the cloth and of the
// nearby body.  That is exact for a double that is not 256 times smaller, and else errs by 1e-18 m in a scene of
// 2 m.  About the rounded mesh every answer is exact.  Degenerate positions are resolved for the whole mesh at once
// (contact/whole_orientation.hpp), a particle's rank being its index.  So a proper crossing is always found, separate
// features never count as one, and a surface pierced through an edge or a particle is pierced once: contours have no
// loose ends.
//
// Easily got wrong: this is not the judge.  The verdict has a finder of its own, with its own tree and arithmetic
// (src/verify), and neither may use the other's (the test `layers`), so that each can show what the other overlooks.
#pragma once
#include "contact/intersection_contours.hpp"
#include "contact/triangle_tree.hpp"

#include <span>
#include <vector>

namespace toile::internal {

struct FoundCrossings {
  std::vector<SurfaceCrossing> all;  // of cloth with cloth, then of cloth with the body; each by (edge, triangle)
  std::size_t of_cloth = 0;          // number of crossings of cloth with cloth
};

class CrossingFinder {
 public:
  // `topology` is that of all `triangles`.  The first `cloth_triangles` triangles and `cloth_particles` particles are
  // the cloth's.  Topology and triangles must outlive this object.
  CrossingFinder(const Topology& topology, std::span<const Triangle> triangles, std::size_t cloth_triangles,
                 std::size_t cloth_particles);
  CrossingFinder(const Topology&&, std::span<const Triangle>, std::size_t, std::size_t) = delete;

  // Depends on x alone, not on earlier calls.  Throws InputError for a position that is not finite.
  FoundCrossings find(std::span<const Vec3> x);

 private:
  struct Side {                        // the cloth or the body, with its own indices
    Index triangle = 0, particle = 0;  // its first in the whole mesh
    std::vector<Triangle> triangles;
    TriangleTree tree;
  };
  void refit(std::span<const Vec3> x);
  void test(const Side& of_edges, Index a, const Side& of_triangles, Index b, std::span<const Vec3> x,
            std::vector<SurfaceCrossing>& found) const;
  template <class Work>
  void run_tasks(std::vector<SurfaceCrossing>& found, Work&& work) const;

  std::span<const Triangle> triangles_;
  std::vector<std::uint8_t> owned_;  // [triangle] bit k: of the triangles with its side k, it is the one that tests it
  Side cloth_, body_;
  Vec3s whole_, next_whole_;  // positions in multiples of the step
  std::vector<TreeTask> tasks_;
};

// For a single query.  `body` may be empty; it is numbered from 0, and follows the cloth in the result.
FoundCrossings find_crossings(std::span<const Triangle> cloth, std::span<const Vec3> x, std::span<const Triangle> body,
                              std::span<const Vec3> body_x);

// The triangles of the cloth, then those of the body with particles numbered from `particles` on.
std::vector<Triangle> joined_triangles(std::span<const Triangle> cloth, std::size_t particles,
                                       std::span<const Triangle> body);

// The number of different edges in a list that is sorted by edge.
int count_crossing_edges(std::span<const SurfaceCrossing> crossings);

}  // namespace toile::internal
