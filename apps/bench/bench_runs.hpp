// apps/bench/bench_runs.hpp: runs scenes quietly, one after the other, and reports their times.
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

// The built-in scene of that name.  Throws IoError when there is none.
Scene embedded_scene(std::string_view name);

// The runs of one benchmark, in --out, or in a temporary folder.
class BenchRuns {
 public:
  explicit BenchRuns(const CommandLine& line);
  ~BenchRuns();
  BenchRuns(const BenchRuns&) = delete;
  BenchRuns& operator=(const BenchRuns&) = delete;

  // Runs it --repeat times; returns the report of the fastest.  An interrupt ends it early: Report::ended.
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
// Whether it ran to the end of the scene.
bool reached_its_end(const Report& report);

void add_phases(BenchRow& row, const PhaseReport& phase);
void add_steps(BenchRow& row, const PhaseReport& phase);
// Per frame, in its last step: particles that touch the body, contact rows of cloth on cloth.
void add_contacts(BenchRow& row, const PhaseReport& phase);
// Stretch, crossings, verdict.
void add_quality(BenchRow& row, const Report& report);

// The edge length at which the grid's number of particles is nearest to `particles`, m.
double edge_for(const SceneGrid& grid, long particles);

// Sets the number of simulated frames.
void set_frames(Scene& scene, int frames);

}  // namespace toile::internal
