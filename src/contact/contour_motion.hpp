// contact/contour_motion.hpp: directions in which the two surfaces of an intersection contour move to remove it.
//
// 1  Shorter: the derivative of the contour's length.                           [after Volino & Magnenat-Thalmann 2006]
//    A crossing p lies on the edge q0 q1 and in the plane with the normal n through the triangle.  Let the edge's point
//    at p move by u and the triangle's by w, both interpolated from their particles.  p stays on both:
//        dp = u - e (n.(u - w)) / (n.e),          e = q1 - q0
//    and with tau_p the sum of the unit vectors from p's neighbours on the curve to p,  dL = sum_p tau_p . dp:
//        dL/du = tau - n (e.tau)/(n.e),           dL/dw = n (e.tau)/(n.e)
//    Inside a straight stretch tau = 0: the ends and the bends act.
// 2  Across: along the other surface's normal N, to sweep the contour over the part that it cuts off.
//    If the two surfaces separate by d (per length of the curve), the curve moves within a surface by
//        (N.d) / (N.m) along m, its normal within the surface
//    so the part that is cut off, on the side sigma of the other surface, shrinks at the rate of the integral of
//    -sigma N.d / |N.m|.  Pushing by -sigma N shrinks it everywhere on the curve, however the surfaces lie.
//
// Easily got wrong: 2 is blind for a hole: a ring around a rod cuts out a disc, and nothing of it could leave sideways.
// The mean of N along the curve tells the cases apart: `coherence` below.
#pragma once
#include "contact/intersection_contours.hpp"

namespace toile::internal {

// A point of a surface, and a vector there.
struct ContourPull {
  std::array<Index, 3> particle{-1, -1, -1};  // two for an edge, one for an end
  std::array<double, 3> weight{0, 0, 0};      // sums to 1
  Vec3 vector = Vec3::Zero();
  int side = 0;
};

// The derivative of contour_length with respect to the point of each pull.  An edge in the plane of the triangle that
// it passes through is counted with a sine of at least `least_sine`.
std::vector<ContourPull> length_gradient(const IntersectionContour& contour, std::span<const Triangle> triangles,
                                         std::span<const SurfaceCrossing> crossings, std::span<const Vec3> x,
                                         double least_sine = 1e-3);

// Unit vectors at all points of the contour that sweep it over `region`, which `side` of the contour cuts off: -sigma N
// on that side, sigma N on the other.  `region` must not be empty.
struct Sweep {
  std::vector<ContourPull> pulls;
  // |sum of N dl| / length, 0 to 1: how far a straight motion of the whole surface takes the contour along.
  double coherence = 0;
};
Sweep sweep(const IntersectionContour& contour, std::span<const Triangle> triangles, const Topology& topology,
            std::span<const SurfaceCrossing> crossings, std::span<const Vec3> x, int side,
            std::span<const Index> region);

}  // namespace toile::internal
