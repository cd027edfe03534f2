#include "io/gltf_skin.hpp"

#include "core/error.hpp"
#include "io/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace toile::internal {
namespace {

constexpr int most_sets = 8;         // of four joints and weights a vertex
constexpr double sum_agrees = 1e-2;  // of weights that a byte each holds: 4 / 255 at worst, half of it usually
constexpr std::size_t most_gltf_joints = 65536;  // what an index of two bytes reaches

int attribute(const std::map<std::string, int>& attributes, const std::string& name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}

std::string count_of(std::size_t vertices) {
  return std::to_string(vertices) + (vertices == 1 ? " vertex" : " vertices");
}

}  // namespace

Index GltfSkins::skin(int number, const std::string& place, Figure& figure) {
  if (number < 0 || at(number) >= model_->skins.size())
    throw InputError(file_, place, "a number below " + std::to_string(model_->skins.size()), std::to_string(number));
  const auto [known, is_new] = known_.try_emplace(number, static_cast<Index>(figure.skins.size()));
  if (!is_new) return known->second;
  const tinygltf::Skin& skin = model_->skins[at(number)];
  const std::string own = "/skins/" + std::to_string(number);
  if (skin.joints.empty() || skin.joints.size() > most_gltf_joints)
    throw InputError(file_, own + "/joints", "1 to " + std::to_string(most_gltf_joints),
                     std::to_string(skin.joints.size()));
  FigureSkin read;
  for (const int joint : skin.joints) {
    if (joint < 0 || at(joint) >= figure.nodes.size())
      throw InputError(file_, own + "/joints", "nodes below " + std::to_string(figure.nodes.size()),
                       std::to_string(joint));
    read.joints.push_back(joint);
  }
  Affine unmoved = Affine::Zero();
  unmoved.leftCols<3>().setIdentity();
  read.to_joint.assign(read.joints.size(), unmoved);
  if (skin.inverseBindMatrices >= 0) {
    const std::vector<double> m = numbers_->read(skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4, most_gltf_joints);
    if (m.size() / 16 < read.joints.size())
      throw InputError(file_, own + "/inverseBindMatrices", std::to_string(read.joints.size()) + ", one for each joint",
                       std::to_string(m.size() / 16));
    for (std::size_t j = 0; j < read.joints.size(); ++j)
      for (Eigen::Index column = 0; column < 4; ++column)
        for (Eigen::Index row = 0; row < 3; ++row)
          read.to_joint[j](row, column) = m[16 * j + static_cast<std::size_t>(4 * column + row)];
  }
  figure.skins.push_back(std::move(read));
  return known->second;
}

void GltfSkins::add_influences(const tinygltf::Primitive& primitive, const std::string& place, Figure& figure) {
  const FigurePart& part = figure.parts.back();
  const std::size_t joints = figure.skins[at(part.skin)].joints.size();
  std::vector<std::vector<double>> joint_sets, weight_sets;
  for (int set = 0; set <= most_sets; ++set) {
    const std::string joint_name = "JOINTS_" + std::to_string(set), weight_name = "WEIGHTS_" + std::to_string(set);
    const int joint = attribute(primitive.attributes, joint_name);
    const int weight = attribute(primitive.attributes, weight_name);
    if (joint < 0 && weight < 0 && set > 0) break;
    const std::string own = place + "/attributes/";
    if (joint < 0) throw InputError(file_, own + joint_name, "joints, as its node has a skin", "none");
    if (weight < 0) throw InputError(file_, own + weight_name, "weights beside the joints", "none");
    if (set == most_sets)
      throw InputError(file_, own + joint_name, "at most " + std::to_string(most_sets) + " sets of joints", "more");
    joint_sets.push_back(numbers_->read_indices(joint, TINYGLTF_TYPE_VEC4, mesh_vertex_limit));
    weight_sets.push_back(numbers_->read(weight, TINYGLTF_TYPE_VEC4, mesh_vertex_limit));
    for (const auto& [name, numbers] : {std::pair(joint_name, joint_sets.back()), {weight_name, weight_sets.back()}})
      if (numbers.size() != 4 * part.count)
        throw InputError(file_, own + name, std::to_string(part.count) + ", one for each vertex",
                         std::to_string(numbers.size() / 4));
  }
  for (std::size_t i = 0; i < part.count; ++i) {
    const std::size_t first = figure.influences.size();
    double sum = 0;
    for (std::size_t k = 0; k < 4 * joint_sets.size(); ++k) {
      const double joint = joint_sets[k / 4][4 * i + k % 4], weight = weight_sets[k / 4][4 * i + k % 4];
      const auto where = [&] { return place + ", vertex " + std::to_string(i); };
      if (weight < 0) throw InputError(file_, where(), "weights of 0 or more", std::to_string(weight));
      if (weight == 0) continue;
      if (joint >= static_cast<double>(joints))
        throw InputError(file_, where(), "joints below " + std::to_string(joints),
                         std::to_string(static_cast<long long>(joint)));
      figure.influences.push_back({static_cast<Index>(joint), weight});
      sum += weight;
    }
    if (figure.influences.size() == first) {
      figure.influences.push_back({0, 1});
      sum = 1;
      ++weightless_;
    }
    if (std::abs(sum - 1) > sum_agrees) ++normalised_;
    for (std::size_t k = first; k < figure.influences.size(); ++k) figure.influences[k].weight /= sum;
    figure.first_influence.push_back(figure.influences.size());
  }
}

