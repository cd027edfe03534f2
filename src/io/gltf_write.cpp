// io/gltf_write.cpp: a binary glTF (.glb): a node per garment, below it one per panel with a mesh of the panel's name.  All frames are morph
// targets, one per frame but the first, and an animation of their weights, which goes straight from frame to frame.
//
// Vertices are split along texture seams and between panels; normals are those of the whole surface, so that a seam does not show.  The
// second number of a texture coordinate points down in glTF and up here: v = 1 - v.  A panel's fabric is its material.
#include "core/error.hpp"
#include "io/file.hpp"
#include "io/json_text.hpp"
#include "io/mesh_formats.hpp"
#include "io/sequence_writer.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace toile::internal {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, and so must the machine be");

// Constants of the format, for accessors and views.
constexpr int component_float = 5126, component_uint32 = 5125, target_vertices = 34962, target_indices = 34963;

// More than this is for a format that programs need not hold in memory as a whole.
constexpr std::size_t most_animated_bytes = std::size_t{1} << 30;

class GlbText {
 public:
  // `later`: the positions of the frames after that of the mesh; empty: it stands.
  GlbText(const SurfaceMesh& mesh, std::span<const Vec3s> later, double fps)
      : mesh_(&mesh), later_(later), normals_(normals_of(mesh, mesh.positions)), pieces_(pieces_of(mesh)) {
    for (const Vec3s& x : later_) later_normals_.push_back(normals_of(mesh, x));
    for (const MeshPiece& piece : pieces_) add_piece(piece);
    if (!later_.empty()) add_weights(fps);
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
  struct Target {
    std::size_t position = 0, normal = 0;
  };
  struct Primitive {
    std::string name;
    std::size_t position = 0, normal = 0, indices = 0;
    std::vector<Target> targets;
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
    for (std::size_t k = 0; k < later_.size(); ++k) {
      Target target;
      target.position = add_differences(split.position, mesh_->positions, later_[k], true);
      target.normal = add_differences(split.position, normals_, later_normals_[k], false);
      primitive.targets.push_back(target);
    }
    primitive.material = material_of(piece);
    primitives_.push_back(std::move(primitive));
  }

  // The format wants the range of positions, and of no other numbers.
  std::size_t add_differences(const std::vector<Index>& vertices, const Vec3s& from, const Vec3s& to, bool with_range) {
    std::vector<float> numbers;
    std::vector<double> low(3, std::numeric_limits<double>::infinity()),
        high(3, -std::numeric_limits<double>::infinity());
    for (const Index v : vertices)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        // Of the rounded numbers, so that the sum is the rounded frame.
        numbers.push_back(static_cast<float>(to[at(v)][axis]) - static_cast<float>(from[at(v)][axis]));
        low[k] = std::min(low[k], static_cast<double>(numbers.back()));
        high[k] = std::max(high[k], static_cast<double>(numbers.back()));
      }
    const std::size_t accessor = add_accessor(numbers, vertices.size(), "VEC3", component_float, target_vertices);
    if (with_range) {
      accessors_[accessor].low = std::move(low);
      accessors_[accessor].high = std::move(high);
    }
    return accessor;
  }

  // At the time of frame k the weight of its target is 1 and all others are 0.
  void add_weights(double fps) {
    const std::size_t frames = later_.size() + 1;
    std::vector<float> times, weights;
    for (std::size_t frame = 0; frame < frames; ++frame) {
      times.push_back(static_cast<float>(static_cast<double>(frame) / fps));
      for (std::size_t k = 1; k < frames; ++k) weights.push_back(k == frame ? 1.0F : 0.0F);
    }
    times_ = add_accessor(times, frames, "SCALAR", component_float, 0);
    accessors_[times_].low = {0};
    accessors_[times_].high = {static_cast<double>(times.back())};
    weights_ = add_accessor(weights, weights.size(), "SCALAR", component_float, 0);
  }

  static void add_list(JsonText& json, std::string_view key, const std::vector<std::size_t>& numbers) {
    json.key(key);
    json.begin_array();
    for (const std::size_t number : numbers) json.value(number);
    json.end_array();
  }

