#include "io/mesh_file.hpp"

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/mesh_formats.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace toile::internal {
namespace {

namespace fs = std::filesystem;

// The largest file that a mesh may be made of, bytes.
constexpr std::size_t file_limit = std::size_t{1} << 31;

// ".ply" of "shirt.PLY"; ASCII letters only, in every locale.
std::string ending_of(std::string_view path) {
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return ending;
}

const MeshReader* by_ending(const std::string& ending) {
  for (const MeshReader& reader : mesh_readers())
    if (std::find(reader.endings.begin(), reader.endings.end(), ending) != reader.endings.end()) return &reader;
  return nullptr;
}

// The content decides; where it is ambiguous, the extension.
const MeshReader& reader_of(std::string_view bytes, const std::string& path, std::vector<std::string>& notes) {
  const std::string ending = ending_of(path), file = printable(path);
  const MeshReader* const named = by_ending(ending);
  for (const MeshReader& reader : mesh_readers()) {
    if (!reader.is_it(bytes)) continue;
    if (named != nullptr && named != &reader)
      notes.push_back(file + ": is " + std::string(reader.name) + " by its content, not " + std::string(named->name) +
                      ", and is read as such");
    return reader;
  }
  if (named != nullptr) return *named;  // its reader reports the error
  const std::string_view line = bytes.substr(0, std::min(bytes.find_first_of("\r\n"), std::size_t{40}));
  throw InputError(file, "format", mesh_formats_in_words(),
                   line.empty() ? "an empty line" : '"' + printable(line) + '"');
}

// A file in the folder of `path`, or below it, with links resolved.
std::string inside_folder_of(const std::string& path, std::string_view name) {
  const fs::path wanted(name), folder = fs::path(path).parent_path();
  const auto refuse = [&](std::string_view got) {
    throw InputError(printable(path), "file " + printable(name), "one in the folder of this file, or below it", got);
  };
  if (name.empty()) refuse("no name");
  if (name.find('\0') != std::string_view::npos) refuse("a name with a NUL byte");
  if (name.find(':') != std::string_view::npos) refuse("an address");
  if (name.find('\\') != std::string_view::npos) refuse("a backslash");
  if (wanted.is_absolute()) refuse("an absolute path");
  if (std::find(wanted.begin(), wanted.end(), fs::path("..")) != wanted.end()) refuse("a path that leaves it");
  std::error_code error;
  const fs::path base = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) throw IoError(path, "cannot find its folder: " + error.message());
  const fs::path real = fs::canonical(base / wanted, error);
  if (error) throw IoError(printable((folder / wanted).string()), "cannot open: " + error.message());
  const fs::path way = real.lexically_relative(base);
  if (way.empty() || *way.begin() == "..") refuse("a link that leaves it");
  return real.string();
}

MeshSource source_of(std::string_view bytes, const std::string& path, const BytesSeen& beside) {
  return {bytes, printable(path), [&](std::string_view name) {
            std::string other = read_file(inside_folder_of(path, name), file_limit);
            if (beside) beside(other);
            return other;
          }};
}

}  // namespace

const std::vector<MeshReader>& mesh_readers() {
  static const std::vector<MeshReader> readers = all_mesh_readers();
  return readers;
}

std::string mesh_formats_in_words() {
  std::vector<std::string> names;
  for (const MeshReader& reader : mesh_readers()) names.emplace_back(reader.name);
  return alternatives(names);
}

std::string_view mesh_format_of(std::string_view bytes, const std::string& path) {
  std::vector<std::string> notes;
  return reader_of(bytes, path, notes).name;
}

bool has_mesh_ending(std::string_view path) { return by_ending(ending_of(path)) != nullptr; }

SurfaceMesh parse_mesh(std::string_view bytes, const std::string& path, const BytesSeen& beside) {
  std::vector<std::string> notes;
  const MeshReader& reader = reader_of(bytes, path, notes);
  SurfaceMesh mesh = reader.read(source_of(bytes, path, beside));
  mesh.notes.insert(mesh.notes.begin(), notes.begin(), notes.end());
  return mesh;
}

AnimatedMesh parse_animated(std::string_view bytes, const std::string& path, const BytesSeen& beside) {
  std::vector<std::string> notes;
  const MeshReader& reader = reader_of(bytes, path, notes);
  if (reader.read_animated == nullptr) {
    std::vector<std::string> names;
    for (const MeshReader& other : mesh_readers())
      if (other.read_animated != nullptr) names.emplace_back(other.name);
    throw InputError(printable(path), "format", "one with a skeleton or animations: " + alternatives(names),
                     reader.name);
  }
  AnimatedMesh mesh = reader.read_animated(source_of(bytes, path, beside));
  mesh.surface.notes.insert(mesh.surface.notes.begin(), notes.begin(), notes.end());
  return mesh;
}

SurfaceMesh load_mesh(const std::string& path, const BytesSeen& seen) {
  const std::string bytes = read_file(path, file_limit);
  if (seen) seen(bytes);
  return parse_mesh(bytes, path, seen);
}

AnimatedMesh load_animated(const std::string& path, const BytesSeen& seen) {
  const std::string bytes = read_file(path, file_limit);
  if (seen) seen(bytes);
  return parse_animated(bytes, path, seen);
}

bool has_animated_ending(std::string_view path) {
  const MeshReader* const reader = by_ending(ending_of(path));
  return reader != nullptr && reader->read_animated != nullptr;
}

std::vector<std::string> files_of_mesh(const std::string& path) {
  std::vector<std::string> files{path};
  try {
    const std::string bytes = read_file(path, file_limit);
    std::vector<std::string> notes;
    const MeshReader& reader = reader_of(bytes, path, notes);
    if (reader.names_beside == nullptr) return files;
    for (const std::string& name : reader.names_beside(bytes)) files.push_back(inside_folder_of(path, name));
  } catch (const Error&) {  // the reader reports the error
    files.resize(1);
  }
  return files;
}

}  // namespace toile::internal
