// apps/bench/bench_paper.cpp: `toile bench paper`: the nine rows of the paper's table, and two figures from its text.   [BW98 8]
#include "bench.hpp"
#include "bench_claims.hpp"

#include <algorithm>
#include <array>

namespace toile::internal {
namespace {

struct Row1998 {
  int row, figure;
  std::string_view what, scene;
  long cloth_vertices, cloth_triangles, solid_vertices, solid_triangles;
  double seconds_per_frame, step_min_ms, step_max_ms;
  int frames, steps;
  double eval, cg, cloth_cloth, cloth_solid;  // per cent of the time
};
constexpr double frame_ms = 1000.0 / 30;
constexpr std::array<Row1998, 9> table_1998 = {{
    {1, 1, "drape", "fig1-drape", 2602, 4942, 322, 640, 2.23, 16.5, frame_ms, 75, 80, 25.7, 50.4, 18.3, 1.4},
    {2, 2, "sheet", "fig2-sheet", 2602, 4942, 322, 640, 3.06, 16.5, frame_ms, 75, 80, 17.9, 63.6, 15.3, 0.2},
    {3, 3, "shirt, twist", "fig3-twist", 6450, 12654, 9941, 18110, 7.32, 16.5, frame_ms, 50, 52, 18.9, 37.9, 30.9, 2.6},
    {4, 4, "shirt, walk", "fig4-shirt", 6450, 12654, 9941, 18110, 14.5, 2.5, 20, 430, 748, 16.7, 29.9, 46.1, 2.2},
    {5, 4, "pants, walk", "fig4-pants", 8757, 17352, 9941, 18110, 38.5, 0.625, 20, 430, 1214, 16.4, 35.7, 42.5, 1.7},
    {6, 5, "skirt, dance", "fig5-skirt", 2153, 4020, 7630, 14008, 3.68, 5, 20, 393, 715, 18.1, 30.0, 44.5, 1.5},
    {7, 5, "blouse, dance", "fig5-blouse", 5108, 10016, 7630, 14008, 16.7, 5, 20, 393, 701, 11.2, 26.0, 57.7, 1.3},
    {8, 6, "long skirt", "fig6-skirt", 4530, 8844, 7630, 14008, 10.2, 10, 20, 393, 670, 20.1, 36.8, 29.7, 2.6},
    {9, 6, "blouse, dance", "fig6-blouse", 5188, 10194, 7630, 14008, 16.6, 1.25, 20, 393, 753, 13.2, 30.9, 50.2, 1.4},
}};

void add_size(BenchRow& row, std::string_view key, std::string_view off_key, std::string_view title, long here,
              long then) {
  row.add(key, title, here);
  row.add(off_key, "  off by %", 100 * static_cast<double>(here - then) / static_cast<double>(then), 2);
}

BenchRow row_of(const Row1998& then, const Report& report) {
  const PhaseReport& phase = measured_phase(report);
  const double seconds = seconds_per_frame(phase);
  BenchRow row;
  row.add("row", "row", static_cast<long>(then.row));
  row.add("figure", "figure", static_cast<long>(then.figure));
  row.add("what", "", std::string(then.what));
  row.add("scene", "scene", std::string(then.scene));
  add_size(row, "cloth_vertices", "cloth_vertices_off_percent", "cloth vertices", report.vertices, then.cloth_vertices);
  add_size(row, "cloth_triangles", "cloth_triangles_off_percent", "cloth triangles", report.triangles,
           then.cloth_triangles);
  add_size(row, "solid_vertices", "solid_vertices_off_percent", "solid vertices", report.body_vertices,
           then.solid_vertices);
  add_size(row, "solid_triangles", "solid_triangles_off_percent", "solid triangles", report.body_triangles,
           then.solid_triangles);
  row.add("seconds_per_frame", "s/frame", seconds, 3);
  row.add("seconds_per_frame_1998", "  1998", then.seconds_per_frame, 2);
  row.add("times_faster", "  times faster", seconds > 0 ? then.seconds_per_frame / seconds : 0, 1);
  add_steps(row, phase);
  row.add("frames_1998", "1998: frames", static_cast<long>(then.frames));
  row.add("steps_1998", "  steps", static_cast<long>(then.steps));
  row.add("step_min_ms_1998", "  min ms", then.step_min_ms, 2);
  row.add("step_max_ms_1998", "  max ms", then.step_max_ms, 1);
  add_phases(row, phase);
  row.add("eval_percent_1998", "1998: eval %", then.eval, 1);
  row.add("cg_percent_1998", "  cg %", then.cg, 1);
  row.add("cloth_cloth_percent_1998", "  c-c %", then.cloth_cloth, 1);
  row.add("cloth_solid_percent_1998", "  c-s %", then.cloth_solid, 1);
  row.add("other_percent_1998", "  other %", 100 - then.eval - then.cg - then.cloth_cloth - then.cloth_solid, 1);
  add_quality(row, report);
  row.add("seconds_total", "all, with dressing, s", report.seconds_total, 1);
  return row;
}

// The row of a run that could not begin, or failed before its motion: the figures of 1998, and the reason.
BenchRow row_without_figures(const Row1998& then, Report report, const Error* error) {
  report.verdict.pass = false;
  if (error != nullptr) report.verdict.reasons = {{"error", error->what()}};
  BenchRow row = row_of(then, report);
  row.empty_unless([](std::string_view key) {
    constexpr std::array<std::string_view, 6> known = {"row", "figure", "what", "scene", "verdict", "reasons"};
    return key.ends_with("_1998") || std::find(known.begin(), known.end(), key) != known.end();
  });
  return row;
}

// Runs one row, even if it fails; `trouble` says why it did not reach its end.
BenchRow measure(BenchRuns& runs, const Row1998& row, int frames, std::string& trouble) {
  try {
    Scene scene = embedded_scene(row.scene);
    set_frames(scene, frames);
    if (!scene.step_max_s) scene.step_max_s = 1e-3 * row.step_max_ms;
    if (runs.line().step_max_ms) scene.step_max_s = 1e-3 * *runs.line().step_max_ms;
    const Report report = runs.run(scene, "row-" + std::to_string(row.row));
    if (!reached_its_end(report) && !report.verdict.reasons.empty())
      trouble = report.verdict.reasons.front().code + ": " + report.verdict.reasons.front().detail;
    const bool moved = !scene.body.motion || report.motion_first_frame >= 0;
    return moved ? row_of(row, report) : row_without_figures(row, report, nullptr);
  } catch (const Error& error) {
    trouble = error.what();
    return row_without_figures(row, {}, &error);
  }
}

}  // namespace

BenchResult bench_paper(BenchRuns& runs) {
  BenchResult result{"paper", {{"rows", {}, true}, {"claims", {}, false}}, {}, {}, true};
  const auto wanted = [&](std::string_view name) {
    const auto& rows = runs.line().rows;
    return rows.empty() || std::find(rows.begin(), rows.end(), name) != rows.end();
  };
  bool short_run = false;
  for (const Row1998& row : table_1998) {
    if (!wanted(std::to_string(row.row)) || interrupted()) continue;
    const int frames = runs.line().bench_frames.value_or(row.frames);
    short_run = short_run || frames < row.frames;
    std::string trouble;
    result.tables[0].rows.push_back(measure(runs, row, frames, trouble));
    if (trouble.empty()) continue;
    result.complete = false;
    result.notes.push_back("Row " + std::to_string(row.row) + ": " + trouble);
  }
  if (short_run) result.notes.emplace_back("Fewer frames than the paper's: motion and drape have hardly begun.");
  std::vector<BenchRow>& claims = result.tables[1].rows;
  if (wanted("cg") && !interrupted()) add_cg_claims(runs, claims);
  if (wanted("explicit") && !interrupted()) add_explicit_claims(runs, claims);
  return result;
}

}  // namespace toile::internal
