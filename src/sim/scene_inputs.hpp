// sim/scene_inputs.hpp: which files and folders a scene reads, and what they hold.
#pragma once
#include "sim/report.hpp"
#include "sim/scene.hpp"

#include <span>
#include <string>
#include <vector>

namespace toile::internal {

std::vector<std::string> input_paths(const Scene& scene);

// The files among `paths`, each once; of a folder those that a scene reads from it: the frames of a motion, or the run that is the start.
// With the checksum of what they hold now, and their paths as seen from `directory`.  What is neither is left out.  Throws IoError.
std::vector<InputFile> checksums_of_inputs(std::span<const std::string> paths, const std::string& directory);

}  // namespace toile::internal
