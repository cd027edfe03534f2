#include "io/gltf_nodes.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace toile::internal {
namespace {

class NodeReader {
 public:
  NodeReader(const tinygltf::Model& model, const std::string& file) : model_(&model), file_(&file) {}

  GltfNodes read() {
    GltfNodes read;
    std::vector<FigureNode>& nodes = read.figure.nodes;
    for (std::size_t i = 0; i < model_->nodes.size(); ++i) {
      nodes.push_back({model_->nodes[i].name});
      read.figure.rest.nodes.push_back(pose(static_cast<int>(i)));
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const int child : model_->nodes[i].children) {
        check_node(child, gltf_node_place(static_cast<int>(i)) + "/children");
        if (nodes[at(child)].parent >= 0) fail_twice(child);
        nodes[at(child)].parent = static_cast<Index>(i);
      }
    read.scene = walk(nodes);
    read.figure.order = parents_first(nodes, *file_);
    return read;
  }

 private:
  void check_node(int node, const std::string& place) const {
    if (node < 0 || at(node) >= model_->nodes.size())
      throw InputError(*file_, place, "a node below " + std::to_string(model_->nodes.size()), std::to_string(node));
  }
  [[noreturn]] void fail_twice(int node) const {
    throw InputError(*file_, gltf_node_place(node), "a node that hangs in one place", "two");
  }

  bool has(const std::vector<double>& values, std::size_t count, int node, std::string_view name) const {
    if (values.empty()) return false;
    const std::string place = gltf_node_place(node) + '/' + std::string(name);
    if (values.size() != count)
      throw InputError(*file_, place, std::to_string(count) + " numbers", std::to_string(values.size()));
    if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
      throw InputError(*file_, place, "finite numbers", "infinity or not a number");
    return true;
  }

  NodePose pose(int number) const {
    const tinygltf::Node& node = model_->nodes[at(number)];
    NodePose pose;
    if (has(node.matrix, 16, number, "matrix")) {
      Affine m;
      for (Eigen::Index column = 0; column < 4; ++column)
        for (Eigen::Index row = 0; row < 3; ++row)
          m(row, column) = node.matrix[static_cast<std::size_t>(4 * column + row)];
      return pose_of(m);
    }
    if (has(node.rotation, 4, number, "rotation")) {
      const std::vector<double>& q = node.rotation;
      const Quaternion turn{q[3], Vec3(q[0], q[1], q[2])};
      if (!(turn.dot(turn) > 0))
        throw InputError(*file_, gltf_node_place(number) + "/rotation", "a quaternion of length 1", "0");
      pose.turn = turn.normalised();
    }
    if (has(node.scale, 3, number, "scale"))
      pose.stretch = Vec3(node.scale[0], node.scale[1], node.scale[2]).asDiagonal();
    if (has(node.translation, 3, number, "translation"))
      pose.translation = Vec3(node.translation[0], node.translation[1], node.translation[2]);
    return pose;
  }

  // Where the scene begins; without scenes, at every node that hangs on none.
  std::vector<int> roots(const std::vector<FigureNode>& nodes) const {
    if (!model_->scenes.empty()) {
      const int scene = std::max(model_->defaultScene, 0);
      if (at(scene) >= model_->scenes.size())
        throw InputError(*file_, "/scene", "a number below " + std::to_string(model_->scenes.size()),
                         std::to_string(scene));
      return model_->scenes[at(scene)].nodes;
    }
    std::vector<int> found;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].parent < 0) found.push_back(static_cast<int>(i));
    return found;
  }

  std::vector<GltfNodes::Placed> walk(const std::vector<FigureNode>& nodes) const {
    std::vector<GltfNodes::Placed> steps, found;
    std::vector<char> seen(nodes.size(), 0);
    const auto add = [&](int node, int root, const std::string& place) {
      check_node(node, place);
      if (seen[at(node)] != 0) fail_twice(node);
      seen[at(node)] = 1;
      steps.push_back({node, root});
    };
    const std::vector<int> first = roots(nodes);
    for (auto root = first.rbegin(); root != first.rend(); ++root) add(*root, *root, "/scenes");
    while (!steps.empty()) {
      const GltfNodes::Placed step = steps.back();
      steps.pop_back();
      found.push_back(step);
      const std::vector<int>& children = model_->nodes[at(step.node)].children;
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        add(*child, step.root, gltf_node_place(step.node) + "/children");
    }
    return found;
  }

  const tinygltf::Model* model_;
  const std::string* file_;
};

}  // namespace

std::string gltf_node_place(int node) { return "/nodes/" + std::to_string(node); }

GltfNodes gltf_nodes(const tinygltf::Model& model, const std::string& file) { return NodeReader(model, file).read(); }

}  // namespace toile::internal
