// io/gltf_clips.hpp: the animations of a glTF file.
#pragma once
#include "io/gltf_numbers.hpp"
#include "rig/clip.hpp"

#include <string>
#include <vector>

namespace toile::internal {

// All of them, in the order of the file; one without a name has its number for a name.  Channels of what the figure does not have, cameras and
// materials, are left out.  Throws InputError for channels, keys and values that do not fit each other.
std::vector<Clip> gltf_clips(const tinygltf::Model& model, const GltfNumbers& numbers, const Figure& figure,
                             const std::string& file);

}  // namespace toile::internal