  // Panels are children of their garments; a garment of one unnamed surface is a single node.
  void add_nodes(JsonText& json) {
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
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const Node& node = nodes[n];
      if (node.mesh < primitives_.size()) mesh_nodes_.push_back(n);
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
      if (!primitive.targets.empty()) {
        json.key("targets");
        json.begin_array();
        for (const Target& target : primitive.targets) {
          json.begin_object();
          json.member("POSITION", target.position);
          json.member("NORMAL", target.normal);
          json.end_object();
        }
        json.end_array();
      }
      json.end_object();
      json.end_array();
      if (!primitive.targets.empty()) add_list(json, "weights", std::vector<std::size_t>(primitive.targets.size(), 0));
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

  // One sampler for all panels.
  void add_animation(JsonText& json) const {
    if (later_.empty()) return;
    json.key("animations");
    json.begin_array();
    json.begin_object();
    json.member("name", "frames");
    json.key("samplers");
    json.begin_array();
    json.begin_object();
    json.member("input", times_);
    json.member("output", weights_);
    json.member("interpolation", "LINEAR");
    json.end_object();
    json.end_array();
    json.key("channels");
    json.begin_array();
    for (const std::size_t node : mesh_nodes_) {
      json.begin_object();
      json.member("sampler", 0);
      json.key("target");
      json.begin_object();
      json.member("node", node);
      json.member("path", "weights");
      json.end_object();
      json.end_object();
    }
    json.end_array();
    json.end_object();
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
      if (accessor.target != 0) json.member("target", accessor.target);
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
    add_animation(json);
    add_data(json);
    json.end_object();
    json_ = json.str();
    json_.append((4 - json_.size() % 4) % 4, ' ');
  }

  const SurfaceMesh* mesh_;
  std::span<const Vec3s> later_;
  Vec3s normals_;
  std::vector<Vec3s> later_normals_;
  std::vector<MeshPiece> pieces_;
  std::vector<Primitive> primitives_;  // [piece]
  std::vector<Accessor> accessors_;    // one view each
  std::vector<std::string> materials_;
  std::vector<std::size_t> mesh_nodes_;  // nodes that have a mesh
  std::size_t times_ = 0, weights_ = 0;
  std::string data_, json_;
};

void write_glb(const std::string& path, const SurfaceMesh& mesh) {
  check_writable(path, mesh);
  if (mesh.triangles.empty()) throw InputError(printable(path), "mesh", "triangles", "none");
  GlbText(mesh, {}, 0).write(path);
}

bool write_animated_glb(const std::string& path, const Sequence& sequence) {
  if (sequence.surfaces.size() != 1)
    throw InputError(printable(path), "surfaces", "one", std::to_string(sequence.surfaces.size()));
  const SurfaceSequence& surface = sequence.surfaces.front();
  SurfaceMesh mesh = *surface.mesh;
  check_writable(path, mesh);
  if (mesh.triangles.empty()) throw InputError(printable(path), "mesh", "triangles", "none");
  // Positions and normals of every corner's vertex at most.
  const double bytes = 24.0 * static_cast<double>(mesh.positions.size()) * sequence.frames;
  if (bytes > static_cast<double>(most_animated_bytes))
    throw InputError(printable(path), "frames", "at most 1 GB of morph targets (usda and point caches have no limit)",
                     fmt::sprintf("%.1f GB", bytes / (1 << 30)));
  std::vector<Vec3s> frames(static_cast<std::size_t>(sequence.frames));
  for (int frame = 0; frame < sequence.frames; ++frame) {
    if (sequence.goes_on && !sequence.goes_on()) return false;
    read_frame(path, surface, frame, frames[static_cast<std::size_t>(frame)]);
  }
  mesh.positions = frames.front();
  GlbText(mesh, std::span(frames).subspan(1), sequence.fps).write(path);
  return true;
}

}  // namespace

MeshWriter gltf_writer() { return {"gltf", ".glb", write_glb}; }
SequenceWriter gltf_sequence_writer() { return {"gltf", ".glb", false, write_animated_glb}; }

}  // namespace toile::internal
