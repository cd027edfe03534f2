// io/gltf_read.cpp: glTF 2.0, as text (.gltf) and binary (.glb): the meshes of its scene, at rest, and what moves them.
//
// An object is the subtree of one root node of the scene.  A group is a mesh, by its node's name; of a mesh with several primitives each is one,
// by its material's name.  The second number of a texture coordinate points down in glTF and up here: v = 1 - v.  Lengths are metres, y is up: glTF's own.
//
// At rest: as the nodes stand and the morph weights are without an animation.  Easily missed: a skinned mesh is not moved by its node but by its
// skeleton alone.
#include "core/error.hpp"
#include "io/gltf_clips.hpp"
#include "io/gltf_load.hpp"
#include "io/gltf_nodes.hpp"
#include "io/gltf_numbers.hpp"
#include "io/gltf_skin.hpp"
#include "io/gltf_text.hpp"
#include "io/mesh_formats.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

class GltfReader {
 public:
  explicit GltfReader(const MeshSource& source) : file_(source.file) {
    std::size_t bytes = 0;
    model_ = load_gltf(source, bytes);
    numbers_.emplace(model_, file_, bytes);
    skins_.emplace(model_, *numbers_, file_);
  }

  SurfaceMesh read() {
    read_scene();
    if (!model_.animations.empty())
      mesh_.notes.push_back(file_ + ": has animations, and is taken as it stands without them");
    return std::move(mesh_);
  }

  AnimatedMesh read_animated() {
    read_scene();
    std::vector<Clip> clips = gltf_clips(model_, *numbers_, figure_, file_);
    return {std::move(mesh_), std::move(figure_), std::move(clips)};
  }

 private:
  void read_scene() {
    GltfNodes nodes = gltf_nodes(model_, file_);
    figure_ = std::move(nodes.figure);
    figure_.first_influence.push_back(0);
    world_ = world_transforms(figure_);
    for (const GltfNodes::Placed& placed : nodes.scene)
      if (model_.nodes[at(placed.node)].mesh >= 0) add_mesh(placed.node, placed.root);
    if (mesh_.triangles.empty())
      throw InputError(file_, "scene", "at least one mesh with triangles", model_.meshes.empty() ? "no mesh" : "none");
    pose();
    if (!any_uv_) mesh_.texcoord = {};
    mesh_.notes = skins_->notes();
    if (no_surface_) mesh_.notes.push_back(file_ + ": has points or lines, which are left out");
  }

  void pose() {
    mesh_.positions = all_vertices(figure_, figure_.rest);
    for (std::size_t p = 0; p < figure_.parts.size(); ++p) {
      const FigurePart& part = figure_.parts[p];
      for (std::size_t i = 0; i < part.count; ++i)
        if (!mesh_.positions[part.first + i].allFinite())
          throw InputError(file_, part_places_[p] + ", vertex " + std::to_string(i), "finite coordinates in the scene",
                           "infinity");
    }
  }

  // Primitives of a node with the same attributes and morph targets share their vertices.
  struct Placed {
    Index first;
    std::size_t part;
  };
  using Attributes = std::map<std::string, int>;
  using Begins = std::map<std::pair<Attributes, std::vector<Attributes>>, Placed>;

  static std::string name_or(const std::string& name, const std::string& other) { return name.empty() ? other : name; }

  void add_mesh(int node_number, int root) {
    const tinygltf::Node& node = model_.nodes[at(node_number)];
    if (at(node.mesh) >= model_.meshes.size())
      throw InputError(file_, gltf_node_place(node_number) + "/mesh",
                       "a number below " + std::to_string(model_.meshes.size()), std::to_string(node.mesh));
    const tinygltf::Mesh& mesh = model_.meshes[at(node.mesh)];
    skins_->add_weights(node_number, mesh, figure_);
    const std::string name = name_or(node.name, name_or(mesh.name, "mesh " + std::to_string(node.mesh)));
    const Index object =
        number_of(name_or(model_.nodes[at(root)].name, "node " + std::to_string(root)), objects_, mesh_.object_names);
    Begins begins;
    for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
      const tinygltf::Primitive& primitive = mesh.primitives[k];
      const std::string material = material_of(primitive);
      std::string group = name;
      if (mesh.primitives.size() > 1) group = name_or(material, name + '.' + std::to_string(k));
      add_primitive(primitive, "/meshes/" + std::to_string(node.mesh) + "/primitives/" + std::to_string(k), node_number,
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

  void add_primitive(const tinygltf::Primitive& primitive, const std::string& place, int node, Index object,
                     const std::string& group_name, const std::string& material, Begins& begins) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      no_surface_ = true;
      return;
    }
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) throw InputError(file_, place + "/mode", "0 to 6", std::to_string(mode));
    if (primitive.extensions.contains("KHR_draco_mesh_compression"))
      throw InputError(file_, place, "data that are not compressed", "KHR_draco_mesh_compression");
    const auto accessor = [&](const char* name) {
      const auto found = primitive.attributes.find(name);
      return found == primitive.attributes.end() ? -1 : found->second;
    };
    const int position = accessor("POSITION"), uv = accessor("TEXCOORD_0");
    if (position < 0) throw InputError(file_, place, "an attribute POSITION", "none");
    const auto known = begins.try_emplace({primitive.attributes, primitive.targets},
                                          Placed{static_cast<Index>(figure_.modelled.size()), figure_.parts.size()});
    if (known.second) add_vertices(primitive, node, place);
    const Index begin = known.first->second.first;
    const std::size_t count = model_.accessors[at(position)].count;

