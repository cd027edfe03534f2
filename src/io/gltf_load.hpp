// io/gltf_load.hpp: a glTF file and its buffers, parsed by the library.
#pragma once
#include "io/gltf_library.hpp"
#include "io/mesh_file.hpp"

#include <cstddef>

namespace toile::internal {

// `bytes` gets the size of the file and its buffers.  Throws InputError.
tinygltf::Model load_gltf(const MeshSource& source, std::size_t& bytes);

}  // namespace toile::internal
