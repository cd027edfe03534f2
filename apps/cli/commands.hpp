// apps/cli/commands.hpp: one function per command.  Each prints its result and returns the exit code, or throws.
#pragma once
#include "command_line.hpp"
#include "exit_code.hpp"
#include "sim/scene.hpp"

namespace toile::internal {

ExitCode simulate_command(const CommandLine& line);  // demo, dress, run
ExitCode resume_command(const CommandLine& line);
ExitCode check_command(const CommandLine& line);
ExitCode verify_command(const CommandLine& line);
ExitCode preview_command(const CommandLine& line);
ExitCode untangle_command(const CommandLine& line);
ExitCode export_command(const CommandLine& line);
ExitCode fit_fabric_command(const CommandLine& line);
ExitCode bench_command(const CommandLine& line);
ExitCode batch_command(const CommandLine& line);

// The scene that a demo, dress or run is of; relative paths refer to the present folder.  Throws InputError, IoError and Error(usage).
SceneFile scene_of(const CommandLine& line);

}  // namespace toile::internal
