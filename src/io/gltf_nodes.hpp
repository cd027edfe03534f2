// io/gltf_nodes.hpp: the node tree of a glTF file, and what of it is in the scene.
#pragma once
#include "io/gltf_library.hpp"
#include "rig/figure.hpp"

#include <string>
#include <vector>

namespace toile::internal {

struct GltfNodes {
  struct Placed {
    int node, root;  // the root node above it
  };
  Figure figure;              // nodes, their order and their poses at rest; no vertices
  std::vector<Placed> scene;  // the nodes of the scene, as they come in its tree
};

// "/nodes/3"
std::string gltf_node_place(int node);
// Throws InputError for a node that is not there, hangs in two places or on itself, and for numbers that are no transform.
GltfNodes gltf_nodes(const tinygltf::Model& model, const std::string& file);

}  // namespace toile::internal
