// io/gltf_write.cpp: a binary glTF (.glb): a node per garment, below it one per panel with a mesh of the panel's name.
//
// Vertices are split along texture seams and between panels; normals are those of the whole surface, so that a seam does not show.  The
// second number of a texture coordinate points down in glTF and up here: v = 1 - v.  A panel's fabric is its material.
#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json_text.hpp"
#include "io/mesh_formats.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace toile::internal {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, and so must the machine be");

// Constants of the format, for accessors and views.
constexpr int component_float = 5126, component_uint32 = 5125, target_vertices = 34962, target_indices = 34963;

// [vertex] normals of the surface, weighted by area; up for a vertex without triangles.
Vec3s normals_of(const SurfaceMesh& mesh) {
  Vec3s normals(mesh.positions.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.positions[at(t[0])];
    const Vec3 twice_area = (mesh.positions[at(t[1])] - a).cross(mesh.positions[at(t[2])] - a);
    for (const Index i : t) normals[at(i)] += twice_area;
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    n = length > 0 && std::isfinite(length) ? Vec3(n / length) : Vec3(0, 1, 0);
  }
  return normals;
}

class GlbText {
 public:
  explicit GlbText(const SurfaceMesh& mesh) : mesh_(&mesh), normals_(normals_of(mesh)), pieces_(pieces_of(mesh)) {
    for (const MeshPiece& piece : pieces_) add_piece(piece);
    write_json();
  }

  // Header and both chunks.
  void write(const std::string& path) const {
    constexpr std::size_t around = 28;
    const std::uint64_t size = around + json_.size() + data_.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw InputError(printable(path), "glTF", "at most 4 GB, as the format has it", std::to_string(size) + " bytes");
    AtomicFile file(path);
    std::string bytes = "glTF";
    const auto add = [&](std::size_t number) { append(bytes, static_cast<std::uint32_t>(number)); };
    add(2);
    add(size);
    add(json_.size());
    bytes += "JSON" + json_;
    add(data_.size());
    bytes += std::string("BIN\0", 4);
    file.write(bytes);
    file.write(data_);
    file.commit();
  }

 private:
  struct Accessor {
    std::size_t offset, bytes, count;
    int component, target;
    const char* type;
    std::vector<double> low, high;  // of positions
  };
  struct Primitive {
    std::string name;
    std::size_t position = 0, normal = 0, indices = 0;
    std::size_t uv = 0;  // 0: none, as accessor 0 holds positions
    std::size_t material = 0;
  };

  template <class T>
  static void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  template <class Numbers>
  std::size_t add_accessor(const Numbers& numbers, std::size_t count, const char* type, int component, int target) {
    Accessor accessor{data_.size(), 0, count, component, target, type, {}, {}};
    for (const auto number : numbers) append(data_, number);
    accessor.bytes = data_.size() - accessor.offset;
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }

  std::size_t material_of(const MeshPiece& piece) {
    std::string name;
    if (piece.group >= 0 && at(piece.group) < mesh_->group_material.size())
      name = mesh_->group_material[at(piece.group)];
    if (name.empty()) name = "surface";
    const auto known = std::find(materials_.begin(), materials_.end(), name);
    if (known != materials_.end()) return static_cast<std::size_t>(known - materials_.begin());
    materials_.push_back(std::move(name));
    return materials_.size() - 1;
  }

