// apps/bench/bench_scaling.cpp: `toile bench scaling`: one drape at several resolutions.                        [BW98 8]
//
//   time per frame ~ particles^p,   p fitted by least squares in the logarithms
//
// 1998 reports four of them, "slightly better than n^1.5" (195 MHz).
#include "bench.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace toile::internal {
namespace {

struct Time1998 {
  long particles;
  double seconds_per_frame;
};
constexpr std::array<Time1998, 4> times_1998 = {{{500, 0.23}, {899, 0.46}, {2602, 2.23}, {7359, 10.3}}};
constexpr int frames_per_size = 75;

struct Point {
  double n, t;
};

// Slope of log t over log n; none for fewer than two sizes.
std::optional<double> exponent(const std::vector<Point>& points) {
  double n_mean = 0, t_mean = 0, nn = 0, nt = 0;
  const auto count = static_cast<double>(points.size());
  for (const Point& p : points) {
    n_mean += std::log(p.n) / count;
    t_mean += std::log(p.t) / count;
  }
  for (const Point& p : points) {
    nn += (std::log(p.n) - n_mean) * (std::log(p.n) - n_mean);
    nt += (std::log(p.n) - n_mean) * (std::log(p.t) - t_mean);
  }
  if (!(nn > 0)) return {};
  return nt / nn;
}

void add_exponent(BenchRow& facts, std::string_view key, std::string_view title, const std::vector<Point>& points) {
  const auto p = exponent(points);
  p ? facts.add(key, title, *p, 3) : facts.add_empty(key, title);
}

}  // namespace

BenchResult bench_scaling(BenchRuns& runs) {
  BenchResult result{"scaling", {{"rows", {}, false}}, {}, {}, true};
  const int frames = runs.line().bench_frames.value_or(frames_per_size);
  std::vector<Point> points;
  for (const int size : runs.line().sizes) {
    Scene scene = embedded_scene("cylinder");
    SceneGrid& grid = std::get<SceneGrid>(scene.cloth.front().kind);
    grid.edge_m = edge_for(grid, size);
    set_frames(scene, frames);
    const Report report = runs.run(scene, std::to_string(size) + "-particles");
    const PhaseReport& phase = measured_phase(report);
    BenchRow row;
    row.add("size", "size", static_cast<long>(size));
    row.add("particles", "particles", static_cast<long>(report.vertices));
    row.add("triangles", "triangles", static_cast<long>(report.triangles));
    row.add("edge_mm", "edge mm", 1e3 * grid.edge_m, 2);
    row.add("seconds_per_frame", "s/frame", seconds_per_frame(phase), 4);
    const Time1998* then = nullptr;
    for (const Time1998& time : times_1998)
      if (time.particles == size) then = &time;
    if (then != nullptr) {
      row.add("seconds_per_frame_1998", "1998 s", then->seconds_per_frame, 2);
      row.add("times_faster", "x faster", then->seconds_per_frame / seconds_per_frame(phase), 1);
    } else {
      row.add_empty("seconds_per_frame_1998", "1998 s");
      row.add_empty("times_faster", "x faster");
    }
    add_steps(row, phase);
    add_phases(row, phase);
    add_quality(row, report);
    result.tables.front().rows.push_back(std::move(row));
    if (!reached_its_end(report)) result.complete = false;
    if (interrupted()) break;
    points.push_back({static_cast<double>(report.vertices), seconds_per_frame(phase)});
  }
  add_exponent(result.facts, "exponent", "exponent of time over particles", points);
  std::vector<Point> then;
  for (const Time1998& time : times_1998) then.push_back({static_cast<double>(time.particles), time.seconds_per_frame});
  add_exponent(result.facts, "exponent_1998", "exponent of 1998's four times", then);
  if (frames != frames_per_size)
    result.notes.push_back(std::to_string(frames) + " of " + std::to_string(frames_per_size) +
                           " frames: the cloth hardly meets itself in the first ones.");
  return result;
}

}  // namespace toile::internal
