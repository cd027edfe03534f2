// dress/contour_push.hpp: the directions that remove an intersection contour of cloth with cloth.                      (L4)
//
//   a contour that cuts a part off      over the part that is cheapest to sweep, by both surfaces     contact/contour_motion
//   one that cuts no part off           shorter
//
// The caller applies the push, by springs in a trial or by drag in a run.
#pragma once
#include "assembly/implicit_row.hpp"
#include "contact/contour_motion.hpp"

#include <functional>
#include <span>
#include <vector>

namespace toile::internal {

// `all`: triangles of the cloth, and of a body behind them (contact/intersection_contours.hpp).  All are held by reference.
class ContourPush {
 public:
  // cheapest: the cheaper of the two parts.  gently: the same, and what cuts nothing off is made shorter by half at most: the ends of a contour of
  // a few points, pulled past each other, cut anew.
  enum class Way { cheapest, shorter_too, other_side, gently };

  ContourPush(const Topology& topology, std::span<const Triangle> all, std::span<const Vec3> x);

  // Calls pull(point, move) with moves of about 0.6 `edge_m`, the mean edge of the cloth, and marks the particles of the
  // part that is swept; parts larger than `largest_part` of their surface are not.  Returns the area left to sweep, m^2.
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

// A spring between the point's particles, along a nonzero move of it; force and stiffness are the caller's to fill in.
LinearSpring spring_along(const ContourPull& point, const Vec3& move_m);

// Marks the particles of a crossing's edge and triangle.
void mark_particles(const SurfaceCrossing& crossing, std::span<const Triangle> triangles, std::vector<char>& marked);

}  // namespace toile::internal
