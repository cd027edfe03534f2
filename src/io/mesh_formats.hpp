// io/mesh_formats.hpp: the mesh formats: each has files of its own and its lines here.                           ARCHITECTURE.md#how-to-add
#pragma once
#include "io/mesh_file.hpp"
#include "io/mesh_writer.hpp"

namespace toile::internal {

MeshReader obj_reader();   // obj_read.cpp
MeshReader ply_reader();   // ply_read.cpp
MeshReader stl_reader();   // stl_read.cpp
MeshReader gltf_reader();  // gltf_read.cpp
inline std::vector<MeshReader> all_mesh_readers() { return {obj_reader(), ply_reader(), stl_reader(), gltf_reader()}; }

MeshWriter obj_writer();   // obj_write.cpp
MeshWriter ply_writer();   // ply_write.cpp
MeshWriter gltf_writer();  // gltf_write.cpp
inline std::vector<MeshWriter> all_mesh_writers() { return {obj_writer(), ply_writer(), gltf_writer()}; }

}  // namespace toile::internal
