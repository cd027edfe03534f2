// apps/bench/bench_runs.hpp: runs scenes quietly, one after the other, and says what they took.
//
//   seconds_per_frame   wall time of the steps alone: neither meshing, nor writing, nor the judge
//   percent             of it: eval, cg, cloth_cloth, cloth_solid as in the paper; other is the rest, with the body's motion
//
// Easily got wrong: figures of a scene with a motion are those of the motion, not of the sewing and the drape before it.
#pragma once
#include "bench_table.hpp"
#include "command_line.hpp"
#include "sim/simulate.hpp"
#include "terminal.hpp"

namespace toile::internal {

// Of the scenes that are built in.  Throws IoError when there is none of that name.
Scene embedded_scene(std::string_view name);

// Where the runs of one benchmark go: --out, or a folder that is gone at the end.
class BenchRuns {
 public:
  explicit BenchRuns(const CommandLine& line);
  ~BenchRuns();
  BenchRuns(const BenchRuns&) = delete;
  BenchRuns& operator=(const BenchRuns&) = delete;

  // As often as --repeat says; the report of the fastest.  An interrupt ends it early: Report::ended.
  Report run(const Scene& scene, const std::string& name);

  void say(std::string_view what, double share);
  const CommandLine& line() const { return *line_; }
  const std::string& directory() const { return directory_; }

 private:
  const CommandLine* line_;
  ProgressBar bar_;
  std::string directory_;
  bool temporary_;
};

const PhaseReport& measured_phase(const Report& report);
double seconds_per_frame(const PhaseReport& phase);
double cg_per_step(const PhaseReport& phase);
// Whether it was run to the end that the scene sets.
bool reached_its_end(const Report& report);

void add_phases(BenchRow& row, const PhaseReport& phase);
void add_steps(BenchRow& row, const PhaseReport& phase);
// Per frame, in its last step: particles that touch the body, rows of cloth on cloth.
void add_contacts(BenchRow& row, const PhaseReport& phase);
// Stretch, crossings, verdict.
void add_quality(BenchRow& row, const Report& report);

// The edge at which the scene's only grid comes nearest to `particles`, m.
double edge_for(const SceneGrid& grid, long particles);

// Sets how many frames of it are simulated.
void set_frames(Scene& scene, int frames);

}  // namespace toile::internal
