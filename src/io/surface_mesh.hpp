// io/surface_mesh.hpp: the contents of a mesh file, independent of its format: the output of readers, the input of writers.
//
// Vertices are those of the file: formats with one uv per vertex (PLY, glTF) split them along texture seams; users of the surface join
// them again (mesh/join_sides.hpp).
#pragma once
#include "core/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace toile::internal {

struct SurfaceMesh {
  std::vector<Vec3> positions;                 // as in the file, no unit conversion
  std::vector<Vec2> texcoords;                 // the second number points up, as in OBJ
  std::vector<Triangle> triangles;             // polygons are split into fans
  std::vector<std::array<Index, 3>> texcoord;  // [triangle][corner], -1 where the face has none; empty when no face has
  std::vector<Index> group;                    // [triangle] index into group_names
  std::vector<std::string> group_names;        // those that have faces, in order of appearance ("" before any)
  std::vector<Index> object;                   // [triangle] index into object_names
  std::vector<std::string> object_names;       // likewise
  std::vector<std::string> group_material;     // [group] its fabric; empty: not known
  std::vector<std::string> notes;              // sentences: parts of the file that were not read
};

// More than this in one file is an InputError.
constexpr std::size_t mesh_vertex_limit = 20'000'000;
constexpr std::size_t mesh_triangle_limit = 40'000'000;

}  // namespace toile::internal
