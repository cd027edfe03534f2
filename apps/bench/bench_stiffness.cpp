// apps/bench/bench_stiffness.cpp: `toile bench stiffness`: the cost of stiffer cloth.                             [BW98 8]
//
//   whole runs     the drape with bend, or stretch, multiplied; damping is scaled with it, k_d / k stays
//   one system     the iterations of block Jacobi from dv = 0 at the same state, h = 1/60 s:
//                    own forces   as a step would pose it.  The state is that of the base cloth; a cloth 1000 times as stiff is as far
//                                 from its rest there as b' is large, and the stop rule is not relative to b' (solver/modified_pcg.hpp)
//                    same b       the base cloth's b for all: the effect of the matrix alone
//   states         the iterations with the same b over bend, at other frames of the base cloth's drape
//
// 1998: bend x 0.1, 1, 10, 100, 1000 at 2,602 particles; the running times differ by less than 5 %.
#include "bench.hpp"
#include "bench_probe.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <array>

namespace toile::internal {
namespace {

constexpr int drape_frames = 75;
// It lands, folds (state_frame lies here), swings out and hangs.
constexpr std::array<int, 6> other_state_frames = {5, 15, 25, 45, 60, 75};
constexpr double state_h_s = 1.0 / 60;

struct Multiple {
  std::string_view of;  // "bend" or "stretch"
  double factor;
  std::string_view key, title;  // of a column
};
constexpr std::array<Multiple, 9> multiples = {{{"bend", 0.1, "bend_x_0_1", "bend x 0.1"},
                                                {"bend", 1, "bend_x_1", "x 1"},
                                                {"bend", 10, "bend_x_10", "x 10"},
                                                {"bend", 100, "bend_x_100", "x 100"},
                                                {"bend", 1000, "bend_x_1000", "x 1000"},
                                                {"stretch", 0.1, "", ""},
                                                {"stretch", 1, "", ""},
                                                {"stretch", 10, "", ""},
                                                {"stretch", 100, "", ""}}};

Fabric multiplied(Fabric fabric, const Multiple& by) {
  double& u = by.of == "bend" ? fabric.bend_u_N_m : fabric.stretch_u_N_per_m;
  double& v = by.of == "bend" ? fabric.bend_v_N_m : fabric.stretch_v_N_per_m;
  u *= by.factor;
  v *= by.factor;
  return fabric;
}

void add_iterations(BenchRow& row, std::string_view key, std::string_view title, const PcgReport& report) {
  report ? row.add(key, title, static_cast<long>(report.iterations)) : row.add_empty(key, title);
}

// (largest - least) / least, %.
double variation_percent(const std::vector<double>& values) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return 100 * (*largest - *least) / *least;
}

// (largest - least) / least of the values under `key` in the rows of `of`, %; nothing when one is missing.
void add_variation(BenchRow& facts, std::string_view fact, std::string_view title, const std::vector<BenchRow>& rows,
                   std::string_view of, std::string_view key) {
  std::vector<double> values;
  for (const BenchRow& row : rows) {
    bool counts = false;
    for (const BenchField& field : row.fields()) {
      if (field.key == "varied") counts = std::get<std::string>(field.value) == of;
      if (!counts || field.key != key) continue;
      if (const auto* i = std::get_if<long>(&field.value)) {
        values.push_back(static_cast<double>(*i));
      } else if (const auto* x = std::get_if<double>(&field.value)) {
        values.push_back(*x);
      } else {
        return facts.add_empty(fact, title);
      }
    }
  }
  if (values.size() < 2) return facts.add_empty(fact, title);
  facts.add(fact, title, variation_percent(values), 1);
}

PcgOptions block_jacobi() {
  PcgOptions options;
  options.preconditioner = Preconditioner::block_jacobi;
  options.tolerance = usual_tolerance(options.preconditioner, options.procedure);
  options.max_iterations = most_iterations;
  return options;
}

// A row per state of the drape of `scene`, whose cloth is the base cloth; as many as fit in its `frames`.
std::vector<BenchRow> iterations_along_the_drape(const Scene& scene, int frames) {
  std::vector<BenchRow> rows;
  Drape drape(scene);
  int frame = 0;
  for (const int state : other_state_frames) {
    if (state > frames || interrupted() || !drape.advance(state - frame)) break;
    frame = state;
    const StepSystem base_system(drape, state_h_s);
    BenchRow row;
    row.add("state_frame", "frame", static_cast<long>(state));
    std::vector<double> iterations;
    bool all = true;
    for (const Multiple& by : multiples) {
      if (by.of != "bend") continue;
      StepSystem system(drape, state_h_s, multiplied(scene.cloth.front().fabric, by));
      const PcgReport report = system.solve(block_jacobi(), base_system.b());
      add_iterations(row, by.key, by.title, report);
      iterations.push_back(report.iterations);
      all = all && report;
    }
    all ? row.add("vary_percent", "vary by, %", variation_percent(iterations), 1)
        : row.add_empty("vary_percent", "vary by, %");
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

BenchResult bench_stiffness(BenchRuns& runs) {
  BenchResult result{"stiffness", {{"rows", {}, false}, {"states", {}, false}}, {}, {}, true};
  std::vector<BenchRow>& rows = result.tables.front().rows;
  Scene scene = embedded_scene("cylinder");
  SceneCloth& cloth = scene.cloth.front();
  SceneGrid& grid = std::get<SceneGrid>(cloth.kind);
  grid.edge_m = edge_for(grid, runs.line().sizes.front());
  const int frames = runs.line().bench_frames.value_or(drape_frames);
  set_frames(scene, frames);
  const Fabric base = cloth.fabric;

  runs.say("states", 0);
  result.tables.back().rows = iterations_along_the_drape(scene, frames);
  Drape drape(scene);
  if (!drape.advance(std::min(frames, state_frame)))
    throw Error(ErrorKind::simulation_failed, "bench stiffness: the base drape failed before its state was reached");
  const StepSystem base_system(drape, state_h_s);

  for (const Multiple& by : multiples) {
    if (interrupted()) break;
    cloth.fabric = multiplied(base, by);
    const Report report = runs.run(scene, fmt::sprintf("%s-x%g", std::string(by.of), by.factor));
    const PhaseReport& phase = measured_phase(report);
    if (!reached_its_end(report)) result.complete = false;
    BenchRow row;
    row.add("varied", "varied", std::string(by.of));
    row.add("factor", "factor", by.factor, 1);
    row.add("bend_u_N_m", "bend N m", cloth.fabric.bend_u_N_m, 6);
    row.add("stretch_u_N_per_m", "stretch N/m", cloth.fabric.stretch_u_N_per_m, 0);
    row.add("seconds", "seconds", phase.seconds, 3);
    add_steps(row, phase);
    add_contacts(row, phase);
    add_phases(row, phase);
    StepSystem system(drape, state_h_s, cloth.fabric);
    add_iterations(row, "iterations_block_jacobi", "own forces", system.solve(block_jacobi()));
    add_iterations(row, "iterations_block_jacobi_same_b", "same b", system.solve(block_jacobi(), base_system.b()));
    add_quality(row, report);
    rows.push_back(std::move(row));
  }
  for (const std::string_view of : {std::string_view("bend"), std::string_view("stretch")}) {
    const bool bend = of == "bend";
    add_variation(result.facts, bend ? "bend_seconds_vary_percent" : "stretch_seconds_vary_percent",
                  bend ? "time over bend varies by, % (1998: < 5)" : "time over stretch varies by, %", rows, of,
                  "seconds");
    add_variation(result.facts, bend ? "bend_iterations_vary_percent" : "stretch_iterations_vary_percent",
                  bend ? "block Jacobi, own forces, over bend varies by, %" : "  over stretch, %", rows, of,
                  "iterations_block_jacobi");
    add_variation(result.facts, bend ? "bend_iterations_same_b_vary_percent" : "stretch_iterations_same_b_vary_percent",
                  bend ? "block Jacobi, same b, over bend varies by, %" : "  over stretch, %", rows, of,
                  "iterations_block_jacobi_same_b");
  }
  result.notes.push_back("Second table: block Jacobi with the same b at other frames of the base cloth's drape.");
  result.notes.push_back("Block Jacobi: iterations of one solve at frame " +
                         std::to_string(std::min(frames, state_frame)) + ", h = 1/60 s; - is more than " +
                         std::to_string(most_iterations) + ".");
  if (frames != drape_frames)
    result.notes.push_back(std::to_string(frames) + " of " + std::to_string(drape_frames) +
                           " frames: the cloth hardly meets itself in the first ones.");
  return result;
}

}  // namespace toile::internal
