// io/mesh_writer.hpp: writes a surface as a file of any supported format.                                        docs/howto/export.md
//
// Numbers are rounded to float; the same surface gives the same bytes.  A file appears under its name when it is complete (io/file.hpp).
#pragma once
#include "io/surface_mesh.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct MeshWriter {
  std::string_view name;    // "ply", as on the command line
  std::string_view ending;  // ".ply"
  // Throws IoError, and InputError for arrays that do not fit together or a number that no float can hold.
  void (*write)(const std::string& path, const SurfaceMesh& mesh);
};

// The writable formats (mesh_formats.hpp).
const std::vector<MeshWriter>& mesh_writers();
// By name, or else by the extension of `path`; nullptr: none.
const MeshWriter* mesh_writer_named(std::string_view name);
const MeshWriter* mesh_writer_for(std::string_view path);
// "obj, ply or gltf"
std::string mesh_writers_in_words();

// For writers.

// Throws InputError naming `path`: arrays that do not fit together, indices out of range, numbers that no float can hold.
void check_writable(const std::string& path, const SurfaceMesh& mesh);
// The name on one line: control characters become "_".
std::string name_on_one_line(std::string_view name);

// The triangles of one object and group; pieces in order of first appearance, triangles in the order of the mesh.
struct MeshPiece {
  Index object = -1, group = -1;  // -1: the mesh has none
  std::vector<std::size_t> triangles;
};
std::vector<MeshPiece> pieces_of(const SurfaceMesh& mesh);

// Vertices with one uv each, as PLY and glTF want them, split where corners at one vertex have several; in the order of the mesh's.
struct SplitVertices {
  std::vector<Index> position, texcoord;  // [vertex] of the mesh; texcoord -1: none
  std::vector<Triangle> triangles;
  bool has_uv = false;  // every corner has one; otherwise uv is not used
};
SplitVertices split_vertices(const SurfaceMesh& mesh, const std::vector<std::size_t>& triangles);

}  // namespace toile::internal
