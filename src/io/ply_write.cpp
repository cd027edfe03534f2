// io/ply_write.cpp: binary PLY with one uv per vertex; panels and garments are numbers of the faces, their names comments.
//
// Where some corners have no uv, each face has its own list instead (texcoord), empty for faces without.
#include "io/file.hpp"
#include "io/mesh_formats.hpp"

#include <bit>
#include <numeric>

namespace toile::internal {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, and so must the machine be");

// Buffers the bytes for the file.
class Bytes {
 public:
  explicit Bytes(AtomicFile& file) : file_(&file) {}
  template <class T>
  void add(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    if (bytes_.size() > (std::size_t{1} << 20)) flush();
  }
  void flush() {
    file_->write(bytes_);
    bytes_.clear();
  }

 private:
  AtomicFile* file_;
  std::string bytes_;
};

std::string names_as_comments(std::string_view what, const std::vector<std::string>& names) {
  std::string lines;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (!names[k].empty())
      lines += "comment " + std::string(what) + ' ' + std::to_string(k) + ' ' + name_on_one_line(names[k]) + '\n';
  return lines;
}

void write_ply(const std::string& path, const SurfaceMesh& mesh) {
  check_writable(path, mesh);
  std::vector<std::size_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const SplitVertices split = split_vertices(mesh, all);
  const bool per_corner = !mesh.texcoord.empty() && !split.has_uv;
  // Without uv vertices stay those of the mesh, used or not.
  const std::size_t vertices = split.has_uv ? split.position.size() : mesh.positions.size();

  std::string header = "ply\nformat binary_little_endian 1.0\n";
  if (!mesh.group.empty()) header += names_as_comments("panel", mesh.group_names);
  if (!mesh.object.empty()) header += names_as_comments("garment", mesh.object_names);
  header += "element vertex " + std::to_string(vertices) + "\nproperty float x\nproperty float y\nproperty float z\n";
  if (split.has_uv) header += "property float s\nproperty float t\n";
  header += "element face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\n";
  if (per_corner) header += "property list uchar float texcoord\n";
  if (!mesh.group.empty()) header += "property int panel\n";
  if (!mesh.object.empty()) header += "property int garment\n";
  header += "end_header\n";

  AtomicFile file(path);
  file.write(header);
  Bytes bytes(file);
  const auto add = [&](const auto& numbers) {
    for (const double number : numbers) bytes.add(static_cast<float>(number));
  };
  for (std::size_t i = 0; i < vertices; ++i) {
    add(mesh.positions[split.has_uv ? at(split.position[i]) : i]);
    if (split.has_uv) add(mesh.texcoords[at(split.texcoord[i])]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    bytes.add(std::uint8_t{3});
    for (const Index i : split.has_uv ? split.triangles[t] : mesh.triangles[t]) bytes.add(static_cast<std::int32_t>(i));
    if (per_corner) {
      const auto& corners = mesh.texcoord[t];
      const bool drawn = corners[0] >= 0 && corners[1] >= 0 && corners[2] >= 0;
      bytes.add(static_cast<std::uint8_t>(drawn ? 6 : 0));
      for (std::size_t k = 0; k < 3 && drawn; ++k) add(mesh.texcoords[at(corners[k])]);
    }
    if (!mesh.group.empty()) bytes.add(static_cast<std::int32_t>(mesh.group[t]));
    if (!mesh.object.empty()) bytes.add(static_cast<std::int32_t>(mesh.object[t]));
  }
  bytes.flush();
  file.commit();
}

}  // namespace

MeshWriter ply_writer() { return {"ply", ".ply", write_ply}; }

}  // namespace toile::internal
