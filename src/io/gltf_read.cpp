// io/gltf_read.cpp: glTF 2.0, as text (.gltf) and binary (.glb): the meshes of its scene, at rest.
//
// An object is the subtree of one root node of the scene.  A group is a mesh, by its node's name; of a mesh with several primitives each is one,
// by its material's name.  The second number of a texture coordinate points down in glTF and up here: v = 1 - v.  Lengths are metres, y is up: glTF's own.
//
// Easily missed: a skinned mesh is not moved by its node but by its skeleton, which is not read.
#include "core/error.hpp"
#include "io/gltf_numbers.hpp"
#include "io/gltf_text.hpp"
#include "io/mesh_formats.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <new>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

using Mat4 = Eigen::Matrix4d;

struct Beside {
  const MeshSource* source;
  std::size_t bytes = 0;
};

tinygltf::Model load_model(const MeshSource& source, std::size_t& bytes) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  Beside beside{&source};
  tinygltf::FsCallbacks files{};
  files.FileExists = [](const std::string&, void*) { return true; };
  files.ExpandFilePath = [](const std::string& path, void*) { return path; };
  files.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& path, void* user) {
    auto& from = *static_cast<Beside*>(user);
    const std::string read = from.source->beside(path);
    from.bytes += read.size();
    out->assign(read.begin(), read.end());
    return true;
  };
  files.user_data = &beside;
  loader.SetFsCallbacks(files);
  tinygltf::Model model;
  std::string error, warning;
  bool good = false;
  const auto size = static_cast<unsigned int>(source.bytes.size());
  try {
    if (is_glb(source.bytes)) {
      const auto* const first = reinterpret_cast<const unsigned char*>(source.bytes.data());
      good = loader.LoadBinaryFromMemory(&model, &error, &warning, first, size, "", tinygltf::REQUIRE_VERSION);
    } else {
      const std::string_view json = gltf_json_of(source.bytes, source.file);
      good = loader.LoadASCIIFromString(&model, &error, &warning, json.data(), static_cast<unsigned int>(json.size()),
                                        "", tinygltf::REQUIRE_VERSION);
    }
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& thrown) {
    throw InputError(source.file, "glTF", "a file of glTF 2.0", printable(thrown.what()));
  }
  if (!good) {
    const std::string first = error.substr(0, error.find('\n'));
    throw InputError(source.file, "glTF", "a file of glTF 2.0", first.empty() ? "none" : printable(first));
  }
  bytes = source.bytes.size() + beside.bytes;
  return model;
}

class GltfReader {
 public:
  explicit GltfReader(const MeshSource& source) : file_(source.file) {
    check_gltf_text(source.bytes, source.file);
    std::size_t bytes = 0;
    model_ = load_model(source, bytes);
    if (!model_.asset.version.starts_with("2."))
      throw InputError(file_, "/asset/version", "2.x", '"' + printable(model_.asset.version) + '"');
    numbers_.emplace(model_, file_, bytes);
  }

  SurfaceMesh read() {
    walk();
    if (mesh_.triangles.empty())
      throw InputError(file_, "scene", "at least one mesh with triangles", model_.meshes.empty() ? "no mesh" : "none");
    if (!any_uv_) mesh_.texcoord = {};
    const auto note = [&](bool is_there, const char* words) {
      if (is_there) mesh_.notes.push_back(file_ + ": " + words);
    };
    note(skinned_, "has a skeleton, which is not read: its skin is as it was modelled");
    note(!model_.animations.empty(), "has animations, which are not read");
    note(morphs_, "has morph targets, which are not read: the shape is the basic one");
    note(no_surface_, "has points or lines, which are left out");
    return std::move(mesh_);
  }

 private:
  std::string node_place(int node) const { return "/nodes/" + std::to_string(node); }

