// mesh/check.hpp: checks of a mesh before it is simulated; each error names the element.
//
// Particles, triangles and corners are counted from 0 in messages, as in ClothMesh.
#pragma once
#include "mesh/cloth_mesh.hpp"

#include <span>
#include <string_view>

namespace toile::internal {

// Throws InputError("<where>", "triangle 12", expected, got) at the first: no triangles at all, index out of range,
// corner used twice, non-finite position, duplicate triangle (in either winding), non-manifold edge, inconsistently
// wound neighbours, isolated particle.
void check_triangles(std::string_view where, std::span<const Vec3> positions, std::span<const Triangle> triangles);

// In addition: array sizes that agree, panels in range, finite uv, and no triangle whose area in the pattern is zero
// or negative (flipped).  "Zero" is relative to the triangle's size, so that units do not matter.
void check_cloth(std::string_view where, const ClothMesh& mesh, std::span<const Vec3> positions);

// In addition to check_triangles: every edge has exactly two triangles, and the surface encloses a positive volume.
// The volume is that of the whole surface: a hollow body, with its inner shell facing inwards, passes.
void check_closed(std::string_view where, std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace toile::internal
