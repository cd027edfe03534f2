// dress/contour_push.hpp: where a contour of cloth with cloth is to be pushed so that it goes away.                    (L4)
//
//   a contour that cuts something off   over the part that takes least to sweep, by both surfaces     contact/contour_motion
//   one that cuts nothing off           shorter
//
// What pushes, springs in a trial or drag in a run, is its caller's.
#pragma once
#include "assembly/implicit_row.hpp"
#include "contact/contour_motion.hpp"

#include <functional>
#include <span>
#include <vector>

namespace toile::internal {

// `all`: triangles of the cloth, and of a body behind them (contact/intersection_contours.hpp).  All are kept by reference.
class ContourPush {
 public:
  enum class Way { cheapest, shorter_too, other_side };  // cheapest: of the two parts that it cuts off

  ContourPush(const Topology& topology, std::span<const Triangle> all, std::span<const Vec3> x);

  // Calls pull(point, move) with moves of about 0.6 `edge_m`, the mean edge of the cloth, and marks the particles of the
  // part that is swept over; one larger than `largest_part` of its surface is not.  Returns what is left to do, m^2.
  using Pull = std::function<void(const ContourPull&, const Vec3& move_m)>;
  double operator()(const IntersectionContour& contour, std::span<const SurfaceCrossing> crossings,
                    std::span<const Vec3> x, Way way, double edge_m, double largest_part, std::vector<char>& marked,
                    const Pull& pull);

  const SurfaceRegions& regions() const { return regions_; }

 private:
  const Topology* topology_;
  std::span<const Triangle> all_;
  SurfaceRegions regions_;
};

// Between the point's particles, along a move of it that is not zero: what pulls is for the caller to fill in.
LinearSpring spring_along(const ContourPull& point, const Vec3& move_m);

// Marks the particles of a crossing's edge and triangle.
void mark_particles(const SurfaceCrossing& crossing, std::span<const Triangle> triangles, std::vector<char>& marked);

}  // namespace toile::internal
