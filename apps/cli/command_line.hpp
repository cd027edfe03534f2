// apps/cli/command_line.hpp: the parsed command line.                                               docs/command-line.md
#pragma once
#include "sim/budget.hpp"

#include <optional>
#include <string>
#include <vector>

namespace toile::internal {

struct CommandLine {
  enum class Command {
    help,
    demo,
    dress,
    run,
    check,
    verify,
    preview,
    resume,
    untangle,
    export_run,
    fit_fabric,
    bench,
    batch
  };
  Command command = Command::help;
  std::string help;                 // Command::help: the text to print
  std::vector<std::string> inputs;  // patterns, scene, files, directory, the demo's or the benchmark's name
  std::string typed;                // the whole line, for the report
  std::vector<std::string> words;   // the arguments, to repeat the command

  std::string out;  // empty: ./out/NAME
  int threads = 0;  // 0: one per core
  bool no_preview = false, quiet = false, json = false, picture = false, thumbnail = false;

  std::string body, body_unit, body_up, measurements, motion, clip, bones, rig, weights, quality, start;
  std::vector<std::string> targets;
  std::string svg, repair;                  // of check: files to write; empty: none
  std::vector<int> frames;                  // of preview
  std::string style = "technical";          // likewise, of the pictures
  std::string looks;                        // likewise, a file of colours and prints; empty: none
  std::vector<double> close_up_m;           // likewise; empty: none
  bool turntable = false, no_film = false;  // likewise
  std::string to, of = "cloth";             // of export
  std::optional<int> export_frame;          // of export; absent: the last
  bool all = false;                         // of export
  std::optional<std::string> fabric;        // a preset, or a file
  std::optional<double> resolution_cm, hem_mm, tape_mm, allowance_mm, fps, seconds;
  bool topstitched = false;
  bool strict_start = false;
  bool list = false;
  std::optional<int> checkpoint_frames;  // absent: by time
  bool resume = false;                   // simulate_command: go on with the run in `out`
  BudgetLimits limits;
  std::optional<double> time_limit_s;  // default_time_limit_s for `dress`, else none

  // Options of bench.
  bool csv = false;
  int repeats = 0;                // 0: 1, or 9 of the pieces in `bench micro`
  std::vector<int> sizes;         // particles
  std::vector<int> limit_sizes;   // of the table of limits in `bench micro`
  std::vector<std::string> rows;  // of paper, scenes of torture; empty: all
  std::optional<int> bench_frames;
  std::optional<double> step_max_ms;  // of paper, instead of each row's own
  std::string torture_size = "S";
  int starts = 1, first_start = 0;

  // Options of batch.
  int processes = 0;       // 0: one per core
  std::string paths_from;  // empty: the folder of the job file
  std::string lines;       // "7" or "1-100" of the job file; empty: all
  bool collect = false;
  double limit_seconds = 0, limit_mb = 0;  // of a job; 0: none
};

// Throws Error(usage) with one line.
CommandLine parse_command_line(int argc, const char* const* argv);

// Whether --json is among the arguments, even if the others are invalid.
bool wants_json(int argc, const char* const* argv);

}  // namespace toile::internal
