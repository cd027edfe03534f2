// sim/simulate.hpp: runs a scene from its files to its report.                                       docs/theory/sewing.md
//
//   pattern   mesh -> place -> sew (gravity off, a person is thin) -> weld -> the person grows -> 0.2 s weightless -> 0.3 s ramp of gravity -> drape
//   grid      place -> run
//
// A garment is draped until still (99 % came at most 1 mm far in 0.5 s, at <= 5 mm/s over the last second, the verdict's
// limit) or until `seconds` are over; Report::ended says which.
//
// Easily got wrong: a failed simulation is not an exception.  A blocked seam, a collapsed step and an interruption
// end in a report with verdict fail, and the files up to there stay.
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
  std::string command;                 // as typed, for the report
  std::vector<std::string> arguments;  // its arguments, with which `toile resume` repeats it
  std::vector<std::string> inputs;     // files beside those that the scene names: the scene itself
  bool resume = false;                 // go on with the unfinished run in the directory
  CheckpointOptions checkpoints;
  double seconds_before = 0;  // wall time since the program began, for the report
  TextSource read = read_text_file;
  bool built_in = false;                          // the scene's files are not on the disk: only `read` has them
  std::function<void(const Progress&)> progress;  // may be empty
  std::function<bool()> stop;                     // asked between frames; may be empty
  double time_limit_s = 0;                        // wall time for dressing, up to the motion; 0: no limit
  BudgetLimits limits;                            // a run beyond these is refused before anything is made
};

// Throws InputError, IoError, Error(resource_limit) beyond `limits`, and Error(bad_start) with `strict_start`.  Otherwise writes report.json.
Report simulate(const Scene& scene, const RunOptions& options);

// The end of a run, in a word.
enum class Outcome { passed, failed, interrupted };
Outcome outcome(const Report& report);

}  // namespace toile::internal
