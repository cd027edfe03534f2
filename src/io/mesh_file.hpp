// io/mesh_file.hpp: reads a surface from a file of any supported format, recognised by its content.               docs/scenes.md#mesh-files
//
// The first bytes identify a format ("ply", "glTF", "{"); OBJ has no such mark and is the fallback.  A file name with the extension of
// another format is noted in the mesh's notes.
#pragma once
#include "io/animated_mesh.hpp"
#include "io/surface_mesh.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// The input of a reader.
struct MeshSource {
  std::string_view bytes;
  std::string file;  // its name in messages
  // The bytes of a file that this one refers to.  Throws InputError for a name that leads out of this one's folder, IoError.
  std::function<std::string(std::string_view name)> beside;
};

struct MeshReader {
  std::string_view name;                  // "PLY"
  std::vector<std::string_view> endings;  // ".ply", in lower case
  bool (*is_it)(std::string_view bytes);  // by the content
  SurfaceMesh (*read)(const MeshSource& source);
  // Other files that it consists of, as MeshSource::beside takes them; nullptr: none.
  std::vector<std::string> (*names_beside)(std::string_view bytes);
  // With what moves it; nullptr: such files have nothing of the kind.
  AnimatedMesh (*read_animated)(const MeshSource& source) = nullptr;
};

// The readable formats (mesh_formats.cpp).
const std::vector<MeshReader>& mesh_readers();
// "OBJ, PLY or glTF"
std::string mesh_formats_in_words();
// The name of the format that parse_mesh recognises.
std::string_view mesh_format_of(std::string_view bytes, const std::string& path);
// The name has the extension of a mesh format, in lower or upper case.
bool has_mesh_ending(std::string_view path);

using BytesSeen = std::function<void(std::string_view bytes)>;
// `path` is the source of `bytes`: its extension and its folder matter.  `beside` sees the bytes of every other file that belongs to it.
// Throws InputError and IoError.
SurfaceMesh parse_mesh(std::string_view bytes, const std::string& path, const BytesSeen& beside = {});
// Reads the whole file; `seen` is called with its bytes first.
SurfaceMesh load_mesh(const std::string& path, const BytesSeen& seen = {});

// The same of a format that has skeletons and animations; InputError for another.
AnimatedMesh parse_animated(std::string_view bytes, const std::string& path, const BytesSeen& beside = {});
AnimatedMesh load_animated(const std::string& path, const BytesSeen& seen = {});
// A file whose name ends like one of those formats'.
bool has_animated_ending(std::string_view path);

// The file and the files in its folder that it refers to; for a path that cannot be read, the path alone.
std::vector<std::string> files_of_mesh(const std::string& path);

}  // namespace toile::internal
