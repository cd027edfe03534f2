// sim/scene_inputs.hpp: the files and folders that a scene reads, with checksums.
#pragma once
#include "sim/report.hpp"
#include "sim/scene.hpp"

#include <span>
#include <string>
#include <vector>

namespace toile::internal {

std::vector<std::string> input_paths(const Scene& scene);

// The files among `paths`, each once; for a folder, those that a scene reads from it: the frames of a motion, or the run that is the start.
// With their present checksums, and their paths relative to `directory`.  Other paths are left out.  Throws IoError.
std::vector<InputFile> checksums_of_inputs(std::span<const std::string> paths, const std::string& directory);

}  // namespace toile::internal
