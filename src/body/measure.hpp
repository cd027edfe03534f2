// body/measure.hpp: a tape measure for closed meshes: plane sections and girths.
//
// A tape does not follow hollows: a girth is the perimeter of the convex hull of one closed section curve.
#pragma once
#include "core/types.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// The closed curves in which the plane (p - origin) . normal = 0 cuts a closed mesh, each as points in order;
// curves are ordered by the first edge of the mesh that they cross.  A vertex on the plane counts as above it.
std::vector<std::vector<Vec3>> section(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                       const Vec3& origin, const Vec3& normal);

// Perimeter of the convex hull of the points of a plane curve, m.  `normal` is the plane's, of unit length.
double girth_m(std::span<const Vec3> curve, const Vec3& normal);

// Girth at `origin`: of the section curve whose centroid is nearest to it; 0 when the plane misses the mesh.
double girth_at_m(std::span<const Vec3> positions, std::span<const Triangle> triangles, const Vec3& origin,
                  const Vec3& normal);

// Height of the waist of an upright body: of the horizontal section with the least girth between 55 % and 70 % of the
// height, in steps of 1 %; 0 when no such section exists.
double waist_height_m(std::span<const Vec3> positions, std::span<const Triangle> triangles);

struct Level {
  double height_m = 0, girth_m = 0;
};
// Hips of an upright body: the horizontal section with the greatest girth between 45 % and 55 % of the height; zeros when no
// such section exists.
Level hips(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace toile::internal
