// sim/simulate.hpp: runs a scene from its files to its report.                                       docs/theory/sewing.md
//
//   pattern   mesh -> place -> sew (gravity off, a person is thin) -> weld -> the person grows -> 0.2 s weightless -> 0.3 s ramp of gravity -> drape
//   grid      place -> run
//
// A garment is draped until still (p99 speed <= 2 mm/s over 0.5 s, and <= 5 mm/s over the last second, which is what
// the verdict asks) or until `seconds` are over; Report::ended says which.
//
// What is easily got wrong: physics that goes badly is not an exception.  A blocked seam, a collapsed step and an
// interruption end in a report with verdict fail, and the files up to there stay.
#pragma once
#include "sim/budget.hpp"
#include "sim/checkpoint.hpp"
#include "sim/progress.hpp"
#include "sim/report.hpp"
#include "sim/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace toile::internal {

struct RunOptions {
  std::string directory;
  std::string command;  // as typed, for the report
  std::vector<std::string>
      arguments;  // its words but the program's name, with which `toile resume` asks for the run again
  std::vector<std::string> inputs;  // files beside those that the scene names: the scene's own
  bool resume = false;              // go on with the unfinished run in the directory
  CheckpointOptions checkpoints;
  double seconds_before = 0;  // wall time since the program began, for the report
  TextSource read = read_text_file;
  bool built_in = false;                          // what the scene names is not on the disk: only `read` knows it
  std::function<void(const Progress&)> progress;  // may be empty
  std::function<bool()> stop;                     // asked between frames; may be empty
  double time_limit_s = 0;                        // wall time that dressing may take, up to the motion; 0: any
  BudgetLimits limits;                            // what the run may take: refused beyond, before anything is made
};

// Throws InputError, IoError, Error(resource_limit) beyond `limits`, and Error(bad_start) with `strict_start`.  Writes report.json in every other case.
Report simulate(const Scene& scene, const RunOptions& options);

// How a run came to its end, in a word.
enum class Outcome { passed, failed, interrupted };
Outcome outcome(const Report& report);

}  // namespace toile::internal
