// io/no_gltf.cpp: replaces gltf_*.cpp in builds without tinygltf: recognises the format and refuses it.
#include "core/error.hpp"
#include "io/mesh_formats.hpp"

namespace toile::internal {
namespace {

[[noreturn]] void refuse(const MeshSource& source) {
  throw InputError(source.file, "format", "OBJ or PLY, as this Toile is built without tinygltf", "glTF");
}

}  // namespace

MeshReader gltf_reader() {
  return {"glTF",
          {".glb", ".gltf"},
          [](std::string_view bytes) {
            return bytes.substr(0, 4) == "glTF" ||
                   bytes.substr(0, bytes.find_first_not_of(" \t\r\n") + 1).ends_with('{');
          },
          [](const MeshSource& source) -> SurfaceMesh { refuse(source); },
          nullptr,
          [](const MeshSource& source) -> AnimatedMesh { refuse(source); }};
}

}  // namespace toile::internal