void GltfSkins::add_weights(int node, const tinygltf::Mesh& mesh, Figure& figure) const {
  const std::size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size();
  for (const tinygltf::Primitive& primitive : mesh.primitives)
    if (primitive.targets.size() != targets)
      throw InputError(file_, "/meshes/" + std::to_string(model_->nodes[at(node)].mesh),
                       "as many morph targets in every primitive", std::to_string(primitive.targets.size()));
  const std::vector<double>& own = model_->nodes[at(node)].weights;
  const std::vector<double>& given = own.empty() ? mesh.weights : own;
  if (!given.empty() && given.size() != targets)
    throw InputError(file_, "/nodes/" + std::to_string(node) + "/weights",
                     std::to_string(targets) + ", one for each morph target", std::to_string(given.size()));
  FigureNode& of = figure.nodes[at(node)];
  of.first_weight = static_cast<Index>(figure.rest.weights.size());
  of.weights = static_cast<Index>(targets);
  for (std::size_t k = 0; k < targets; ++k) figure.rest.weights.push_back(given.empty() ? 0 : given[k]);
}

void GltfSkins::add_morphs(const tinygltf::Primitive& primitive, const std::string& place, Figure& figure) {
  const FigurePart& part = figure.parts.back();
  for (std::size_t k = 0; k < primitive.targets.size(); ++k) {
    const int accessor = attribute(primitive.targets[k], "POSITION");
    if (accessor < 0) continue;
    const std::string own = place + "/targets/" + std::to_string(k);
    const std::vector<double> shift = numbers_->read(accessor, TINYGLTF_TYPE_VEC3, mesh_vertex_limit);
    if (shift.size() != 3 * part.count)
      throw InputError(file_, own, std::to_string(part.count) + " shifts, one for each vertex",
                       std::to_string(shift.size() / 3));
    MorphTarget target;
    target.weight = figure.nodes[at(part.node)].first_weight + static_cast<Index>(k);
    for (std::size_t i = 0; i < part.count; ++i) {
      const Vec3 by(shift[3 * i], shift[3 * i + 1], shift[3 * i + 2]);
      if (by.isZero(0)) continue;
      if (++shifts_ > mesh_vertex_limit)
        throw InputError(file_, own, "at most " + std::to_string(mesh_vertex_limit) + " shifts in all", "more");
      target.vertices.push_back(static_cast<Index>(part.first + i));
      target.shifts.push_back(by);
    }
    figure.morphs.push_back(std::move(target));
  }
}

std::vector<std::string> GltfSkins::notes() const {
  std::vector<std::string> notes;
  if (normalised_ > 0)
    notes.push_back(file_ + ": the skin weights of " + count_of(normalised_) +
                    " do not sum to 1, and are divided by their sum");
  if (weightless_ > 0)
    notes.push_back(file_ + ": " + count_of(weightless_) + " without skin weights: the first joint moves them");
  return notes;
}

}  // namespace toile::internal
