// apps/cli/output_folder.hpp: where the files of a run go.
#pragma once
#include "command_line.hpp"
#include "sim/scene.hpp"

#include <string>

namespace toile::internal {

// --out, the scene's output.dir, or out/NAME.  Throws InputError for an output.dir that is not within the folder where the program runs: a scene
// that somebody sends may not write where it likes; --out says otherwise.
std::string output_folder(const CommandLine& line, const Scene& scene);

}  // namespace toile::internal