  void add_piece(const MeshPiece& piece) {
    const SplitVertices split = split_vertices(*mesh_, piece.triangles);
    const std::size_t count = split.position.size();
    Primitive primitive;
    primitive.name = piece.group >= 0 ? mesh_->group_names[at(piece.group)] : std::string();
    std::vector<float> x, n, uv;
    std::vector<std::uint32_t> corners;
    std::vector<double> low(3, std::numeric_limits<double>::infinity()),
        high(3, -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        x.push_back(static_cast<float>(mesh_->positions[at(split.position[i])][axis]));
        n.push_back(static_cast<float>(normals_[at(split.position[i])][axis]));
        low[k] = std::min(low[k], static_cast<double>(x.back()));
        high[k] = std::max(high[k], static_cast<double>(x.back()));
      }
      if (!split.has_uv) continue;
      const Vec2& vt = mesh_->texcoords[at(split.texcoord[i])];
      uv.push_back(static_cast<float>(vt.x()));
      uv.push_back(static_cast<float>(1 - vt.y()));
    }
    for (const Triangle& t : split.triangles)
      for (const Index i : t) corners.push_back(static_cast<std::uint32_t>(i));
    primitive.position = add_accessor(x, count, "VEC3", component_float, target_vertices);
    accessors_.back().low = std::move(low);
    accessors_.back().high = std::move(high);
    primitive.normal = add_accessor(n, count, "VEC3", component_float, target_vertices);
    if (split.has_uv) primitive.uv = add_accessor(uv, count, "VEC2", component_float, target_vertices);
    primitive.indices = add_accessor(corners, corners.size(), "SCALAR", component_uint32, target_indices);
    primitive.material = material_of(piece);
    primitives_.push_back(std::move(primitive));
  }

  static void add_list(JsonText& json, std::string_view key, const std::vector<std::size_t>& numbers) {
    json.key(key);
    json.begin_array();
    for (const std::size_t number : numbers) json.value(number);
    json.end_array();
  }

  // Panels are children of their garments; a garment of one unnamed surface is a single node.
  void add_nodes(JsonText& json) const {
    struct Node {
      std::string name;
      std::vector<std::size_t> children;
      std::size_t mesh = std::numeric_limits<std::size_t>::max();
    };
    std::vector<Node> nodes;
    std::vector<std::size_t> roots;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      const bool new_object = p == 0 || pieces_[p].object != pieces_[p - 1].object;
      if (new_object) {
        roots.push_back(nodes.size());
        const std::string name = pieces_[p].object >= 0 ? mesh_->object_names[at(pieces_[p].object)] : std::string();
        nodes.push_back({name.empty() ? "surface" : name, {}});
      }
      if (primitives_[p].name.empty()) {
        if (nodes[roots.back()].mesh > p) nodes[roots.back()].mesh = p;
        continue;
      }
      nodes[roots.back()].children.push_back(nodes.size());
      nodes.push_back({primitives_[p].name, {}, p});
    }
    json.key("scenes");
    json.begin_array();
    json.begin_object();
    add_list(json, "nodes", roots);
    json.end_object();
    json.end_array();
    json.key("nodes");
    json.begin_array();
    for (const Node& node : nodes) {
      json.begin_object();
      json.member("name", node.name);
      if (node.mesh < primitives_.size()) json.member("mesh", node.mesh);
      if (!node.children.empty()) add_list(json, "children", node.children);
      json.end_object();
    }
    json.end_array();
  }

  void add_meshes(JsonText& json) const {
    json.key("meshes");
    json.begin_array();
    for (const Primitive& primitive : primitives_) {
      json.begin_object();
      if (!primitive.name.empty()) json.member("name", primitive.name);
      json.key("primitives");
      json.begin_array();
      json.begin_object();
      json.key("attributes");
      json.begin_object();
      json.member("POSITION", primitive.position);
      json.member("NORMAL", primitive.normal);
      if (primitive.uv > 0) json.member("TEXCOORD_0", primitive.uv);
      json.end_object();
      json.member("indices", primitive.indices);
      json.member("material", primitive.material);
      json.end_object();
      json.end_array();
      json.end_object();
    }
    json.end_array();
    json.key("materials");
    json.begin_array();
    for (const std::string& material : materials_) {
      json.begin_object();
      json.member("name", material);
      json.member("doubleSided", true);
      json.key("pbrMetallicRoughness");
      json.begin_object();
      json.member("metallicFactor", 0);
      json.end_object();
      json.end_object();
    }
    json.end_array();
  }

  void add_data(JsonText& json) const {
    json.key("accessors");
    json.begin_array();
    for (std::size_t k = 0; k < accessors_.size(); ++k) {
      const Accessor& accessor = accessors_[k];
      json.begin_object();
      json.member("bufferView", k);
      json.member("componentType", accessor.component);
      json.member("count", accessor.count);
      json.member("type", accessor.type);
      for (const auto& [key, values] : {std::pair("min", &accessor.low), std::pair("max", &accessor.high)}) {
        if (values->empty()) continue;
        json.key(key);
        json.begin_array();
        for (const double value : *values) json.value(value);
        json.end_array();
      }
      json.end_object();
    }
    json.end_array();
    json.key("bufferViews");
    json.begin_array();
    for (const Accessor& accessor : accessors_) {
      json.begin_object();
      json.member("buffer", 0);
      json.member("byteOffset", accessor.offset);
      json.member("byteLength", accessor.bytes);
      json.member("target", accessor.target);
      json.end_object();
    }
    json.end_array();
    json.key("buffers");
    json.begin_array();
    json.begin_object();
    json.member("byteLength", data_.size());
    json.end_object();
    json.end_array();
  }

  // Chunks are multiples of 4 bytes: all numbers are, and text is filled up with blanks.
  void write_json() {
    JsonText json(0);
    json.begin_object();
    json.key("asset");
    json.begin_object();
    json.member("version", "2.0");
    json.member("generator", "Toile");
    json.end_object();
    json.member("scene", 0);
    add_nodes(json);
    add_meshes(json);
    add_data(json);
    json.end_object();
    json_ = json.str();
    json_.append((4 - json_.size() % 4) % 4, ' ');
  }

  const SurfaceMesh* mesh_;
  Vec3s normals_;
  std::vector<MeshPiece> pieces_;
  std::vector<Primitive> primitives_;  // [piece]
  std::vector<Accessor> accessors_;    // one view each
  std::vector<std::string> materials_;
  std::string data_, json_;
};

void write_glb(const std::string& path, const SurfaceMesh& mesh) {
  check_writable(path, mesh);
  if (mesh.triangles.empty()) throw InputError(printable(path), "mesh", "triangles", "none");
  GlbText(mesh).write(path);
}

}  // namespace

MeshWriter gltf_writer() { return {"gltf", ".glb", write_glb}; }

}  // namespace toile::internal
