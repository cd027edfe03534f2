// sim/offenders.hpp: the offenders of a failed step, for a person to look at: triangles of the cloth, and the body near them.
#pragma once
#include "io/surface_mesh.hpp"
#include "mesh/cloth_mesh.hpp"

#include <span>
#include <string>

namespace toile::internal {

// "3 triangles of front (120, 121, 122), 1 of back (500)": at most eight numbers per panel.  Empty for no triangle.
std::string name_triangles(const ClothMesh& mesh, std::span<const Index> triangles);

// Object "cloth" with the triangles, grouped by panel, and object "body" with those of its triangles whose boxes come
// within `near_m` of the cloth's; unused vertices and triangles that are not finite are left out.
SurfaceMesh offenders_obj(const ClothMesh& mesh, std::span<const Vec3> x, std::span<const Index> triangles,
                          std::span<const Triangle> body, std::span<const Vec3> body_x, double near_m = 0.02);

}  // namespace toile::internal
