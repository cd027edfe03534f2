// sim/scene_inputs.hpp: which files and folders a scene reads, and what they held when it was read.
#pragma once
#include "sim/report.hpp"
#include "sim/scene.hpp"

#include <span>
#include <string>
#include <vector>

namespace toile {

std::vector<std::string> input_paths(const Scene& scene);

// The files among `paths`; of a folder those that a scene reads from it: the frames of a motion, or the run that is the start.
std::vector<std::string> input_files(std::span<const std::string> paths);

// With the checksum of what they hold now, and their paths as seen from `directory`.  What is not a file (a pattern that is built in) is left out.
// Throws IoError.
std::vector<WrittenFile> checksums_of_inputs(std::span<const std::string> paths, const std::string& directory);

}  // namespace toile
