#include "bench_runs.hpp"

#include "embedded.hpp"
#include "garment/triangulate.hpp"
#include "io/file.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace toile::internal {
namespace {

std::string temporary_directory() {
  std::string name = (std::filesystem::temp_directory_path() / "toile-bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw IoError(name, std::strerror(errno));
  return name;
}

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

}  // namespace

Scene embedded_scene(std::string_view name) {
  const std::string path = "scenes/" + std::string(name) + ".json";
  return parse_scene(embedded_text(path), path);
}

BenchRuns::BenchRuns(const CommandLine& line)
    : line_(&line),
      bar_(line),
      directory_(line.out.empty() ? temporary_directory() : line.out),
      temporary_(line.out.empty()) {
  make_directories(directory_);
}

BenchRuns::~BenchRuns() {
  std::error_code ignored;
  if (temporary_) std::filesystem::remove_all(directory_, ignored);
}

void BenchRuns::say(std::string_view what, double share) { bar_.show({what, share, -1}); }

Report BenchRuns::run(const Scene& scene, const std::string& name) {
  RunOptions options;
  options.directory = (std::filesystem::path(directory_) / name).string();
  options.command = line_->typed;
  options.read = embedded_text;
  options.progress = [&](const Progress& progress) { bar_.show({name, progress.share, progress.seconds_left}); };
  options.stop = interrupted;
  Report best = simulate(scene, options);
  for (int k = 1; k < line_->repeats && !interrupted(); ++k) {
    Report next = simulate(scene, options);
    if (next.ended == best.ended && measured_phase(next).seconds < measured_phase(best).seconds) best = std::move(next);
  }
  bar_.clear();
  return best;
}

const PhaseReport& measured_phase(const Report& report) {
  return report.motion_first_frame >= 0 ? report.motion : report.drape;
}

double seconds_per_frame(const PhaseReport& phase) { return phase.frames > 0 ? phase.seconds / phase.frames : 0; }

double cg_per_step(const PhaseReport& phase) {
  return phase.steps > 0 ? static_cast<double>(phase.cg_iterations) / static_cast<double>(phase.steps) : 0;
}

bool reached_its_end(const Report& report) { return report.ended == "time" || report.ended == "still"; }

void add_phases(BenchRow& row, const PhaseReport& phase) {
  const double whole = phase.seconds;
  row.add("eval_percent", "eval %", percent(phase.eval, whole), 1);
  row.add("cg_percent", "cg %", percent(phase.cg, whole), 1);
  row.add("cloth_cloth_percent", "c-c %", percent(phase.cloth_cloth, whole), 1);
  row.add("cloth_solid_percent", "c-s %", percent(phase.cloth_solid, whole), 1);
  const double known = phase.eval + phase.cg + phase.cloth_cloth + phase.cloth_solid;
  row.add("other_percent", "other %", percent(whole - known, whole), 1);
}

void add_steps(BenchRow& row, const PhaseReport& phase) {
  row.add("frames", "frames", static_cast<long>(phase.frames));
  row.add("steps", "steps", phase.steps);
  row.add("steps_rejected", "rejected", phase.steps_rejected);
  row.add("step_min_ms", "min ms", 1e3 * phase.step_min_s, 2);
  row.add("step_max_ms", "max ms", 1e3 * phase.step_max_s, 1);
  row.add("cg_iterations_mean", "cg/step", cg_per_step(phase), 1);
  row.add("cg_iterations_max", "cg max", static_cast<long>(phase.cg_max));
}

void add_contacts(BenchRow& row, const PhaseReport& phase) {
  const double frames = phase.frames > 0 ? phase.frames : 1;
  row.add("touching_mean", "touching", static_cast<double>(phase.touching) / frames, 0);
  row.add("contact_rows_mean", "rows", static_cast<double>(phase.contact_rows) / frames, 0);
}

void add_quality(BenchRow& row, const Report& report) {
  const VerifyReport& audit = report.audit;
  row.add("stretch_p99_percent", "p99 %", 100 * audit.stretch.p99, 2);
  row.add("stretch_max_percent", "max %", 100 * audit.stretch.max, 2);
  row.add("stretch_judged_p99_percent", "judged p99", 100 * audit.stretch.gauge_p99, 2);
  row.add("stretch_judged_max_percent", "judged max", 100 * audit.stretch.gauge_max, 2);
  row.add("cloth_body_edges_max", "c-b max", static_cast<long>(audit.cloth_body_edges.max));
  row.add("cloth_body_edges_last", "c-b last", static_cast<long>(audit.cloth_body_edges.last));
  row.add("cloth_cloth_edges_max", "c-c max", static_cast<long>(audit.cloth_cloth_edges.max));
  row.add("cloth_cloth_edges_last", "c-c last", static_cast<long>(audit.cloth_cloth_edges.last));
  std::string reasons;
  for (const Reason& reason : report.verdict.reasons) reasons.append(reasons.empty() ? "" : "+").append(reason.code);
  row.add("verdict", "verdict", std::string(report.verdict.pass ? "pass" : "fail"));
  row.add("reasons", "reasons", std::move(reasons));
}

double edge_for(const SceneGrid& grid, long particles) {
  const auto count = [&](double edge_m) {
    return static_cast<long>(equilateral_sheet(grid.width_m, grid.height_m, edge_m).points.size());
  };
  // Between `fine` and `coarse` the count passes `particles`; a triangle has the area sqrt(3)/4 e^2 and half a particle.
  const double guess = std::sqrt(grid.width_m * grid.height_m * 2 / (std::sqrt(3.0) * static_cast<double>(particles)));
  double fine = 0.5 * guess, coarse = 2 * guess;
  while (coarse - fine > 1e-7 * guess) {
    const double middle = 0.5 * (fine + coarse);
    (count(middle) >= particles ? fine : coarse) = middle;
  }
  return std::abs(count(fine) - particles) <= std::abs(count(coarse) - particles) ? fine : coarse;
}

void set_frames(Scene& scene, int frames) {
  // Without a motion the first sample of the cache is the start itself.
  scene.seconds = (frames + (scene.body.motion ? 0 : 1)) / scene.fps;
  scene.seconds_given = true;
}

}  // namespace toile::internal
