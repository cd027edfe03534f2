// io/mesh_file.hpp: a surface from a file of any format that is read here, told apart by its content.             docs/scenes.md#mesh-files
//
// A file says what it is by its first bytes ("ply", "glTF", "{"); OBJ has none, and is what the others are not.  A name whose ending says
// something else is told in the mesh's notes.
#pragma once
#include "io/surface_mesh.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// What a reader gets.
struct MeshSource {
  std::string_view bytes;
  std::string file;  // as messages show it
  // The bytes of a file that this one names.  Throws InputError for a name that leads out of this one's folder, IoError.
  std::function<std::string(std::string_view name)> beside;
};

struct MeshReader {
  std::string_view name;                  // "PLY"
  std::vector<std::string_view> endings;  // ".ply", in small letters
  bool (*is_it)(std::string_view bytes);  // by the content
  SurfaceMesh (*read)(const MeshSource& source);
  // Files that it is made of besides, as MeshSource::beside takes them; nullptr: none.
  std::vector<std::string> (*names_beside)(std::string_view bytes);
};

// The formats that are read (mesh_formats.cpp).
const std::vector<MeshReader>& mesh_readers();
// "OBJ, PLY or glTF"
std::string mesh_formats_in_words();
// The name of the format that parse_mesh takes it for.
std::string_view mesh_format_of(std::string_view bytes, const std::string& path);
// The name ends as a mesh file's: in small or capital letters.
bool has_mesh_ending(std::string_view path);

using BytesSeen = std::function<void(std::string_view bytes)>;
// `path` is where `bytes` come from: its ending and its folder count.  `beside` sees the bytes of every other file that belongs to it.
// Throws InputError and IoError.
SurfaceMesh parse_mesh(std::string_view bytes, const std::string& path, const BytesSeen& beside = {});
// The whole file; `seen` sees it first.
SurfaceMesh load_mesh(const std::string& path, const BytesSeen& seen = {});

// The file and those that it names in its own folder; a path that cannot be read is given back alone.
std::vector<std::string> files_of_mesh(const std::string& path);

}  // namespace toile::internal