    std::vector<double> corners;
    if (primitive.indices >= 0) {
      corners = numbers_->read_indices(primitive.indices, TINYGLTF_TYPE_SCALAR, 3 * mesh_triangle_limit);
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
    const bool mirrored = mirrors(figure_.parts[known.first->second.part]);
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

  // A part that is turned inside out where it stands; of a skin its first joint decides.
  bool mirrors(const FigurePart& part) const {
    Affine m = world_[at(part.node)];
    if (part.skin >= 0) {
      const FigureSkin& skin = figure_.skins[at(part.skin)];
      m = product(world_[at(skin.joints.front())], skin.to_joint.front());
    }
    return m.col(0).cross(m.col(1)).dot(m.col(2)) < 0;
  }

  void add_vertices(const tinygltf::Primitive& primitive, int node, const std::string& place) {
    const int position = primitive.attributes.at("POSITION");
    const std::vector<double> x = numbers_->read(position, TINYGLTF_TYPE_VEC3, mesh_vertex_limit);
    const std::size_t count = x.size() / 3, first = figure_.modelled.size();
    if (first + count > mesh_vertex_limit)
      throw InputError(file_, place, "at most " + std::to_string(mesh_vertex_limit) + " vertices in all", "more");
    for (std::size_t i = 0; i < count; ++i) figure_.modelled.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    const int skin = model_.nodes[at(node)].skin;
    const Index skin_number = skin < 0 ? -1 : skins_->skin(skin, gltf_node_place(node) + "/skin", figure_);
    figure_.parts.push_back({node, skin_number, first, count});
    part_places_.push_back(place);
    if (skin >= 0)
      skins_->add_influences(primitive, place, figure_);
    else
      figure_.first_influence.resize(first + count + 1, figure_.influences.size());
    skins_->add_morphs(primitive, place, figure_);
    add_texcoords(primitive, count, place);
  }

  // Of the last `count` vertices.
  void add_texcoords(const tinygltf::Primitive& primitive, std::size_t count, const std::string& place) {
    uv_of_vertex_.resize(figure_.modelled.size(), -1);
    const auto uv = primitive.attributes.find("TEXCOORD_0");
    if (uv == primitive.attributes.end()) return;
    const std::vector<double> st = numbers_->read(uv->second, TINYGLTF_TYPE_VEC2, mesh_vertex_limit);
    if (st.size() / 2 != count)
      throw InputError(file_, place + "/attributes/TEXCOORD_0", std::to_string(count) + ", one for each vertex",
                       std::to_string(st.size() / 2));
    any_uv_ = true;
    for (std::size_t i = 0; i < count; ++i) {
      uv_of_vertex_[uv_of_vertex_.size() - count + i] = static_cast<Index>(mesh_.texcoords.size());
      mesh_.texcoords.emplace_back(st[2 * i], 1 - st[2 * i + 1]);
    }
  }

  std::string file_;
  tinygltf::Model model_;
  std::optional<GltfNumbers> numbers_;
  std::optional<GltfSkins> skins_;
  SurfaceMesh mesh_;  // its positions last
  Figure figure_;
  std::vector<Affine> world_;             // [node] at rest
  std::vector<std::string> part_places_;  // for messages
  std::vector<Index> uv_of_vertex_;       // -1: none
  std::map<std::string, Index> groups_, objects_;
  bool any_uv_ = false, no_surface_ = false;
};

}  // namespace

MeshReader gltf_reader() {
  return {"glTF",
          {".glb", ".gltf"},
          [](std::string_view bytes) { return is_glb(bytes) || is_gltf_text(bytes); },
          [](const MeshSource& source) { return GltfReader(source).read(); },
          gltf_buffers_beside,
          [](const MeshSource& source) { return GltfReader(source).read_animated(); }};
}

}  // namespace toile::internal
