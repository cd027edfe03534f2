// io/gltf_skin.hpp: skins, skin weights and morph targets of a glTF file, into a figure.
//
// Easily missed: weights need not sum to 1 in quantised files; they are divided by their sum.  A vertex without weights follows the
// skin's first joint, as in other programs.
#pragma once
#include "io/gltf_numbers.hpp"
#include "rig/figure.hpp"

#include <map>
#include <string>
#include <vector>

namespace toile::internal {

class GltfSkins {
 public:
  GltfSkins(const tinygltf::Model& model, const GltfNumbers& numbers, std::string file)
      : model_(&model), numbers_(&numbers), file_(std::move(file)) {}

  // Its number in the figure; read when it is asked for first.
  Index skin(int number, const std::string& place, Figure& figure);
  // Of the figure's last part, whose vertices have none yet.
  void add_influences(const tinygltf::Primitive& primitive, const std::string& place, Figure& figure);
  // Makes room for the weights of the node's mesh, and sets them as they are at rest.
  void add_weights(int node, const tinygltf::Mesh& mesh, Figure& figure) const;
  // Of the figure's last part.
  void add_morphs(const tinygltf::Primitive& primitive, const std::string& place, Figure& figure);

  // Sentences about what was mended.
  std::vector<std::string> notes() const;

 private:
  const tinygltf::Model* model_;
  const GltfNumbers* numbers_;
  std::string file_;
  std::map<int, Index> known_;
  std::size_t shifts_ = 0, normalised_ = 0, weightless_ = 0;
};

}  // namespace toile::internal
