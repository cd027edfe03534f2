// apps/cli/resume_command.cpp: `toile resume DIR`: repeats the command of an unfinished run, from its saved state.
#include "commands.hpp"
#include "io/run_folder.hpp"
#include "sim/report.hpp"

#include <filesystem>
#include <system_error>
#include <vector>

namespace toile::internal {
namespace {

CommandLine asked_for(const UnfinishedRun& run, const std::string& directory) {
  std::vector<const char*> words{"toile"};
  for (const std::string& word : run.arguments) words.push_back(word.c_str());
  CommandLine line = parse_command_line(static_cast<int>(words.size()), words.data());
  using Command = CommandLine::Command;
  if (line.command != Command::demo && line.command != Command::dress && line.command != Command::run)
    throw IoError(directory, "the run there was not begun by demo, dress or run, and cannot be asked for again");
  return line;
}

}  // namespace

ExitCode resume_command(const CommandLine& line) {
  const std::string& directory = line.inputs.front();
  const std::optional<UnfinishedRun> run = read_unfinished_run(directory);
  if (!run) {
    const bool finished = std::filesystem::exists(std::filesystem::path(directory) / "report.json");
    throw IoError(directory, finished ? "nothing to resume: the run there is finished"
                                      : "nothing to resume: there is no unfinished.json of a run");
  }
  if (run->version != toile_version())
    throw InputError(printable((std::filesystem::path(directory) / "unfinished.json").string()), "/toile_version",
                     '"' + std::string(toile_version()) + "\", this program's", '"' + printable(run->version) + '"');
  CommandLine again = asked_for(*run, directory);
  again.out = std::filesystem::absolute(directory).lexically_normal().string();
  again.resume = true;
  again.json = line.json;
  again.quiet = line.quiet;
  again.no_preview = again.no_preview || line.no_preview;
  again.threads = line.threads;
  if (line.checkpoint_frames) again.checkpoint_frames = line.checkpoint_frames;
  std::error_code error;
  std::filesystem::current_path(run->working_directory, error);  // relative paths start there
  if (error)
    throw IoError(run->working_directory, "cannot go to the folder where the run was begun: " + error.message());
  return simulate_command(again);
}

}  // namespace toile::internal
