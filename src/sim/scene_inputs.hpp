// sim/scene_inputs.hpp: which files and folders a scene reads.
#pragma once
#include "sim/scene.hpp"

#include <string>
#include <vector>

namespace toile {

std::vector<std::string> input_paths(const Scene& scene);

}  // namespace toile
