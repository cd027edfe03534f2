// apps/cli/output_folder.hpp: the output folder of a run.
#pragma once
#include "command_line.hpp"
#include "sim/scene.hpp"

#include <string>

namespace toile::internal {

// --out, the scene's output.dir, or out/NAME.  Throws InputError for an output.dir outside the folder where the program runs: a scene
// from elsewhere may not choose where to write; --out may.
std::string output_folder(const CommandLine& line, const Scene& scene);

}  // namespace toile::internal
