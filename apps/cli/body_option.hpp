// apps/cli/body_option.hpp: what --body and --body-unit name.
#pragma once
#include "command_line.hpp"
#include "sim/scene.hpp"

namespace toile {

// A mannequin by its name (always in metres), or a file; without a motion.
SceneBody body_option(const CommandLine& line);

}  // namespace toile
