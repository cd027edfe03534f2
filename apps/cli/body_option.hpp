// apps/cli/body_option.hpp: the options --body, --body-unit, --body-up, --measurements, --rig, --weights and --target.
#pragma once
#include "command_line.hpp"
#include "sim/scene.hpp"

namespace toile::internal {

// A mannequin by its name (always in metres), or a file; without a motion.
SceneCollider body_option(const CommandLine& line);
LengthUnit unit_option(const CommandLine& line);  // of --body-unit
UpAxis up_option(const CommandLine& line);        // of --body-up

}  // namespace toile::internal