  // The node's own transform, without those of its parents.
  Mat4 transform_of(int number) const {
    const tinygltf::Node& node = model_.nodes[at(number)];
    const auto sized = [&](const std::vector<double>& values, std::size_t count, const char* name) {
      if (values.empty()) return false;
      if (values.size() != count)
        throw InputError(file_, node_place(number) + '/' + name, std::to_string(count) + " numbers",
                         std::to_string(values.size()));
      for (const double value : values)
        if (!std::isfinite(value))
          throw InputError(file_, node_place(number) + '/' + name, "finite numbers", "infinity or not a number");
      return true;
    };
    Mat4 m = Mat4::Identity();
    if (sized(node.matrix, 16, "matrix")) {
      for (Eigen::Index column = 0; column < 4; ++column)
        for (Eigen::Index row = 0; row < 4; ++row)
          m(row, column) = node.matrix[static_cast<std::size_t>(4 * column + row)];
      return m;
    }
    Mat3 linear = Mat3::Identity();
    if (sized(node.rotation, 4, "rotation")) {
      const double norm = std::sqrt(node.rotation[0] * node.rotation[0] + node.rotation[1] * node.rotation[1] +
                                    node.rotation[2] * node.rotation[2] + node.rotation[3] * node.rotation[3]);
      if (!(norm > 0)) throw InputError(file_, node_place(number) + "/rotation", "a quaternion of length 1", "0");
      const double x = node.rotation[0] / norm, y = node.rotation[1] / norm, z = node.rotation[2] / norm,
                   w = node.rotation[3] / norm;
      linear << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
          2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),        //
          2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
    }
    if (sized(node.scale, 3, "scale"))
      for (Eigen::Index k = 0; k < 3; ++k) linear.col(k) *= node.scale[static_cast<std::size_t>(k)];
    m.topLeftCorner<3, 3>() = linear;
    if (sized(node.translation, 3, "translation"))
      for (Eigen::Index k = 0; k < 3; ++k) m(k, 3) = node.translation[static_cast<std::size_t>(k)];
    return m;
  }

  void check_node(int node, const std::string& place) const {
    if (node < 0 || at(node) >= model_.nodes.size())
      throw InputError(file_, place, "a node below " + std::to_string(model_.nodes.size()), std::to_string(node));
  }

  // The root nodes.
  std::vector<int> roots() const {
    std::vector<char> below(model_.nodes.size(), 0);
    for (std::size_t i = 0; i < model_.nodes.size(); ++i)
      for (const int child : model_.nodes[i].children) {
        check_node(child, node_place(static_cast<int>(i)) + "/children");
        below[at(child)] = 1;
      }
    std::vector<int> found;
    for (std::size_t i = 0; i < below.size(); ++i)
      if (below[i] == 0) found.push_back(static_cast<int>(i));
    return found;
  }

  void walk() {
    std::vector<int> first = roots();
    if (!model_.scenes.empty()) {
      const int scene = std::max(model_.defaultScene, 0);
      if (at(scene) >= model_.scenes.size())
        throw InputError(file_, "/scene", "a number below " + std::to_string(model_.scenes.size()),
                         std::to_string(scene));
      first = model_.scenes[at(scene)].nodes;
    }
    struct Step {
      int node;
      Mat4 above;
      int root;
    };
    std::vector<Step> steps;
    std::vector<char> seen(model_.nodes.size(), 0);
    const auto add = [&](int node, const Mat4& above, int root, const std::string& place) {
      check_node(node, place);
      if (seen[at(node)] != 0) throw InputError(file_, node_place(node), "a node that hangs in one place", "two");
      seen[at(node)] = 1;
      steps.push_back({node, above, root});
    };
    for (auto root = first.rbegin(); root != first.rend(); ++root) add(*root, Mat4::Identity(), *root, "/scenes");
    while (!steps.empty()) {
      const Step step = steps.back();
      steps.pop_back();
      const tinygltf::Node& node = model_.nodes[at(step.node)];
      const Mat4 world = step.above * transform_of(step.node);
      if (node.mesh >= 0) add_mesh(step.node, node.skin >= 0 ? Mat4(Mat4::Identity()) : world, step.root);
      for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
        add(*child, world, step.root, node_place(step.node) + "/children");
    }
  }

  static std::string name_or(const std::string& name, const std::string& other) { return name.empty() ? other : name; }

  void add_mesh(int node_number, const Mat4& world, int root) {
    const tinygltf::Node& node = model_.nodes[at(node_number)];
    if (at(node.mesh) >= model_.meshes.size())
      throw InputError(file_, node_place(node_number) + "/mesh",
                       "a number below " + std::to_string(model_.meshes.size()), std::to_string(node.mesh));
    const tinygltf::Mesh& mesh = model_.meshes[at(node.mesh)];
    skinned_ = skinned_ || node.skin >= 0;
    const std::string name = name_or(node.name, name_or(mesh.name, "mesh " + std::to_string(node.mesh)));
    const Index object =
        number_of(name_or(model_.nodes[at(root)].name, "node " + std::to_string(root)), objects_, mesh_.object_names);
    std::map<std::array<int, 2>, Index> begins;  // accessors of positions and uv -> their first vertex, of this node
    for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
      const tinygltf::Primitive& primitive = mesh.primitives[k];
      const std::string material = material_of(primitive);
      std::string group = name;
      if (mesh.primitives.size() > 1) group = name_or(material, name + '.' + std::to_string(k));
      add_primitive(primitive, "/meshes/" + std::to_string(node.mesh) + "/primitives/" + std::to_string(k), world,
                    object, group, material, begins);
    }
  }

  std::string material_of(const tinygltf::Primitive& primitive) const {
    const bool known = primitive.material >= 0 && at(primitive.material) < model_.materials.size();
    return known ? model_.materials[at(primitive.material)].name : std::string();
  }

  static Index number_of(const std::string& name, std::map<std::string, Index>& numbers,
                         std::vector<std::string>& names) {
    const auto [place, is_new] = numbers.try_emplace(name, static_cast<Index>(names.size()));
    if (is_new) names.push_back(name);
    return place->second;
  }

  void add_primitive(const tinygltf::Primitive& primitive, const std::string& place, const Mat4& world, Index object,
                     const std::string& group_name, const std::string& material,
                     std::map<std::array<int, 2>, Index>& begins) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      no_surface_ = true;
      return;
    }
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) throw InputError(file_, place + "/mode", "0 to 6", std::to_string(mode));
    if (primitive.extensions.contains("KHR_draco_mesh_compression"))
      throw InputError(file_, place, "data that are not compressed", "KHR_draco_mesh_compression");
    morphs_ = morphs_ || !primitive.targets.empty();
    const auto accessor = [&](const char* name) {
      const auto found = primitive.attributes.find(name);
      return found == primitive.attributes.end() ? -1 : found->second;
    };
    const int position = accessor("POSITION"), uv = accessor("TEXCOORD_0");
    if (position < 0) throw InputError(file_, place, "an attribute POSITION", "none");
    const auto known = begins.try_emplace({position, uv}, static_cast<Index>(mesh_.positions.size()));
    const Index begin = known.first->second;
    if (known.second) add_vertices(position, uv, world, place);
    const std::size_t count = model_.accessors[at(position)].count;

    std::vector<double> corners;
    if (primitive.indices >= 0) {
      corners = numbers_->read_indices(primitive.indices, 3 * mesh_triangle_limit);
    } else {
      corners.resize(count);
      for (std::size_t i = 0; i < count; ++i) corners[i] = static_cast<double>(i);
    }
    for (const double i : corners)
      if (i >= static_cast<double>(count))
        throw InputError(file_, place + "/indices", "indices below " + std::to_string(count),
                         std::to_string(static_cast<long long>(i)));
    if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
      throw InputError(file_, place, "three corners for each triangle", std::to_string(corners.size()) + " corners");
    if (corners.size() < 3) throw InputError(file_, place, "at least 3 corners", std::to_string(corners.size()));

    const Index group = number_of(group_name, groups_, mesh_.group_names);
    if (at(group) == mesh_.group_material.size()) mesh_.group_material.push_back(material);
    const Mat3 linear = world.topLeftCorner<3, 3>();
    const bool mirrored = linear.col(0).cross(linear.col(1)).dot(linear.col(2)) < 0;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c, bool strip) {
      if (mesh_.triangles.size() == mesh_triangle_limit)
        throw InputError(file_, place, "at most " + std::to_string(mesh_triangle_limit) + " triangles in all", "more");
      if (mirrored) std::swap(b, c);
      Triangle t{};
      for (std::size_t k = 0; const std::size_t corner : {a, b, c})
        t[k++] = begin + static_cast<Index>(corners[corner]);
      // Strips turn back on themselves through triangles without area.
      if (strip && (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])) return;
      mesh_.triangles.push_back(t);
      mesh_.texcoord.push_back({-1, -1, -1});
      if (uv >= 0)
        for (std::size_t k = 0; k < 3; ++k) mesh_.texcoord.back()[k] = uv_of_vertex_[at(t[k])];
      mesh_.group.push_back(group);
      mesh_.object.push_back(object);
    };
    if (mode == TINYGLTF_MODE_TRIANGLES) {
      for (std::size_t i = 0; i < corners.size(); i += 3) add(i, i + 1, i + 2, false);
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
      for (std::size_t i = 0; i + 2 < corners.size(); ++i) add(i, i + 1 + i % 2, i + 2 - i % 2, true);
    } else {
      for (std::size_t i = 1; i + 1 < corners.size(); ++i) add(i, i + 1, 0, true);
    }
  }

  void add_vertices(int position, int uv, const Mat4& world, const std::string& place) {
    const std::vector<double> x = numbers_->read(position, TINYGLTF_TYPE_VEC3, mesh_vertex_limit);
    const std::size_t count = x.size() / 3;
    if (mesh_.positions.size() + count > mesh_vertex_limit)
      throw InputError(file_, place, "at most " + std::to_string(mesh_vertex_limit) + " vertices in all", "more");
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p =
          world.topLeftCorner<3, 3>() * Vec3(x[3 * i], x[3 * i + 1], x[3 * i + 2]) + world.topRightCorner<3, 1>();
      if (!p.allFinite())
        throw InputError(file_, place + ", vertex " + std::to_string(i), "finite coordinates in the scene", "infinity");
      mesh_.positions.push_back(p);
    }
    uv_of_vertex_.resize(mesh_.positions.size(), -1);
    if (uv < 0) return;
    const std::vector<double> st = numbers_->read(uv, TINYGLTF_TYPE_VEC2, mesh_vertex_limit);
    if (st.size() / 2 != count)
      throw InputError(file_, place + "/attributes/TEXCOORD_0", std::to_string(count) + ", one for each vertex",
                       std::to_string(st.size() / 2));
    any_uv_ = true;
    for (std::size_t i = 0; i < count; ++i) {
      uv_of_vertex_[mesh_.positions.size() - count + i] = static_cast<Index>(mesh_.texcoords.size());
      mesh_.texcoords.emplace_back(st[2 * i], 1 - st[2 * i + 1]);
    }
  }

  std::string file_;
  tinygltf::Model model_;
  std::optional<GltfNumbers> numbers_;
  SurfaceMesh mesh_;
  std::vector<Index> uv_of_vertex_;  // -1: none
  std::map<std::string, Index> groups_, objects_;
  bool any_uv_ = false, skinned_ = false, morphs_ = false, no_surface_ = false;
};

}  // namespace

MeshReader gltf_reader() {
  return {"glTF",
          {".glb", ".gltf"},
          [](std::string_view bytes) { return is_glb(bytes) || is_gltf_text(bytes); },
          [](const MeshSource& source) { return GltfReader(source).read(); },
          gltf_buffers_beside};
}

}  // namespace toile::internal
